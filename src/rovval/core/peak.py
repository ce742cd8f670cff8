"""Where a maximum that was sampled lies between its samples."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def peak(score: NDArray[np.float64]) -> float | None:
    """Place of the largest value in samples, by a parabola through it and its neighbours; NaN is passed over. None where it stands at an end."""
    best = int(np.nanargmax(score))
    if best in (0, len(score) - 1):
        return None
    before, top, after = score[best - 1 : best + 2]
    bend = before - 2.0 * top + after
    return float(best + (0.5 * (before - after) / bend if bend < 0.0 else 0.0))
