"""White noise of a sensor, from the log of its channel alone."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, Flags, Run


def white_noise(series: Array, good: Flags) -> float:
    """White noise of a channel from third differences (median absolute, so that manoeuvres do not count).

    A third difference of white noise has variance 20 sigma^2 (binomial coefficients 1 3 3 1).
    """
    third = np.diff(series, n=3)
    usable = good[3:] & good[2:-1] & good[1:-2] & good[:-3]
    return float(1.4826 * np.median(np.abs(third[usable])) / np.sqrt(20.0)) if usable.any() else 0.0


def channel_noise(run: Run, name: str) -> float:
    """White noise of a run's channel, in its unit, from the samples that were measured: of a sensor slower than the grid one in so many; 0 where too few
    follow each other."""
    period = run.resampled[name].period_s if name in run.resampled else run.dt
    every = slice(None, None, max(1, round(period / run.dt)))
    return white_noise(run.get(name)[every], run.ok(name)[every])
