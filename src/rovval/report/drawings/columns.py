"""The values that a picture shows, as columns that its reader saves as CSV: numbers packed as those of the curves are, words as they are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rovval.core.data import Array
from rovval.report.drawings import curves

Column = Mapping[str, Any]
MOST_PLACES = 700  # of a track, as many as are drawn: `rovval export` has all of them


def numbers(values: Array) -> Column:
    """A column of numbers (n,), NaN left empty."""
    return curves.encode(np.asarray(values, dtype=np.float64))


def words(values: Sequence[str | float]) -> Column:
    """A column of words, or of a few numbers that are to stand as they are."""
    return {"v": list(values)}


def against_time(dt: float, values: Mapping[str, Array]) -> dict[str, Column]:
    """Values (n,) by their headings, at every ``dt`` (s) from 0 on; of more than `curves.MOST_POINTS` rows the lowest and highest of each few."""
    n = max(len(v) for v in values.values())
    return {"time_s": curves.times(n, dt)} | {name: curves.encode(curves.thin(v)) for name, v in values.items()}


def along(dt: float, values: Mapping[str, Array]) -> dict[str, Column]:
    """The same of values that belong together, such as north and east: of more rows every few rows one."""
    n = max(len(v) for v in values.values())
    every = -(-n // MOST_PLACES)
    return {"time_s": curves.times(-(-n // every), dt * every)} | {name: numbers(v[::every]) for name, v in values.items()}
