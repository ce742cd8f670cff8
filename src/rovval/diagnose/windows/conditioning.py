"""Conditioning of a run: samples at the end of a sensor's range are masked, and values repeated until the next ping count as one sample.

Else both would be read as effects: a rate that clips as a bias of the gyro, velocities held between pings as a filter's lag.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.data import Array, Flags, Reason, Resampled, Run
from rovval.core.errors import Finding
from rovval.diagnose.criteria import (
    HELD_SHARE,
    LEAST_NOISE,
    PING_REGULARITY,
    SATURATED_PROMINENCE,
    SATURATED_RISE,
    SATURATED_SAMPLES,
    SLOWEST_PING,
)
from rovval.diagnose.windows.noise import quantisation_step

NO_MEASUREMENT = ("saturated", "held")  # codes of the findings
RATES = ("u", "v", "w", "p", "q", "r")  # channels that can reach the end of a sensor's range
PINGED = ("u", "v", "w")  # one instrument measures them, so that they are new together


def condition(run: Run) -> tuple[Run, tuple[Finding, ...]]:
    """The run with saturated samples masked and held velocities interpolated between pings, as those of a log at the pings' rate are; and the findings,
    of codes `NO_MEASUREMENT`."""
    values, reasons, resampled = dict(run.values), dict(run.reasons), dict(run.resampled)
    found = list[Finding]()
    for name in (c for c in RATES if run.measured(c)):
        if _never_changes(run.get(name)):
            reasons[name] = np.full_like(reasons[name], Reason.SATURATED)
            found.append(Finding("saturated", name, f"says {np.nanmax(run.get(name)):.4g} (SI units) all along, which no sensor does, and was left out"))
            continue
        stop = saturated(run.get(name), LEAST_NOISE[name])
        if stop.any():
            reasons[name] = np.where(stop, Reason.SATURATED, reasons[name]).astype(np.uint8)
            levels = " and ".join(f"{x:.4g}" for x in np.unique(values[name][stop]))
            detail = f"stands at the end of its sensor's range ({levels} in SI units) for {stop.sum() * run.dt:.0f} s, which were left out"
            found.append(Finding("saturated", name, detail))
    pinged = tuple(c for c in PINGED if run.measured(c))
    stride, first = ping_period(run.stack(pinged)) if pinged else (1, 0)
    if stride > 1:
        period = stride * run.dt
        for name in pinged:
            values[name], resampled[name] = _interpolated(run.get(name), stride, first), _at_ping_rate(resampled, name, period, len(run) // stride)
        detail = f"hold their values between pings, a new one every {period:.2g} s, and were drawn between these"
        found.append(Finding("held", ", ".join(pinged), detail))
    if not found:
        return run, ()
    return replace(run, values=values, reasons=reasons, resampled=resampled, findings=(*run.findings, *found)), tuple(found)


def saturated(values: Array, least: float) -> Flags:
    """Samples (n,) of a channel at the end of its sensor's range: the same extreme value many times, reached in a step that rounding does not make, larger
    than ``least``, below which no sensor is believed: a steady state is neared slowly. Noise never repeats a value that rounding does not."""
    known = values[np.isfinite(values)]
    stop = np.zeros(len(values), dtype=bool)
    between = known[(known > known.min(initial=np.inf)) & (known < known.max(initial=-np.inf))]
    if not len(between):
        return stop
    rounding = quantisation_step(between)
    for sign in (1.0, -1.0):
        levels, counts = np.unique(sign * known, return_counts=True)
        if len(levels) < 2 or counts[-1] < max(SATURATED_SAMPLES, SATURATED_PROMINENCE * counts[-4:-1].max()):
            continue
        here: Flags = np.asarray(sign * values == levels[-1])
        first = np.flatnonzero(here[1:] & ~here[:-1])
        rise = sign * (values[first + 1] - values[first])
        if len(first) and float(np.nanmedian(rise)) > max(SATURATED_RISE * rounding, least):
            stop |= here
    return stop


def _never_changes(values: Array) -> bool:
    """Whether a channel holds one and the same value other than 0; zeros are plausible of a vehicle that keeps to another axis."""
    known = values[np.isfinite(values)]
    return bool(len(known) > 1 and np.ptp(known) == 0.0 and known[0] != 0.0)


def ping_period(values: Array) -> tuple[int, int]:
    """Period (samples) at which channels (n, c) change and the first sample at which they do; (1, 0) where they do not hold their values between.

    A vehicle at rest in a coarsely written log repeats values, too, but at no regular period.
    """
    change = np.diff(values, axis=0)
    new = np.flatnonzero(((change != 0.0) & np.isfinite(change)).any(axis=1)) + 1
    if len(new) < SATURATED_SAMPLES or len(new) > (1.0 - HELD_SHARE) * len(values):
        return 1, 0
    strides = range(SLOWEST_PING, 1, -1)
    on = {k: np.bincount(new % k, minlength=k) for k in strides}
    return next(((k, int(count.argmax())) for k, count in on.items() if count.max() >= PING_REGULARITY * len(new)), (1, 0))


def _interpolated(values: Array, stride: int, first: int) -> Array:
    """Values (n,) interpolated linearly between pings; unknown ones, and those before the first ping and after the last, as they are."""
    grid = np.arange(len(values))
    at = grid[first::stride][np.isfinite(values[first::stride])]
    inside = np.isfinite(values) & (grid >= at[0]) & (grid <= at[-1])
    return np.where(inside, np.interp(grid, at, values[at]), values)


def _at_ping_rate(resampled: Mapping[str, Resampled], name: str, period_s: float, samples: int) -> Resampled:
    """How a channel came onto the grid, ``samples`` of them every ``period_s`` (s)."""
    before = resampled.get(name)
    if before is None:
        return Resampled("linear", samples, period_s, period_s, period_s, 1.0)
    return replace(before, samples=samples, period_s=period_s, largest_gap_s=max(before.largest_gap_s, period_s))
