"""Share of the squared error that is shape and timing, neither offset nor size (Theil 1966): 2 (sd sd' - cov) / mean(e^2)."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, theil

NAME = "theil_covariance"
TITLE = "Theil covariance share"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Share in 0..1, with bias and variance shares adding to 1; 0 where there is no error to share out."""
    mse, s, m = theil(NAME, error, ok, measured)
    covariance = float(np.mean((s - s.mean()) * (m - m.mean())))
    return max(0.0, 2.0 * (float(np.std(s) * np.std(m)) - covariance) / mse) if mse > 0.0 else PERFECT
