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
from rovval.diagnose.sensed import sensed
from rovval.drive import Drive, drive, start_states, startable
from rovval.errors import BadInput, all_at_once
from rovval.frames import wrap
from rovval.plant import Plant
from rovval.vehicle.model import Vehicle

VELOCITY_CHANNELS = ("u", "v", "w", "p", "q", "r")
ATTITUDE_CHANNELS = ("phi", "theta")
AXIS_OF = dict(zip((*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi"), (*AXES, *AXES), strict=True))
POSE_OF = dict(zip(VELOCITY_CHANNELS, ("x", "y", "z", "phi", "theta", "psi"), strict=True))
ANGLES = ("phi", "theta", "psi")
FEWEST_WINDOWS = 3  # one to hold out, two to fit on
MANY_WINDOWS = 6  # fewer, and shorter windows are tried (chosen)
SHORTEST_SHARE = 0.6  # chosen: a window with fewer of its samples measured is left out
STILL_S, STILL_M = 3.0, 0.03  # chosen: at rest for 3 s within the noise of a depth sensor
DEPTH_COVERED, AT_END = 0.3, 0.08  # m, chosen: contact is looked for only in logs that dive, near their ends of depth
BELIEVED = {"u": 1e-3, "v": 1e-3, "w": 1e-3, "p": 1e-3, "q": 1e-3, "r": 1e-3, "phi": 1e-3, "theta": 1e-3, "psi": 2e-3, "x": 5e-3, "y": 5e-3, "z": 5e-3}
# m/s, rad/s, rad, m: below these no ROV sensor is believed (chosen; keeps a noise-free log from dividing by zero)
OUTLIER_SIGMA = 8.0  # chosen: a sample this far from its neighbours' line is an outlier of the sensor


@dataclass(frozen=True, slots=True)
class Stretches:
    """Windows of one run: ``start`` (m,) grid index, ``steps`` per window, measured start states (m, 6), and the measured channels
    ``y`` (m, steps + 1, c) with ``ok`` where they hold a value. ``noise`` (c,) is the white part of each channel's error; ``contact_s``
    seconds left out because the vehicle was held or aground. ``pushed`` (m, steps + 1, c, d) is what disturbances of one standard deviation
    do to the windows (`disturbance`), once their size is known."""

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
    contact_s: float
    pushed: Array | None = None

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
    plant, driven = Plant(vehicle, model), drive(run, vehicle)
    channels = residual_channels(run)
    steps = round(window_s / run.dt) - 1
    touching = in_contact(run, driven)
    values, good, noise, wild = _cleaned(run, channels)
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


def in_contact(run: Run, driven: Drive) -> Flags:
    """Where the vehicle is at the surface, held or aground (n,): thrusters idle at the shallow end of the depth that the log covers, or
    idle and still at the deep end.

    The simulator knows neither surface, hand nor floor. Nothing is found in a log without depth or that hardly changes depth.
    """
    still = np.zeros(len(run), dtype=bool)
    depth = run.get("z")
    if not run.measured("z") or np.nanmax(depth) - np.nanmin(depth) < DEPTH_COVERED:
        return still
    span = round(STILL_S / run.dt)
    idle: Flags = np.asarray((np.abs(driven.inputs.speed) < 1e-9).all(axis=1))
    deep: Flags = np.asarray(depth > np.nanmax(depth) - AT_END)
    for at in range(0, len(run) - span, span // 5):
        if idle[at : at + span].all() and deep[at : at + span].all() and np.ptp(depth[at : at + span]) < STILL_M:
            still[at : at + span] = True
    return still | (idle & (depth < np.nanmin(depth) + AT_END))


def predicted(stretches: Stretches, nu: Array, eta: Array) -> Array:
    """The residual channels of simulated motions: (b, steps + 1, 6) twice -> (b, steps + 1, c)."""
    names = (*VELOCITY_CHANNELS, "x", "y", "z", "phi", "theta", "psi")
    out = np.empty((*nu.shape[:2], len(stretches.channels)))
    for i, channel in enumerate(stretches.channels):
        whole, at = divmod(names.index(channel), 6)
        out[..., i] = (nu, eta)[whole][..., at]
    return out


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


def strides(run: Run, channels: Sequence[str]) -> tuple[int, ...]:
    """Grid points per real sample of each channel: 1 at the grid's rate, 3 for a depth logged at 3 Hz. What alignment drew between two
    samples is not evidence of its own."""
    periods = [run.resampled[c].period_s if c in run.resampled else run.dt for c in channels]
    return tuple(max(1, round(period / run.dt)) for period in periods)


def _cleaned(run: Run, channels: Sequence[str]) -> tuple[Array, Flags, Array, Flags]:
    """Channel values (n, c), where they count, white noise of each (c,), and where isolated outliers were set aside (n,): no window begins
    at one, since its start state would be the outlier."""
    values = run.stack(tuple(channels))
    good = np.isfinite(values)
    noise, spoiled = np.zeros(len(channels)), np.zeros(len(run), dtype=bool)
    for i, (name, stride) in enumerate(zip(channels, strides(run, channels), strict=True)):
        real = np.arange(0, len(run), stride)
        keep = np.zeros(len(run), dtype=bool)
        keep[real] = good[real, i]
        series = values[real, i]
        wild = _wild(series, name)
        spoiled[real] |= wild & keep[real]
        keep[real] &= ~wild
        noise[i] = _noise(series, keep[real])
        good[:, i] = keep
    return np.where(good, values, 0.0), good, noise, spoiled


def _wild(series: Array, name: str) -> Flags:
    """Isolated samples far from the mean of their neighbours (n,)."""
    wild = np.zeros(len(series), dtype=bool)
    before, after = series[:-2] - series[1:-1], series[2:] - series[1:-1]
    bend = 0.5 * (wrap(before) + wrap(after)) if name in ANGLES else 0.5 * (before + after)
    finite = bend[np.isfinite(bend)]
    spread = 1.4826 * float(np.median(np.abs(finite))) if len(finite) else 0.0
    with np.errstate(invalid="ignore"):
        wild[1:-1] = np.abs(bend) > OUTLIER_SIGMA * max(spread, 2 * BELIEVED[name])
    return wild


def _noise(series: Array, good: Flags) -> float:
    """White noise of a channel from third differences (median absolute, so that manoeuvres do not count).

    A third difference of white noise has variance 20 sigma^2 (binomial coefficients 1 3 3 1).
    """
    third = np.diff(series, n=3)
    usable = good[3:] & good[2:-1] & good[1:-2] & good[:-3]
    return float(1.4826 * np.median(np.abs(third[usable])) / np.sqrt(20.0)) if usable.any() else 0.0
