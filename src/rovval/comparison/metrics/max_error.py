"""Largest absolute error."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept

NAME = "max_error"
TITLE = "largest error"
UNIT: UnitRule = "same"
SCALES = True
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Largest absolute error over the samples that are there."""
    return float(np.max(np.abs(kept(error, ok)[0])))
