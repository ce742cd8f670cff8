"""Intervals of a relative reduction by a circular block bootstrap over windows (Kuensch 1989; Politis and Romano 1992)."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.effort import BOOTSTRAP_RESAMPLES


def shrinkage_interval(before: Array, after: Array, seed: int, block: int = 2) -> tuple[float, float, float]:
    """Reduction 1 - sum(after) / sum(before) with its 90 % interval: (value, low, high); ``before`` and ``after`` (m,) are squared errors of each window."""
    draws = block_resamples(len(before), block, np.random.default_rng(seed))
    value = 1.0 - after.sum() / before.sum()
    low, high = np.quantile(1.0 - after[draws].sum(axis=1) / before[draws].sum(axis=1), [0.05, 0.95])
    return float(value), float(low), float(high)


def block_resamples(m: int, block: int, rng: np.random.Generator) -> np.ndarray:
    """Indices (`BOOTSTRAP_RESAMPLES`, m) of m windows, drawn in circular blocks of ``block`` neighbours."""
    starts = rng.integers(0, m, (BOOTSTRAP_RESAMPLES, m // block + 1))
    return np.asarray(((starts[..., None] + np.arange(block)) % m).reshape(BOOTSTRAP_RESAMPLES, -1)[:, :m])
