"""Times at which a log changes: where its residual force changes level, and where it begins to err, from which the search for what
begins during a log starts.

Both split a series of windows in two where the means of its parts differ most (CUSUM), and the parts again (binary segmentation; Scott
and Knott 1974): the one as long as permuted windows seldom differ as much, the other a few times, for it only has to begin somewhere.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.windows.shooting import Stretches

FEWEST = 3  # windows on each side of a change
FEWEST_TESTED = 10  # windows that are tested for a change of level
PERMUTED = 200
SPLITS = 2  # times that the gap is split: at most three breaks


def change_points(stretches: Stretches, score: Array, seed: int, level: float = 0.01) -> list[float]:
    """Times (s) at which the residual force changes level. ``score`` (m, d): per-window signed signals; binary segmentation with a
    CUSUM whose threshold comes from permuted windows."""
    scale = 1.4826 * np.median(np.abs(np.diff(score, axis=0)), axis=0) / np.sqrt(2.0)  # from differences: a step does not inflate it
    usable = scale > 0
    signal = np.clip((score[:, usable] - np.median(score[:, usable], axis=0)) / scale[usable], -6, 6)
    rng = np.random.default_rng(seed)
    return [float(stretches.start[k] * stretches.run.dt) for k in sorted(_segment(signal, 0, rng, level))]


def _segment(signal: Array, offset: int, rng: np.random.Generator, level: float) -> Iterator[int]:
    if len(signal) < FEWEST_TESTED or signal.shape[1] == 0:
        return
    value, k = _cusum(signal)
    null = np.array([_cusum(signal[rng.permutation(len(signal))])[0] for _ in range(PERMUTED)])
    if (null >= value).mean() < level and FEWEST <= k <= len(signal) - FEWEST:
        yield offset + k
        yield from _segment(signal[:k], offset, rng, level / 2)
        yield from _segment(signal[k:], offset + k, rng, level / 2)


def breaks(problem: Problem) -> tuple[float, ...]:
    """Seconds since the first run's start at which its windows begin to err more, or less, the most marked first. It is the nominal vehicle's
    gap, by its logarithm: slop that is free to fit the part after a break spreads it over the whole log."""
    part = problem.parts[0]
    found = _split(np.log(np.maximum(problem.gap.c[: part.count], 1e-12)), 0, SPLITS)
    return tuple(float(part.start[i] * part.run.dt) for _, i in sorted(found, reverse=True))


def _split(x: Array, first: int, times: int) -> list[tuple[float, int]]:
    """(How far the means differ, window at which they do, counted from ``first``) of a series and, again, of its two parts."""
    if times == 0 or len(x) < 2 * FEWEST:
        return []
    jump, k = _cusum(x[:, None])
    return [(jump, first + k), *_split(x[:k], first, times - 1), *_split(x[k:], first + k, times - 1)]


def _cusum(signal: Array) -> tuple[float, int]:
    """Largest standardised difference of means over all splits and signals, and where."""
    n = len(signal)
    k = np.arange(1, n)[:, None]
    head = np.cumsum(signal, axis=0)[:-1]
    tail = signal.sum(axis=0) - head
    jump = np.abs(head / k - tail / (n - k)) * np.sqrt(k * (n - k) / n)
    jump[: FEWEST - 1], jump[1 - FEWEST :] = 0.0, 0.0
    return float(jump.max()), int(jump.max(axis=1).argmax()) + 1
