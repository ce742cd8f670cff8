"""The windows that a diagnosis works on: short stretches restarted from the measured state (multiple shooting).

A window of 10 s is three to five time constants of surge of an observation-class ROV: long enough for a missing force to show as a
velocity error, short enough that the initial state does not decide the outcome.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import AXES
from rovval.core.data import Array, Flags, Run
from rovval.core.errors import BadInput, all_at_once
from rovval.core.frames import wrap
from rovval.diagnose.windows.contact import in_contact
from rovval.diagnose.windows.noise import ANGLES, cleaned, strides
from rovval.diagnose.windows.saturation import sensed
from rovval.plant import Plant
from rovval.simulation.actuation import Actuation, recorded_actuation, start_states, startable
from rovval.vehicle.model import Vehicle

VELOCITY_CHANNELS = ("u", "v", "w", "p", "q", "r")
ATTITUDE_CHANNELS = ("phi", "theta")
AXIS_OF = dict(zip((*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi"), (*AXES, *AXES), strict=True))
POSE_OF = dict(zip(VELOCITY_CHANNELS, ("x", "y", "z", "phi", "theta", "psi"), strict=True))
FEWEST_WINDOWS = 3  # one to hold out, two to fit on
MANY_WINDOWS = 6  # fewer, and shorter windows are tried (chosen)
SHORTEST_SHARE = 0.6  # chosen: a window with fewer of its samples measured is left out


@dataclass(frozen=True, slots=True)
class Stretches:
    """Windows of one run: ``start`` (m,) grid index, ``steps`` per window, measured start states (m, 6), and the measured channels
    ``y`` (m, steps + 1, c) with ``ok`` where they hold a value. ``noise`` (c,) is the white part of each channel's error; ``contact_s``
    seconds left out because the vehicle was held or aground. ``pushed`` (m, steps + 1, c, d) is what disturbances of one standard deviation
    do to the windows (`disturbance`), once their size is known; ``stopped`` windows in which the simulation of the vehicle as it is stops."""

    run: Run
    plant: Plant
    driven: Actuation
    channels: tuple[str, ...]
    start: NDArray[np.int64]
    steps: int
    nu0: Array
    eta0: Array
    y: Array
    ok: Flags
    noise: Array
    outliers: int
    contact_s: float
    pushed: Array | None = None
    stopped: int = 0

    @property
    def count(self) -> int:
        """Number of windows."""
        return len(self.start)

    @property
    def axes(self) -> tuple[str, ...]:
        """Axis that each channel belongs to."""
        return tuple(AXIS_OF[c] for c in self.channels)

    def time(self) -> Array:
        """Seconds since the run's start of every sample (m, steps + 1)."""
        return np.asarray((self.start[:, None] + np.arange(self.steps + 1)[None, :]) * self.run.dt)


def cut_all(runs: Sequence[Run], vehicle: Vehicle, model: str, window_s: float) -> tuple[tuple[Stretches, ...], tuple[str, ...]]:
    """Every run cut into windows of one length: the longest of ``window_s``, its half and its quarter that suits them all; and which runs
    were too short and left out, with the reason.

    Raises:
        BadInput: no run can be cut, or the runs differ in the channels that they hold.
    """
    parts, left_out = list[Stretches](), list[str]()
    for run in (sensed(one)[0] for one in runs):
        try:
            parts.append(cut(run, vehicle, model, window_s))
        except BadInput as error:
            if len(runs) == 1:
                raise
            left_out.append(error.message)
    if not parts:
        raise BadInput(all_at_once(left_out, "no log can be diagnosed"), "use longer logs")
    shortest = min(part.steps + 1 for part in parts)
    same = tuple(p if p.steps + 1 == shortest else _cut(p.run, vehicle, model, shortest * p.run.dt) for p in parts)
    if len({part.channels for part in same}) > 1:
        held = "; ".join(f"{part.run.id}: {', '.join(part.channels)}" for part in same)
        raise BadInput(f"the logs hold different channels and cannot be diagnosed together ({held})", "diagnose them one by one")
    return same, tuple(left_out)


def cut(run: Run, vehicle: Vehicle, model: str, window_s: float) -> Stretches:
    """Cut a run into windows of ``window_s``, or of half or a quarter of it where a short log gives too few.

    Raises:
        BadInput: fewer than `FEWEST_WINDOWS` windows can be simulated; says how many and why.
    """
    for share in (1.0, 0.5):
        try:
            stretches = _cut(run, vehicle, model, share * window_s)
        except BadInput:
            continue
        if stretches.count >= MANY_WINDOWS:
            return stretches
    return _cut(run, vehicle, model, 0.25 * window_s)


def _cut(run: Run, vehicle: Vehicle, model: str, window_s: float) -> Stretches:
    plant, driven = Plant(vehicle, model), recorded_actuation(run, vehicle)
    channels = residual_channels(run)
    steps = round(window_s / run.dt) - 1
    touching = in_contact(run, driven)
    values, good, noise, wild = cleaned(run, channels)
    start = _starts(driven.known & ~touching, startable(run) & ~wild, steps)
    inside = start[:, None] + np.arange(steps + 1)[None, :]
    possible = np.mean([1.0 / stride for stride in strides(run, channels)])
    enough = good[inside].mean(axis=(1, 2)) >= SHORTEST_SHARE * possible if len(start) else np.zeros(0, dtype=bool)
    start = start[enough]
    if len(start) < FEWEST_WINDOWS:
        raise BadInput(
            f"run {run.id}: {len(start)} windows of {window_s:g} s hold inputs and measurements throughout, at least {FEWEST_WINDOWS} are needed",
            "use a longer log, a shorter --window, or look at the gaps with `rovval compare`",
        )
    inside = start[:, None] + np.arange(steps + 1)[None, :]
    nu0, eta0, _ = start_states(run, start)
    return Stretches(
        run, plant, driven, channels, start, steps, nu0, eta0, values[inside], good[inside], noise, int(wild.sum()), float(touching.sum() * run.dt)
    )


def residual_channels(run: Run) -> tuple[str, ...]:
    """Velocities, or the pose of an axis whose velocity was not logged, and roll and pitch, whose static value shows trim."""
    chosen = [c if run.measured(c) else POSE_OF[c] for c in VELOCITY_CHANNELS]
    chosen += [c for c in ATTITUDE_CHANNELS if c not in chosen]
    return tuple(c for c in chosen if run.measured(c))


def predicted(stretches: Stretches, nu: Array, eta: Array, out: Array | None = None) -> Array:
    """The residual channels of simulated motions: (b, steps + 1, 6) twice -> (b, steps + 1, c), into ``out`` where it is given."""
    names = (*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi")
    at = [names.index(channel) for channel in stretches.channels]
    begins = [i for i in range(len(at)) if i == 0 or at[i] != at[i - 1] + 1 or at[i] == 6]  # neighbours are copied at once
    blocks = [(at[i], j - i) for i, j in zip(begins, [*begins[1:], len(at)], strict=True)]
    return np.concatenate([(nu, eta)[first // 6][..., first % 6 : first % 6 + size] for first, size in blocks], axis=-1, out=out)


def difference(stretches: Stretches, a: Array, b: Array) -> Array:
    """a - b per channel, angles wrapped."""
    out = a - b
    for i, name in enumerate(stretches.channels):
        if name in ANGLES and (np.abs(out[..., i]) > np.pi).any():
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


def axis_channels(stretches: Stretches) -> dict[str, int]:
    """Channel that carries the gap of each measured axis: its velocity, or its pose where that is all there is."""
    carrier = {}
    for axis, velocity in zip(AXES, VELOCITY_CHANNELS, strict=True):
        name = velocity if velocity in stretches.channels else POSE_OF[velocity]
        if name in stretches.channels:
            carrier[axis] = stretches.channels.index(name)
    return carrier
