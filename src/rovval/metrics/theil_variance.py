"""Share of the squared error that is too much or too little motion (Theil 1966): (sd simulated - sd measured)^2 / mean(e^2)."""

from __future__ import annotations

import numpy as np

from rovval.errors import BadInput
from rovval.metrics import Array, Flags, UnitRule, kept

NAME = "theil_variance"
TITLE = "Theil variance share"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Share in 0..1; 0 where there is no error to share out."""
    if measured is None:
        raise BadInput(f"{NAME} needs the measured values beside the error")
    e, m = kept(error, ok, measured)
    mse = float(np.mean(np.square(e)))
    return float(np.std(m + e) - np.std(m)) ** 2 / mse if mse > 0.0 else PERFECT
