"""Runs that are one log given twice: under another name, by another profile, or a stretch of it beside the whole."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from rovval.core.data import Run


def duplicates(runs: Sequence[Run]) -> list[tuple[int, int]]:
    """Pairs (earlier, later) of places in ``runs`` of which the shorter holds no sample that the other does not hold, whatever their names.

    Sensors are noisy: of two dives no sample is equal in every channel.
    """
    return [(i, j) for (i, a), (j, b) in combinations(enumerate(runs), 2) if _is_part(*sorted((a, b), key=len))]


def _is_part(shorter: Run, longer: Run) -> bool:
    """Whether every sample of the one, in the channels that both hold, stands in the other."""
    shared = tuple(sorted(shorter.values.keys() & longer.values.keys()))
    return bool(shared) and _samples(shorter, shared) <= _samples(longer, shared)


def _samples(run: Run, channels: tuple[str, ...]) -> set[bytes]:
    """The samples, each with all its channels, zero where they are missing."""
    rows = np.nan_to_num(run.stack(channels)) + 0.0  # -0.0 is 0.0
    return {row.tobytes() for row in np.ascontiguousarray(rows)}
