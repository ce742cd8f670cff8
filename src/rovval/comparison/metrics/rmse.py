"""Root of the mean squared error."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept

NAME = "rmse"
TITLE = "RMSE"
UNIT: UnitRule = "same"
SCALES = True
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Root mean square of the error over the samples that are there."""
    return float(np.sqrt(np.mean(np.square(kept(error, ok)[0]))))
