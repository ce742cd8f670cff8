"""The windows that a diagnosis works on: short stretches restarted from the measured state (multiple shooting).

A window of 10 s is three to five time constants of surge of an observation-class ROV: long enough for a missing force to show as a
velocity error, short enough that the initial state does not decide the outcome.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.channels import AXES
from rovval.data import Array, Flags, Run
from rovval.drive import Drive, drive, start_states, startable
from rovval.errors import BadInput
from rovval.frames import wrap
from rovval.plant import Plant
from rovval.vehicle.model import Vehicle

VELOCITY_CHANNELS = ("u", "v", "w", "p", "q", "r")
ATTITUDE_CHANNELS = ("phi", "theta")
AXIS_OF = dict(zip((*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi"), (*AXES, *AXES), strict=True))
POSE_OF = dict(zip(VELOCITY_CHANNELS, ("x", "y", "z", "phi", "theta", "psi"), strict=True))
ANGLES = ("phi", "theta", "psi")
SHORTEST_SHARE = 0.6  # chosen: a window with fewer of its samples measured is left out
OUTLIER_SIGMA = 8.0  # chosen: a sample this far from its neighbours' line is an outlier of the sensor


@dataclass(frozen=True, slots=True)
class Stretches:
    """Windows of one run: ``start`` (m,) grid index, ``steps`` per window, measured start states (m, 6), and the measured channels
    ``y`` (m, steps + 1, c) with ``ok`` where they hold a value. ``noise`` (c,) is the white part of each channel's error."""

    run: Run
    plant: Plant
    driven: Drive
    channels: tuple[str, ...]
    start: NDArray[np.int64]
    steps: int
    nu0: Array
    eta0: Array
    y: Array
    ok: Flags
    noise: Array
    outliers: int

    @property
    def count(self) -> int:
        return len(self.start)

    @property
    def axes(self) -> tuple[str, ...]:
        """Axis that each channel belongs to."""
        return tuple(AXIS_OF[c] for c in self.channels)

    def time(self) -> Array:
        """Seconds since the run's start of every sample (m, steps + 1)."""
        return np.asarray((self.start[:, None] + np.arange(self.steps + 1)[None, :]) * self.run.dt)


def cut(run: Run, vehicle: Vehicle, model: str, window_s: float) -> Stretches:
    """Cut a run into windows.

    Raises:
        BadInput: fewer than four windows can be simulated; says how many and why.
    """
    plant, driven = Plant(vehicle, model), drive(run, vehicle)
    channels = residual_channels(run)
    steps = round(window_s / run.dt) - 1
    values, good, outliers = _cleaned(run, channels)
    start = _starts(driven.known & np.ones(len(run), dtype=bool), startable(run), steps)
    inside = start[:, None] + np.arange(steps + 1)[None, :]
    enough = good[inside].mean(axis=(1, 2)) >= SHORTEST_SHARE if len(start) else np.zeros(0, dtype=bool)
    start = start[enough]
    if len(start) < 4:
        raise BadInput(
            f"run {run.id}: {len(start)} windows of {window_s:g} s hold inputs and measurements throughout, at least 4 are needed",
            "use a longer log, a shorter --window, or look at the gaps with `rovval compare`",
        )
    inside = start[:, None] + np.arange(steps + 1)[None, :]
    nu0, eta0, _ = start_states(run, start)
    return Stretches(
        run, plant, driven, channels, start, steps, nu0, eta0, values[inside], good[inside], _noise(values, good), outliers
    )


def residual_channels(run: Run) -> tuple[str, ...]:
    """Velocities, or the pose of an axis whose velocity was not logged, and roll and pitch, whose static value shows trim."""
    chosen = [c if run.measured(c) else POSE_OF[c] for c in VELOCITY_CHANNELS]
    chosen += [c for c in ATTITUDE_CHANNELS if c not in chosen]
    return tuple(c for c in chosen if run.measured(c))


def predicted(stretches: Stretches, nu: Array, eta: Array) -> Array:
    """The residual channels of simulated motions: (b, steps + 1, 6) twice -> (b, steps + 1, c)."""
    names = (*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi")
    both = np.concatenate([nu, eta], axis=2)
    return np.asarray(both[:, :, [names.index(c) for c in stretches.channels]])


def difference(stretches: Stretches, a: Array, b: Array) -> Array:
    """a - b per channel, angles wrapped."""
    out = a - b
    for i, name in enumerate(stretches.channels):
        if name in ANGLES:
            out[..., i] = wrap(out[..., i])
    return np.asarray(out)


def _starts(known: Flags, ready: Flags, steps: int) -> NDArray[np.int64]:
    """First sample of each window: as many as fit, each from a startable point with known inputs throughout."""
    blocked = np.concatenate([[0], np.cumsum(~known)])
    starts, at = [], 0
    while at + steps < len(known):
        if ready[at] and blocked[at + steps + 1] == blocked[at]:
            starts.append(at)
            at += steps + 1
        else:
            at += 1
    return np.array(starts, dtype=np.int64)


def _cleaned(run: Run, channels: Sequence[str]) -> tuple[Array, Flags, int]:
    """Channel values (n, c), where they can be used, and how many isolated outliers were set aside."""
    values = run.stack(tuple(channels))
    good = np.isfinite(values)
    wild = np.zeros_like(good)
    for i in range(len(channels)):
        bend = _bend(values[:, i], channels[i] in ANGLES)
        spread = 1.4826 * np.nanmedian(np.abs(bend)) if np.isfinite(bend).any() else 0.0
        if spread > 0:
            with np.errstate(invalid="ignore"):
                wild[1:-1, i] = np.abs(bend) > OUTLIER_SIGMA * spread
    lone = wild & good
    return np.where(good, values, 0.0), good & ~lone, int(lone.sum())


def _bend(values: Array, angle: bool) -> Array:
    """Second difference, sample minus the mean of its neighbours (n - 2,)."""
    before, after = values[:-2] - values[1:-1], values[2:] - values[1:-1]
    return np.asarray(-0.5 * (wrap(before) + wrap(after)) if angle else -0.5 * (before + after))


def _noise(values: Array, good: Flags) -> Array:
    """White noise of each channel (c,) from third differences (median absolute, so that manoeuvres do not count).

    A third difference of white noise has variance 20 sigma^2 (binomial coefficients 1 3 3 1).
    """
    third = np.diff(values, n=3, axis=0)
    usable = good[3:] & good[2:-1] & good[1:-2] & good[:-3]
    return np.array(
        [
            1.4826 * np.median(np.abs(third[usable[:, i], i])) / np.sqrt(20.0) if usable[:, i].any() else 0.0
            for i in range(values.shape[1])
        ]
    )
