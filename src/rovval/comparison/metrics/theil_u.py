"""Theil's inequality coefficient U1 (Theil 1966): RMSE / (rms(simulated) + rms(measured)); 0 is perfect, 1 the worst there is."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, theil

NAME = "theil_u"
TITLE = "Theil's U"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Between 0 and 1; 0 where neither moves."""
    mse, simulated, truth = theil(NAME, error, ok, measured)
    size = float(np.sqrt(np.mean(np.square(simulated))) + np.sqrt(np.mean(np.square(truth))))
    return float(np.sqrt(mse)) / size if size > 0.0 else PERFECT
