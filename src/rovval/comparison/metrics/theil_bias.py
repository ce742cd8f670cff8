"""Share of the squared error that is a constant offset (Theil 1966): mean(e)^2 / mean(e^2)."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept

NAME = "theil_bias"
TITLE = "Theil bias share"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Share in 0..1; 0 where there is no error to share out."""
    e, _ = kept(error, ok)
    mse = float(np.mean(np.square(e)))
    return float(np.mean(e)) ** 2 / mse if mse > 0.0 else PERFECT
