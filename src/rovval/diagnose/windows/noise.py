"""White noise of a log's channels, the samples that are measurements of their own, and outliers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.alignment.noise import white_noise
from rovval.core.data import Array, Flags, Run
from rovval.core.frames import wrap
from rovval.diagnose.criteria import LEAST_NOISE, OUTLIER_SIGMA, QUANTISED_MISFIT, QUANTISED_REPEATS
from rovval.diagnose.windows.attitude import ANGLES, tumbling, turned_through

ROUNDING = 1e-6  # of the largest step between values: a smaller one is rounding of single precision


def clean_channels(run: Run, channels: Sequence[str]) -> tuple[Array, Flags, Array, Flags]:
    """Channels of a run without outliers: (values, good, noise, outlier).

    Values (n, c), of the attitude of a run that tumbles the turns summed up (`attitude.turned_through`), are zero where they are not ``good`` (n, c): not
    measured, drawn between two samples, or an outlier. ``noise`` (c,) is the standard deviation of white noise, at least that of rounding. ``outlier`` (n,)
    are samples at which no window may begin.
    """
    values = run.stack(tuple(channels)).copy()
    if tumbling(run):
        turned, angles = turned_through(run, channels), [i for i, c in enumerate(channels) if c in ANGLES]
        values[:, angles] = turned[:, [ANGLES.index(channels[i]) for i in angles]]
    good = np.isfinite(values)
    noise, outliers = np.zeros(len(channels)), np.zeros(len(run), dtype=bool)
    for i, (name, stride) in enumerate(zip(channels, sample_strides(run, channels), strict=True)):
        real = np.arange(0, len(run), stride)
        keep = np.zeros(len(run), dtype=bool)
        keep[real] = good[real, i]
        series = values[real, i]
        outlier = _outliers(series, name)
        outliers[real] |= outlier & keep[real]
        keep[real] &= ~outlier
        noise[i] = max(white_noise(series, keep[real]), quantisation_step(run.get(name)) / np.sqrt(12.0))
        good[:, i] = keep
    return np.where(good, values, 0.0), good, noise, outliers


def sample_strides(run: Run, channels: Sequence[str]) -> tuple[int, ...]:
    """Grid points per measured sample of each channel: 1 at the grid's rate, 3 for a depth logged at 3 Hz. What alignment interpolated between
    two samples is no measurement of its own."""
    periods = [run.resampled[c].period_s if c in run.resampled else run.dt for c in channels]
    return tuple(max(1, round(period / run.dt)) for period in periods)


def _outliers(series: Array, name: str) -> Flags:
    """Isolated samples (n,) far from the mean of their neighbours."""
    outlier = np.zeros(len(series), dtype=bool)
    before, after = series[:-2] - series[1:-1], series[2:] - series[1:-1]
    bend = 0.5 * (wrap(before) + wrap(after)) if name in ANGLES else 0.5 * (before + after)
    finite = bend[np.isfinite(bend)]
    spread = 1.4826 * float(np.median(np.abs(finite))) if len(finite) else 0.0
    with np.errstate(invalid="ignore"):
        outlier[1:-1] = np.abs(bend) > OUTLIER_SIGMA * max(spread, 2 * LEAST_NOISE[name])
    return outlier


def quantisation_step(values: Array) -> float:
    """Step in which a channel is written, from values (n,) that repeat themselves; 0 where these lie on no grid. Two of them are a step apart
    where the channel is mostly at one of them: of one that clips they are the ends of its range. Rounding to a step errs uniformly, with a variance of a
    twelfth of its square (Widrow 1956)."""
    held = values[1:][values[1:] == values[:-1]]
    levels = np.unique(held)
    steps = np.diff(levels)
    if not len(steps) or len(levels) * QUANTISED_REPEATS > len(held):
        return 0.0
    if len(levels) == 2 and np.isin(values[np.isfinite(values)], levels).mean() <= 0.5:
        return 0.0
    steps = steps[steps > ROUNDING * steps.max()]
    multiples = steps / steps.min()
    return float(steps.min()) if (np.abs(multiples - np.round(multiples)) < QUANTISED_MISFIT).all() else 0.0
