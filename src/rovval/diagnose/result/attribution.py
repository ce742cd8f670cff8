"""Attribution: where the gap lies, by axis, by regime (speed, turn, depth, heading, each thruster) and by time.

The gap of an axis is the sum of squared velocity errors (of the pose, where no velocity was logged) after the best initial state of each
window is taken out. A slice's share is its part of that sum, its lift the share over its part of the time: a lift of 1 is an even gap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags
from rovval.core.units import DEGREES
from rovval.diagnose.criteria import (
    LEAST_DEPTH_SPAN,
    LEAST_SPEED,
    LEAST_TURN_RATE,
    LEAST_WINDOWS,
    LOW_ALTITUDES,
    SLICE_LIFT,
    SLICES,
    SLICES_AN_AXIS,
    STRONG_QUANTILE,
    WORKING_SHARE,
)
from rovval.diagnose.windows.windows import Windows, axis_channels

RESAMPLES = 200  # draws of the bootstrap over windows (Efron and Tibshirani 1993: 50 to 200 for a standard error)


@dataclass(frozen=True, slots=True)
class Slice:
    """One axis in one regime.

    Attributes:
        axis: which axis.
        regime: when, in words.
        share: share of the axis's squared gap (1).
        time_share: share of the time (1).
        lift: share / time_share.
        low: lower end of lift's 90 % interval, by bootstrap over windows.
        high: upper end.
        windows: how many windows it touches.
    """

    axis: str
    regime: str
    share: float
    time_share: float
    lift: float
    low: float
    high: float
    windows: int


def regimes(stretches: Windows) -> dict[str, Flags]:
    """Regimes by name, each with the samples of m windows where it holds (m, n), from what was measured and commanded.

    One that holds always or never is left out.
    """
    run, found = stretches.run, dict[str, Flags]()
    at = stretches.start[:, None] + np.arange(stretches.steps + 1)[None, :]
    for name, unit, factor, floor in (*((name, "m/s", 1.0, LEAST_SPEED) for name in "uvw"), ("r", "deg/s", DEGREES, LEAST_TURN_RATE)):
        if run.measured(name):
            found.update(_levels(name, factor * run.get(name)[at], unit, floor))
    if run.measured("u"):
        change = np.abs(np.gradient(np.nan_to_num(run.get("u")), run.dt))[at]
        limit = float(np.quantile(change, STRONG_QUANTILE))
        found["transient (surge acceleration in its top fifth)"] = change > limit
        found["steady (surge acceleration below its median)"] = change < float(np.median(change))
    if run.measured("z") and np.ptp(run.get("z")[run.ok("z")]) > LEAST_DEPTH_SPAN:
        depth, middle = run.get("z")[at], float(np.nanmedian(run.get("z")))
        found[f"depth > {middle:.1f} m"], found[f"depth < {middle:.1f} m"] = depth > middle, depth < middle
    if run.measured("altitude"):
        height = run.get("altitude")[at]
        for limit in LOW_ALTITUDES:
            found[f"altitude < {limit:g} m"] = height < limit
    if run.measured("psi"):
        found.update(_headings(run.get("psi")[at]))
    found.update(_thrusters(stretches, at))
    for part in np.array_split(np.arange(len(at)), 3):  # by their times: the windows may begin in mid-log, where an onset was found
        flags = np.zeros(at.shape, dtype=bool)
        flags[part] = True
        found[f"time {run.dt * at[part].min():.0f} to {run.dt * (at[part].max() + 1):.0f} s"] = flags
    return {name: flags for name, flags in found.items() if 0.0 < flags.mean() < 1.0}


def slices(stretches: Windows, error: Array, ok: Flags, seed: int) -> list[Slice]:
    """Every axis in every regime.

    Args:
        stretches: the m windows of a run.
        error: residuals (m, n, c) of the c channels.
        ok: where they count (m, n, c).
        seed: of the bootstrap over windows.
    """
    rng = np.random.default_rng(seed)
    draws = rng.integers(0, len(error), (RESAMPLES, len(error)))
    found = []
    for axis, channel in axis_channels(stretches).items():
        square = np.where(ok[..., channel], error[..., channel] ** 2, 0.0)
        total = square.sum(axis=1)
        if total.sum() <= 0:
            continue
        for name, flags in regimes(stretches).items():
            inside, seconds = (square * flags).sum(axis=1), (flags & ok[..., channel]).sum(axis=1)
            if not seconds.sum():
                continue
            valid = ok[..., channel].sum(axis=1)
            share, time_share = inside.sum() / total.sum(), seconds.sum() / valid.sum()
            with np.errstate(invalid="ignore", divide="ignore"):
                lifts = (inside[draws].sum(1) / total[draws].sum(1)) / (seconds[draws].sum(1) / valid[draws].sum(1))
            lifts = lifts[np.isfinite(lifts)]
            low, high = np.quantile(lifts, [0.05, 0.95]) if len(lifts) else (np.nan, np.nan)
            found.append(
                Slice(axis, name, float(share), float(time_share), float(share / time_share), float(low), float(high), int((seconds > 0).sum()))
            )
    return found


def worst(found: list[Slice], axis_share: dict[str, float], most: int = SLICES) -> list[Slice]:
    """The slices that hold much of the whole gap in little of the time, with a lift whose interval stays above 1, the worst first.

    Of slices of one axis that cut the same quantity (``u > 0.3 m/s`` and ``|u| > 0.3 m/s``) only the first is kept. ``axis_share``: each
    axis's share of the whole gap.
    """
    able = [s for s in found if s.windows >= LEAST_WINDOWS and s.lift > SLICE_LIFT and s.low > 1.0]
    able.sort(key=lambda s: -(s.share - s.time_share) * axis_share.get(s.axis, 0.0))
    chosen: list[Slice] = []
    for one in able:
        same = [c for c in chosen if c.axis == one.axis]
        if len(same) < SLICES_AN_AXIS and len(chosen) < most and not any(_quantity(c) == _quantity(one) for c in same):
            chosen.append(one)
    return chosen


def _quantity(one: Slice) -> str:
    return one.regime.replace("|", "").split()[0]


def _levels(name: str, value: Array, unit: str, floor: float) -> dict[str, Flags]:
    """Strong, weak and signed bins of a velocity, cut at the top fifth and at the median of its size, rounded to two digits."""
    size = np.abs(np.nan_to_num(value))
    high = float(f"{np.quantile(size, STRONG_QUANTILE):.2g}")
    if high < floor:
        return {}
    low = float(f"{np.median(size):.2g}")
    return {
        f"{name} > {high:g} {unit}": value > high,
        f"{name} < {-high:g} {unit}": value < -high,
        f"|{name}| > {high:g} {unit}": size > high,
        f"|{name}| < {low:g} {unit}": size < low,
    }


def _headings(psi: Array) -> dict[str, Flags]:
    turned = np.mod(np.nan_to_num(psi) + np.pi / 4, 2 * np.pi)
    return {
        f"heading {words}": (turned >= i * np.pi / 2) & (turned < (i + 1) * np.pi / 2)
        for i, words in enumerate(("north", "east", "south", "west"))
    }


def _thrusters(stretches: Windows, at: np.ndarray) -> dict[str, Flags]:
    speed, found = stretches.actuation.inputs.speed[at], dict[str, Flags]()
    for i, name in enumerate(stretches.plant.vehicle.thrusters):
        limit = WORKING_SHARE * float(np.quantile(np.abs(speed[..., i]), 0.95))
        if limit > 0:
            found[f"{name} turning forward"] = speed[..., i] > limit
            found[f"{name} turning backward"] = speed[..., i] < -limit
    return found


