"""Times at which a log begins to err: where the search for what begins during a log begins.

The gap of every window is split in two where the logarithms of both parts scatter least about their means (one change point by least
squares), and each part once more (binary segmentation; Scott and Knott 1974). It is the nominal vehicle's gap: slop that is free to fit
the part after a break spreads it over the whole log.
"""

from __future__ import annotations

import numpy as np

from rovval.data import Array
from rovval.diagnose.problem import Problem

FEWEST = 3  # windows on each side of a break
PARTS = 2  # times that a log is split: at most three breaks


def breaks(problem: Problem) -> tuple[float, ...]:
    """Seconds since the first run's start at which its windows begin to err more, or less, the most marked first."""
    part = problem.parts[0]
    found = _split(np.log(np.maximum(problem.gap.c[: part.count], 1e-12)), 0, PARTS)
    return tuple(float(part.start[i] * part.run.dt) for _, i in sorted(found, reverse=True))


def _split(x: Array, first: int, times: int) -> list[tuple[float, int]]:
    """(What a break takes off the scatter, window at which it is, counted from ``first``) of a series and, again, of its two parts."""
    n = len(x)
    if times == 0 or n < 2 * FEWEST:
        return []
    before, after = np.cumsum(x)[:-1], x.sum() - np.cumsum(x)[:-1]
    size = np.arange(1, n)
    gain = before**2 / size + after**2 / (n - size) - x.sum() ** 2 / n
    at = FEWEST + int(np.argmax(gain[FEWEST - 1 : n - FEWEST]))
    return [(float(gain[at - 1]), first + at), *_split(x[:at], first, times - 1), *_split(x[at:], first + at, times - 1)]
