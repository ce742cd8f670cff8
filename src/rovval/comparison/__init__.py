"""A run beside a simulation of it: per axis, how far the simulated motion is from the measured one.

Errors are simulated minus measured, angles wrapped into (-pi, pi]. A row counts for a channel when it was measured and was
simulated; nothing is filled in. Windows are pooled: their RMS is the root mean square over all rows of all windows, never a
mean of the windows' own. The first row of each window, where the simulation was restarted on the measured state and the error
is zero by construction, is counted like any other (1 row in 100 for windows of 10 s).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rovval.alignment.noise import channel_noise
from rovval.comparison import metrics
from rovval.comparison.block_bootstrap import intervals
from rovval.comparison.trajectory import track_error
from rovval.core.channels import AXES, DRIVING, POSE, VELOCITIES, channel
from rovval.core.data import Array, ChannelError, Comparison, Flags, Run, SimResult
from rovval.core.errors import BadInput, SimulationStopped
from rovval.core.frames import attitude_difference, tilt_difference, tumbles, wrap

if TYPE_CHECKING:
    from numpy.typing import NDArray

ATTITUDE = ("phi", "theta", "psi")
POSE_COMPARED = ("z", *ATTITUDE)
LEAST_COVERAGE = 0.1  # of a run's rows, beside those that a stretch starts on: fewer are no comparison of that run
CORE = ("mean_error", "iae", "mae", "rmse")


def compare(
    run: Run,
    sim: SimResult,
    other: Mapping[str, Array] | Array | None = None,
    other_name: str = "",
) -> Comparison:
    """The per-axis error of a simulation of this run, free and in windows, and of a second simulator on the same rows.

    ``other`` holds another simulator's velocities on the run's grid, by channel or axis name or as (n, 6), NaN where it has
    none. Its errors are over the rows that the measurement, our free run and it have in common, and ours over just these rows
    stand beside them in ``extra`` (``ours_mae`` and so on), so that the two are compared like with like.

    Raises:
        BadInput: the three do not have the same number of rows, have none in common, or less than a tenth of the run could be compared.
        SimulationStopped: the simulation left sane limits before any row could be compared.
    """
    if sim.free.nu.shape != (len(run), 6) or sim.windowed.nu.shape != (len(run), 6):
        raise BadInput(f"run {run.id} has {len(run)} rows, its simulation {len(sim.free.nu)}", "simulate this very run again")
    free: dict[str, ChannelError] = {}
    windowed: dict[str, ChannelError] = {}
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        measured, ok = run.get(name), run.ok(name)
        for table, traj, block in ((free, sim.free, 1), (windowed, sim.windowed, _window_rows(sim))):
            row = _error(name, traj.nu[:, j], measured, ok & traj.ok, np.zeros(len(run)), run.dt, block)
            if row is not None:
                table[axis] = replace(row, noise=channel_noise(run, name))
    absent = tuple(a for a, n in zip(AXES, VELOCITIES, strict=True) if not run.measured(n))
    pose = _pose(run, sim)
    if not free and not windowed and not pose:
        if sim.stops and len(absent) < 6:
            raise SimulationStopped(f"run {run.id}: no row to compare: {sim.stops[0]}", "look at the run's first samples")
        raise BadInput(f"run {run.id}: neither a velocity nor a pose was both measured and simulated", f"not measured: {', '.join(absent)}")
    if not sim.stops:
        _refuse_sparse(run, sim)
    nu = None if other is None else _velocities(other, len(run), other_name)
    return Comparison(
        run=run,
        sim=sim,
        free=free,
        windowed=windowed,
        pose=pose,
        not_measured=absent,
        other={} if nu is None else _other(run, sim, nu),
        other_name=other_name or ("other" if nu is not None else ""),
        other_nu=nu,
        track=track_error(run, sim),
    )


def _refuse_sparse(run: Run, sim: SimResult) -> None:
    """Raises `BadInput` where hardly a row was both measured and simulated for longer than the sample that it was started from."""
    told = [n for n in VELOCITIES if run.measured(n)] or list(POSE_COMPARED)  # what the answer is about: where there is a velocity, the velocities
    measured = np.any([run.ok(n) for n in told], axis=0)
    share = max(float((measured & t.ok & ~_starts(t.stretch)).mean()) for t in (sim.free, sim.windowed))
    if share >= LEAST_COVERAGE:
        return
    slowest = max((r.period_s for n, r in run.resampled.items() if n.partition(":")[0] in DRIVING), default=run.dt)
    raise BadInput(
        f"run {run.id}: {100 * share:.1f} % of its {len(run)} rows can be compared, less than {100 * LEAST_COVERAGE:.0f} %: "
        f"the thrusters and the motion are hardly ever known together (slowest channel: one sample in {slowest:.3g} s)",
        "see the gaps among its findings; a profile may bridge longer ones with longest_gap_s, or give a log of a higher rate",
    )


def _starts(stretch: NDArray[np.int64]) -> Flags:
    """The rows on which a stretch starts (n,): there the simulated state is the measured one and the error is zero by construction."""
    return np.asarray(np.r_[True, stretch[1:] != stretch[:-1]])


def _first_kept(stretch: NDArray[np.int64], keep: Flags) -> NDArray[np.int64]:
    """For each row, the first kept row of its stretch (n,); the row itself where there is none."""
    rows = np.arange(len(stretch))
    first = np.full(int(stretch.max(initial=-1)) + 1, len(stretch))
    np.minimum.at(first, stretch[keep], rows[keep])
    found = first[np.maximum(stretch, 0)] if len(first) else np.full(len(stretch), len(stretch))
    return np.where((stretch >= 0) & (found < len(stretch)), found, rows)


def _window_rows(sim: SimResult) -> int:
    """Rows of a whole window."""
    return round(sim.window_s / sim.dt)


def _error(name: str, simulated: Array, measured: Array, keep: Flags, baseline: Array, dt: float, block: int = 1) -> ChannelError | None:
    """One row of a table, or None where the channel has no row to compare; rows that hang together as the ``block`` of a window does."""
    keep = keep & np.isfinite(simulated) & np.isfinite(measured) & np.isfinite(baseline)
    if not keep.any():
        return None
    angle = channel(name).unit == "rad"
    error = _difference(simulated, measured, angle)
    trivial = _difference(baseline, measured, angle)
    core = {m: metrics.get(m).compute(error, keep, dt) for m in CORE}
    base = {m: metrics.get(m).compute(trivial, keep, dt) for m in ("mae", "rmse")}
    return ChannelError(
        channel=name,
        unit=channel(name).unit,
        n=int(keep.sum()),
        coverage=float(keep.mean()),
        baseline_mae=base["mae"],
        baseline_rmse=base["rmse"],
        skill=1.0 - (core["rmse"] / base["rmse"]) ** 2 if base["rmse"] > 0.0 else None,
        extra=_extra(error, keep, dt, measured),
        intervals=intervals(error[keep], trivial[keep], dt, block),
        **core,
    )


def _difference(a: Array, b: Array, angle: bool) -> Array:
    """a - b, NaN where either is missing."""
    d = a - b
    return np.where(np.isfinite(d), wrap(np.nan_to_num(d)), np.nan) if angle else d


def _extra(error: Array, keep: Flags, dt: float, measured: Array) -> Mapping[str, float]:
    """Every further metric of the folder; one that is not defined for this channel (it never moved) is left out."""
    values = {}
    for name in metrics.names():
        if name in CORE:
            continue
        try:
            values[name] = metrics.get(name).compute(error, keep, dt, measured)
        except BadInput:
            continue
    return values


def _pose(run: Run, sim: SimResult) -> Mapping[str, ChannelError]:
    """Depth and attitude of the windows, against the predictor that stays where the window began. Where the run or its simulation tumbles, errors of
    attitude are turns in body axes."""
    stretch, result = sim.windowed.stretch, {}
    tumbling = tumbles(run.get("theta")) or tumbles(sim.windowed.eta[:, POSE.index("theta")])
    for name in POSE_COMPARED:
        measured = run.get(name)
        keep = run.ok(name) & sim.windowed.ok & (stretch >= 0)
        first = _first_kept(stretch, keep)
        simulated, still = sim.windowed.eta[:, POSE.index(name)], measured[first]
        if tumbling and name in ATTITUDE:
            euler, axis = run.stack(ATTITUDE), ATTITUDE.index(name)
            simulated, still = (measured + _turn(run, x, euler)[:, axis] for x in (sim.windowed.eta[:, 3:], euler[first]))
        row = _error(name, simulated, measured, keep, still, run.dt, _window_rows(sim))
        if row is not None:
            result[name] = replace(row, noise=channel_noise(run, name))
    return result


def _turn(run: Run, to: Array, euler: Array) -> Array:
    """Rotation vectors (n, 3) from measured to other Euler angles (n, 3); without the heading's where it was not logged."""
    return attitude_difference(to, euler) if run.measured("psi") else tilt_difference(to, euler)


def _velocities(other: Mapping[str, Array] | Array, n: int, name: str) -> Array:
    """Another simulator's velocities as (n, 6)."""
    if not isinstance(other, Mapping):
        nu = np.array(other, dtype=float)
    else:
        known = {**dict(zip(AXES, range(6), strict=True)), **dict(zip(VELOCITIES, range(6), strict=True))}
        if strange := sorted(set(other) - set(known)):
            raise BadInput(f"simulation {name!r} has channels {', '.join(strange)}", f"use {', '.join(VELOCITIES)}")
        if wrong := [k for k, v in other.items() if np.shape(v) != (n,)]:
            raise BadInput(f"simulation {name!r}: {wrong[0]} has {np.shape(other[wrong[0]])} values, the run {n} rows")
        nu = np.full((n, 6), np.nan)
        for key, values in other.items():
            nu[:, known[key]] = values
    if nu.shape != (n, 6):
        raise BadInput(f"simulation {name!r} has shape {nu.shape}, the run needs ({n}, 6)", "bring it to the run's 10 Hz grid")
    nu.setflags(write=False)
    return nu


def _other(run: Run, sim: SimResult, nu: Array) -> Mapping[str, ChannelError]:
    """The second simulator's errors, with ours over the same rows in ``extra``."""
    result = {}
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        keep = run.ok(name) & sim.free.ok & np.isfinite(nu[:, j])
        measured, still = run.get(name), np.zeros(len(run))
        row = _error(name, nu[:, j], measured, keep, still, run.dt)
        if row is None:
            continue
        extra = dict(row.extra)
        for label, traj in (("ours", sim.free), ("ours_windowed", sim.windowed)):
            ours = _error(name, traj.nu[:, j], measured, keep & traj.ok, still, run.dt)
            if ours is not None:
                extra |= {f"{label}_{m}": getattr(ours, m) for m in CORE} | {f"{label}_n": float(ours.n)}
        result[axis] = replace(row, extra=extra)
    return result
