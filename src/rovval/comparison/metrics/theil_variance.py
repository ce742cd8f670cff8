"""Share of the squared error that is too much or too little motion (Theil 1966): (sd simulated - sd measured)^2 / mean(e^2)."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, theil

NAME = "theil_variance"
TITLE = "Theil variance share"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Share in 0..1; 0 where there is no error to share out."""
    mse, s, m = theil(NAME, error, ok, measured)
    return float(np.std(s) - np.std(m)) ** 2 / mse if mse > 0.0 else PERFECT
