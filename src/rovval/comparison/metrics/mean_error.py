"""Mean signed error, simulated minus measured: the bias."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept

NAME = "mean_error"
TITLE = "mean error"
UNIT: UnitRule = "same"
SCALES = True
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Mean of the error over the samples that are there."""
    return float(np.mean(kept(error, ok)[0]))
