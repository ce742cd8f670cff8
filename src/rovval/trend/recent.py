"""Whether a dive's gap lies above what the dives before it let expect: the prediction limit of a normal sample (Hahn and Meeker 1991, 4.8)."""

from __future__ import annotations

from math import erfc, exp, sqrt

import numpy as np
from scipy.special import stdtrit

from rovval.trend.series import Series

DIVES = 20  # that a dive is held against, the last ones before it; of fewer the limit is wider, by Student's t


def limits(series: Series, sigma: float) -> dict[str, float]:
    """By run, the gap that the dives before it let expect to be exceeded as rarely as ``sigma`` standard deviations of a normal distribution are;
    a run with fewer than two dives before it has none."""
    level, found = series.level, {}
    for i in range(2, len(level)):
        before = level[max(0, i - DIVES) : i]
        n = len(before)
        wide = float(stdtrit(n - 1, 1 - 0.5 * erfc(sigma / sqrt(2)))) * sqrt(1 + 1 / n)
        spread = max(float(np.std(before, ddof=1)), series.least)
        found[series.runs[i]] = exp(min(float(before.mean()) + wide * spread, 700.0))
    return found
