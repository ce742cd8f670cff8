"""Mean absolute error."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept

NAME = "mae"
TITLE = "MAE"
UNIT: UnitRule = "same"
SCALES = True
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Mean of the absolute error over the samples that are there."""
    return float(np.mean(np.abs(kept(error, ok)[0])))
