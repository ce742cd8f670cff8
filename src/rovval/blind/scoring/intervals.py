"""Numbers with intervals: Wilson and Clopper-Pearson for shares, bootstrap for means and medians. 90 % unless told."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypedDict

import numpy as np
from scipy.stats import beta

Z = 1.6448536  # standard normal, 95th percentile
RESAMPLES = 1000


class Number(TypedDict):
    """A value with its interval and how many logs it rests on; ``value`` None where none does."""

    value: float | None
    low: float | None
    high: float | None
    n: int


def share(hits: Sequence[bool | float]) -> Number:
    """Share of true with its Wilson interval."""
    n = len(hits)
    if n == 0:
        return {"value": None, "low": None, "high": None, "n": 0}
    p = float(np.mean(np.asarray(hits, dtype=float)))
    middle, half = p + Z**2 / (2 * n), Z * math.sqrt(p * (1 - p) / n + Z**2 / (4 * n * n))
    scale = 1.0 + Z**2 / n
    return {"value": p, "low": max(0.0, (middle - half) / scale), "high": min(1.0, (middle + half) / scale), "n": n}


def exact(hits: Sequence[bool]) -> Number:
    """Share of true with its Clopper-Pearson interval, which holds the true share in nine of ten sets at least, of whatever size."""
    n, k = len(hits), sum(map(bool, hits))
    if n == 0:
        return {"value": None, "low": None, "high": None, "n": 0}
    low = float(beta.ppf(0.05, k, n - k + 1)) if k else 0.0
    high = float(beta.ppf(0.95, k + 1, n - k)) if k < n else 1.0
    return {"value": k / n, "low": low, "high": high, "n": n}


def mean(values: Sequence[float]) -> Number:
    """Mean with its bootstrap interval."""
    return _resampled(values, np.mean)


def median(values: Sequence[float]) -> Number:
    """Median with its bootstrap interval."""
    return _resampled(values, np.median)


def _resampled(values: Sequence[float], of: Callable[..., Any]) -> Number:
    x = np.asarray([v for v in values if math.isfinite(v)], dtype=float)
    if not len(x):
        return {"value": None, "low": None, "high": None, "n": 0}
    draws = x[np.random.default_rng(0).integers(0, len(x), (RESAMPLES, len(x)))]
    low, high = np.quantile(of(draws, axis=1), [0.05, 0.95])
    return {"value": float(of(x)), "low": float(low), "high": float(high), "n": len(x)}
