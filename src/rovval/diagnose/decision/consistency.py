"""Where a log contradicts itself: an angle and its rate, of which no fault of a sensor that the library knows makes one the other.

Whatever the rate is off by, the simulation is held against it, and a coefficient that turns the vehicle faster or slower takes the blame: a
gyro that clips reads as too much inertia.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.parity import Parity
from rovval.diagnose.windows.shooting import Stretches

RATES = {"roll": ("phi", "p"), "pitch": ("theta", "q"), "yaw": ("psi", "r")}
SHARE = 0.1  # of what causes close where they close most (opened sets: right ones 0.005 at most, a real run 0.05; a gyro that clips as inertia 0.22)
LEAST = 0.01  # rad within a window: an AHRS errs by less (as its tolerance, `tolerance.SENSORS`)


def contradicted(problem: Problem, weight: Mapping[str, float]) -> list[dict[str, str]]:
    """Of each run the axes on which its angle drifts against its integrated rate, whatever faults of sensors are assumed, by more than `LEAST`, and by so
    much that the rate's error would weigh more than a `SHARE` of ``weight``, in the metric of the gap; in words, as a row of the document."""
    found = list[dict[str, str]]()
    for axis, (angle, rate) in RATES.items():
        off = sum(_off(problem, part, check, angle, rate) for part, check in zip(problem.parts, problem.parity, strict=True))
        if axis in weight and off > SHARE * weight[axis]:
            for part, check in zip(problem.parts, problem.parity, strict=True):
                if (drift := _drift(check, angle)) > LEAST:
                    detail = f"and {rate} contradict each other by {np.degrees(drift):.2g} degrees within a window, whatever fault of a sensor is assumed"
                    found.append({"run": part.run.id, "channel": angle, "finding": "contradicted", "detail": detail})
    return found


def _drift(check: Parity, angle: str) -> float:
    """What all faults of sensors leave of the drift, rms in rad; 0 where the log does not check it."""
    return check.sigma[check.used.index(angle)] if angle in check.used else 0.0


def _off(problem: Problem, part: Stretches, check: Parity, angle: str, rate: str) -> float:
    """What a rate that is off by as much would weigh: a steady one drifts, the mean taken out, by the square root of 12 less than to the window's end."""
    if rate not in part.channels:
        return 0.0
    at = part.channels.index(rate)
    off = np.sqrt(12.0) * _drift(check, angle) / (part.steps * part.run.dt)
    return float(off**2 * np.where(part.ok[..., at], 1.0 / problem.variance[:, at], 0.0).sum())
