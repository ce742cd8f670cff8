"""Intervals of the errors of a comparison, by a circular block bootstrap (Politis and Romano 1992).

Errors of neighbouring rows are alike. They are therefore drawn in blocks, as long as Politis and White 2004 advise for the mean (as corrected by Patton,
Politis and White 2009), and of whole windows of the simulation, in which they grow. Few blocks spread too little: the percentiles are widened as
Hesterberg 2015, 5.3 ("expanded percentile") does for few samples.

An interval is of what other stretches of the same kind of motion would show. It says nothing of motion that is not in the log.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, log10, sqrt

import numpy as np

from rovval.comparison.autocorrelation import autocovariance
from rovval.core.data import Array

CONFIDENCE = 0.90  # as of all intervals of rovval
RESAMPLES = 1000  # Efron and Tibshirani 1993, 13.3: for percentiles
SEED = 0  # chosen: the same log gives the same interval
FEWEST_BLOCKS = 6  # chosen: a minute in windows of 10 s; of fewer blocks no spread can be told
# Politis and White 2004, 3.2: lags beyond which correlation is chance, by a band and a run of lags inside it; the longest block
BAND, RUN_OF_LAGS, LONGEST_BLOCK = 2.0, 5, 3.0
ROUNDING = 1e-24  # of the mean square: a variance below it is what rounding leaves of a constant


def intervals(error: Array, trivial: Array, dt: float, least_block: int = 1) -> Mapping[str, tuple[float, float]]:
    """(low, high) of ``mean_error``, ``mae``, ``iae``, ``rmse`` and ``skill`` of errors (n,) beside those of the ``trivial`` predictor (n,). Without
    `FEWEST_BLOCKS` blocks of ``least_block`` rows there are none; the skill has none where the trivial predictor makes no error."""
    n = len(error)
    if n < max(FEWEST_BLOCKS * least_block, 2 * FEWEST_BLOCKS):
        return {}
    windows = ceil(max(block_length(error), block_length(error**2)) / least_block)
    block = least_block * min(windows, n // (FEWEST_BLOCKS * least_block))
    means = _resampled(np.stack([error, np.abs(error), error**2, trivial**2], axis=1), block, least_block)
    drawn = {"mean_error": means[:, 0], "mae": means[:, 1], "iae": means[:, 1] * n * dt, "rmse": np.sqrt(means[:, 2])}
    if (means[:, 3] > 0.0).all():
        drawn["skill"] = 1.0 - means[:, 2] / means[:, 3]
    tail = _tail(n // block)
    return {name: (float(low), float(high)) for name, values in drawn.items() for low, high in [np.quantile(values, [tail, 1.0 - tail])]}


def block_length(series: Array) -> int:
    """Rows of a block for the mean of a stationary ``series`` (n,), by the flat-top window of Politis and White 2004, equations 9 to 14."""
    n = len(series)
    most = min(ceil(sqrt(n)) + RUN_OF_LAGS, n - 1)
    covariance = autocovariance(series, most)
    if covariance[0] <= ROUNDING * np.mean(series**2):
        return 1
    alike = np.flatnonzero(np.abs(covariance[1:] / covariance[0]) >= BAND * sqrt(log10(n) / n)) + 1
    ends = np.flatnonzero(np.diff(np.r_[0, alike, most + RUN_OF_LAGS + 1]) > RUN_OF_LAGS)
    last = int(np.r_[0, alike][ends[0]])  # the first lag that so many inside the band follow
    width = min(2 * max(last, 1), most)
    lags = np.arange(-width, width + 1)
    weight = np.clip(2.0 * (1.0 - np.abs(lags) / width), 0.0, 1.0)
    weighted = weight * covariance[np.abs(lags)]
    slope, level = float(weighted @ np.abs(lags)), float(weighted.sum())
    best = (2.0 * slope**2 / (4.0 / 3.0 * level**2) * n) ** (1.0 / 3.0) if level else float(n)
    return max(1, round(min(best, LONGEST_BLOCK * sqrt(n), n / 3.0)))


def _resampled(columns: Array, block: int, step: int) -> Array:
    """Means (resamples, k) of ``columns`` (n, k) over as many whole blocks as there is room for, which begin at any ``step`` and go round the end."""
    n = len(columns)
    total = np.cumsum(np.concatenate([np.zeros((1, columns.shape[1])), columns, columns[:block]]), axis=0)
    blocks = (total[block : block + n] - total[:n]) / block
    starts = np.random.default_rng(SEED).integers(0, n // step, (RESAMPLES, n // block))
    return np.asarray(blocks[starts * step].mean(axis=1))


def _tail(blocks: int) -> float:
    """Share of the resamples beyond each end: that of a normal where t of so many blocks is as far out (Hesterberg 2015, 5.3)."""
    from scipy.special import ndtr, stdtrit

    return float(ndtr(sqrt(blocks / (blocks - 1.0)) * stdtrit(blocks - 1.0, (1.0 - CONFIDENCE) / 2.0)))
