"""One channel from its own stamps to the grid's: unchanged, mean, linear, circular, hold or its mean, and why a value is missing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import HELD, Resampling
from rovval.core.data import Array, Codes, Reason, Series
from rovval.core.frames import wrap

ON_GRID = 0.25  # of a step: how far a stamp may be from its grid point to be that grid point's sample (20 ms of jitter at 10 Hz fit)
FASTER_THAN_GRID = 1.5  # times the grid's rate: a channel above it is averaged, below it interpolated
HEAD = 1000  # samples by which most channels that are not on the grid are told at once
EPS_S = 1e-6  # stamps closer than this are the same


def on_grid(t: Array, start: float, dt: float) -> NDArray[np.int64] | None:
    """The grid point of each stamp where the whole channel lies on the grid, one sample a point; else None."""
    if len(t) > HEAD and on_grid(t[:HEAD], start, dt) is None:
        return None
    k = np.rint((t - start) / dt).astype(np.int64)
    near = np.abs(t - start - k * dt) <= ON_GRID * dt + EPS_S
    return k if near.all() and (np.diff(k) > 0).all() else None


def resample(
    series: Series, bad: Codes, start: float, n: int, dt: float, gap_s: float, method: Resampling, held_s: float | None = None
) -> tuple[Array, Codes, str]:
    """Values (n,) with NaN where missing, their `Reason` codes, and the method really used. ``held_s`` (s): how long a command is held after the
    last sample of all; None: at most one and a half median periods.

    ``bad`` (len(series),) holds the reason of samples that must not be used: nothing is interpolated across one.
    """
    grid: Array = np.asarray(start + np.arange(n) * dt, dtype=np.float64)
    good = _good(bad)
    t, v = series.t[good], series.values[good]
    if len(t) == 0:
        return np.full(n, np.nan), _at(series.t, bad, grid), "none"
    values, codes = _hold(series, bad, grid, gap_s, held_s) if method in HELD else _linear(series, bad, grid, gap_s, method == "circular")
    k = on_grid(series.t, start, dt)
    if k is None and method == "hold_mean":
        values = _mean_until_next(t, v, grid, dt, values, codes)
    if k is not None:
        said, at, exact = "unchanged" if len(k) < 2 or np.median(np.diff(k)) == 1 else _name(method), k[good], v
    elif method in ("mean", "circular") and len(t) > 2 and float(np.median(np.diff(t))) * FASTER_THAN_GRID < dt:
        said, (at, exact) = f"{method} mean".replace("mean mean", "mean"), _bin_mean(t, v, start, n, dt, method == "circular")
    else:
        said = _name(method)
        at, exact = np.zeros(0, dtype=np.int64), np.zeros(0)
    inside = (at >= 0) & (at < n)
    values[at[inside]] = exact[inside]
    codes[at[inside]] = Reason.OK
    values[codes != Reason.OK] = np.nan
    return values, codes, said


def _good(bad: Codes) -> NDArray[np.int64] | slice:
    """Where the samples stand that may be used; all of them as a slice, which copies nothing."""
    return np.flatnonzero(bad == Reason.OK) if bad.any() else slice(None)


def _name(method: Resampling) -> str:
    """The method as it acts on a channel that is no faster than the grid."""
    return {"mean": "linear", "circular": "circular linear"}.get(method, method)


def _bin_mean(t: Array, v: Array, start: float, n: int, dt: float, circular: bool) -> tuple[NDArray[np.int64], Array]:
    """Mean of the samples within half a step of each grid point, where their mean stamp is near it as well."""
    k = np.floor((t - start) / dt + 0.5).astype(np.int64)
    inside = slice(*np.searchsorted(k, (0, n)))  # stamps rise
    k, t, v = k[inside], t[inside], v[inside]
    count = np.bincount(k, minlength=n)

    def mean(x: Array) -> Array:
        return np.asarray(np.bincount(k, weights=x, minlength=n) / np.maximum(count, 1))

    off = np.abs(mean(t - start) - np.arange(n) * dt)
    value = np.arctan2(mean(np.sin(v)), mean(np.cos(v))) if circular else mean(v)
    at = np.flatnonzero((count > 0) & (off <= ON_GRID * dt + EPS_S))
    return at, value[at]


def _linear(series: Series, bad: Codes, grid: Array, gap_s: float, circular: bool) -> tuple[Array, Codes]:
    good = _good(bad)
    t, v = series.t[good], series.values[good]
    codes = _outside(series.t, bad, t, grid, 0.0)
    if len(t) == 1:
        return np.full(len(grid), v[0]), np.where((codes == Reason.OK) & (np.abs(grid - t[0]) > EPS_S), Reason.GAP, codes).astype(np.uint8)
    g = np.clip(grid, t[0], t[-1])
    j = np.clip(np.searchsorted(t, g, "right"), 1, len(t) - 1)
    width = t[j] - t[j - 1]
    step = wrap(v[j] - v[j - 1]) if circular else v[j] - v[j - 1]
    share = (g - t[j - 1]) / width
    values = np.where(share < 1.0, v[j - 1] + step * share, v[j])
    inner = (codes == Reason.OK) & (share * width > EPS_S) & ((1.0 - share) * width > EPS_S)
    codes[inner & (width > gap_s + EPS_S)] = Reason.GAP
    if not isinstance(good, slice):
        skipped = inner & (good[j] - good[j - 1] > 1)
        codes[skipped] = bad[good[j - 1] + 1][skipped]
    return (wrap(values) if circular else values), codes


def _hold(series: Series, bad: Codes, grid: Array, gap_s: float, held_s: float | None) -> tuple[Array, Codes]:
    good = _good(bad)
    t, v = series.t[good], series.values[good]
    period = float(np.median(np.diff(t))) if len(t) > 1 else 0.0
    codes = _outside(series.t, bad, t, grid, min(gap_s, FASTER_THAN_GRID * period) if held_s is None else held_s)
    i = np.clip(np.searchsorted(t, grid + EPS_S, "right") - 1, 0, len(t) - 1)
    after = np.clip(i + 1, 0, len(t) - 1)
    age = grid - t[i]
    codes[(codes == Reason.OK) & (age > EPS_S) & (t[after] - t[i] > gap_s + EPS_S)] = Reason.GAP
    last = np.clip(np.searchsorted(series.t, grid + EPS_S, "right") - 1, 0, len(bad) - 1)
    skipped = (codes == Reason.OK) & (bad[last] != Reason.OK)
    codes[skipped] = bad[last][skipped]
    return np.array(v[i]), codes


def _mean_until_next(t: Array, v: Array, grid: Array, dt: float, held: Array, codes: Codes) -> Array:
    """Mean of what is held between each grid point and the next, so that a command which comes between them acts for as long as it did and not half a step
    late; the value ``held`` at the grid point alone where none is held at the next."""
    edges = np.append(grid, grid[-1] + dt)
    i = np.clip(np.searchsorted(t, edges + EPS_S, "right") - 1, 0, len(t) - 1)
    until = np.concatenate([[0.0], np.cumsum(v[:-1] * np.diff(t))])[i] + v[i] * (edges - t[i])
    whole = (codes == Reason.OK) & (np.append(codes[1:], Reason.AFTER_LAST) == Reason.OK)
    steady = i[1:] == i[:-1]  # and there the value itself, to the last bit
    mean = np.clip(np.diff(until) / dt, v.min(), v.max())  # which it leaves by rounding alone: what stands at the end of a range stays in it
    return np.where(whole & ~steady, mean, held)


def _outside(every: Array, bad: Codes, t: Array, grid: Array, tail_s: float) -> Codes:
    """OK within the good samples (and ``tail_s`` after them), else why not."""
    codes = np.zeros(len(grid), dtype=np.uint8)
    lead, tail = grid < t[0] - EPS_S, grid > t[-1] + tail_s + EPS_S
    codes[lead] = np.where(grid[lead] < every[0] - EPS_S, Reason.BEFORE_FIRST, _at(every, bad, grid[lead]))
    codes[tail] = np.where(grid[tail] > every[-1] + EPS_S, Reason.AFTER_LAST, _at(every, bad, grid[tail]))
    return codes


def _at(every: Array, bad: Codes, grid: Array) -> Codes:
    """Reason of the sample at or before each grid point, or of the one after it."""
    before = np.clip(np.searchsorted(every, grid + EPS_S, "right") - 1, 0, len(bad) - 1)
    after = np.clip(before + 1, 0, len(bad) - 1)
    return np.where(bad[before] != Reason.OK, bad[before], np.where(bad[after] != Reason.OK, bad[after], Reason.GAP)).astype(np.uint8)
