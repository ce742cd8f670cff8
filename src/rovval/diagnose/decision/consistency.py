"""Consistency of a log with itself: an angle and its integrated rate, of which no fault of a sensor in the library makes one the other.

Whatever the rate is off by, the simulation is held against it, and a coefficient that turns the vehicle faster or slower takes the blame: a
gyro that clips looks like too much inertia.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.diagnose.criteria import ATTITUDE_DRIFT_SD, INCONSISTENT_SHARE, OBSERVABLE_SIGMA
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.parity import ParityResiduals
from rovval.diagnose.windows.windows import Windows

RATES = {"roll": ("phi", "p"), "pitch": ("theta", "q"), "yaw": ("psi", "r")}


@dataclass(frozen=True, slots=True)
class Inconsistency:
    """The channels ``angle`` and ``rate`` of a ``run`` (its id) drift apart within half of the windows by ``drift`` (rms, rad), whatever faults of
    sensors are assumed."""

    run: str
    angle: str
    rate: str
    drift: float


def inconsistencies(problem: Problem, weight: Mapping[str, float]) -> list[Inconsistency]:
    """Where logs contradict themselves: by more than an AHRS errs, on an axis where the rate's error would make more than a share of the squared error
    ``weight`` by axis, in the weighting of the gap."""
    found = list[Inconsistency]()
    for axis, (angle, rate) in RATES.items():
        off = sum(_rate_error(problem, part, check, angle, rate) for part, check in zip(problem.runs, problem.parity, strict=True))
        if axis in weight and off > INCONSISTENT_SHARE * weight[axis]:
            for part, check in zip(problem.runs, problem.parity, strict=True):
                if (drift := _drift(check, angle)) > OBSERVABLE_SIGMA * ATTITUDE_DRIFT_SD:
                    found.append(Inconsistency(part.run.id, angle, rate, drift))
    return found


def _drift(check: ParityResiduals, angle: str) -> float:
    """What all faults of sensors leave of the drift in half of the windows, rms in rad; 0 where the log does not check it."""
    return check.left[check.relations.index(angle)] if angle in check.relations else 0.0


def _rate_error(problem: Problem, windows: Windows, check: ParityResiduals, angle: str, rate: str) -> float:
    """Weighted squared error of a rate that is off by as much: a steady one drifts, the mean taken out, by the square root of 12 less than to the
    window's end."""
    if rate not in windows.channels:
        return 0.0
    at = windows.channels.index(rate)
    off = np.sqrt(12.0) * _drift(check, angle) / (windows.steps * windows.run.dt)
    return float(off**2 * np.where(windows.ok[..., at], 1.0 / problem.gap.variance[:, at], 0.0).sum())
