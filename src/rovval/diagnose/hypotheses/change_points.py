"""Times at which a log changes: where its residual force changes level, and where it begins to err.

Both split a series of windows in two where the means of its parts differ most (CUSUM; Page 1954), and the parts again (binary segmentation;
Scott and Knott 1974). The first series is split as long as permuted windows seldom differ as much; the second a fixed number of times, since it
only says where the fit of an onset begins.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import CHANGE_FALSE_ALARM, LEAST_WINDOWS
from rovval.diagnose.effort import GAP_CHANGE_SPLITS
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.windows.windows import Windows

PERMUTATIONS = 200  # resolve a false-alarm rate of 0.01
OUTLIER = 6.0  # robust standard deviations at which a window's score is clipped: one event is no change of level


def change_points(windows: Windows, score: Array, seed: int, level: float = CHANGE_FALSE_ALARM) -> list[float]:
    """Times (s since the run's start), in order, at which the residual force changes level.

    Args:
        windows: m windows of one run.
        score: (m, d) signed signals, one row a window; each is scaled by its own spread.
        seed: of the permutations.
        level: false-alarm rate of the first split, halved at each further one.
    """
    scale = 1.4826 * np.median(np.abs(np.diff(score, axis=0)), axis=0) / np.sqrt(2.0)  # from differences: a step does not inflate it
    usable = scale > 0
    signal = np.clip((score[:, usable] - np.median(score[:, usable], axis=0)) / scale[usable], -OUTLIER, OUTLIER)
    rng = np.random.default_rng(seed)
    return [float(windows.start[k] * windows.run.dt) for k in sorted(_segments(signal, 0, rng, level))]


def _segments(signal: Array, offset: int, rng: np.random.Generator, level: float) -> Iterator[int]:
    """Windows at which a new level begins, counted from ``offset``."""
    if len(signal) < 2 * LEAST_WINDOWS or signal.shape[1] == 0:
        return
    value, k = _cusum(signal)
    null = np.array([_cusum(signal[rng.permutation(len(signal))])[0] for _ in range(PERMUTATIONS)])
    if (null >= value).mean() < level and LEAST_WINDOWS <= k <= len(signal) - LEAST_WINDOWS:
        yield offset + k
        yield from _segments(signal[:k], offset, rng, level / 2)
        yield from _segments(signal[k:], offset + k, rng, level / 2)


def gap_change_points(problem: Problem) -> tuple[float, ...]:
    """Times (s since the first run's start) at which its windows begin to err more, or less; the most marked first.

    It is the logarithm of the nominal vehicle's gap that is split: coefficients that are free to fit the part after a change would spread it
    over the whole log.
    """
    windows = problem.runs[0]
    found = largest_changes(np.log(np.maximum(problem.gap.dynamics.c[: windows.count], 1e-12)), GAP_CHANGE_SPLITS)
    return tuple(float(windows.start[i] * windows.run.dt) for _, i in sorted(found, reverse=True))


def largest_changes(series: Array, splits: int, first: int = 0) -> list[tuple[float, int]]:
    """(Standardised difference of the means, index at which the second part begins) of a series (n,) that is split ``splits`` times over; indices
    count from ``first``."""
    if splits == 0 or len(series) < 2 * LEAST_WINDOWS:
        return []
    jump, k = _cusum(series[:, None])
    before, after = largest_changes(series[:k], splits - 1, first), largest_changes(series[k:], splits - 1, first + k)
    return [(jump, first + k), *before, *after]


def _cusum(signal: Array) -> tuple[float, int]:
    """Largest standardised difference of means over all splits and signals, and where."""
    n = len(signal)
    k = np.arange(1, n)[:, None]
    head = np.cumsum(signal, axis=0)[:-1]
    tail = signal.sum(axis=0) - head
    jump = np.abs(head / k - tail / (n - k)) * np.sqrt(k * (n - k) / n)
    jump[: LEAST_WINDOWS - 1], jump[1 - LEAST_WINDOWS :] = 0.0, 0.0
    return float(jump.max()), int(jump.max(axis=1).argmax()) + 1
