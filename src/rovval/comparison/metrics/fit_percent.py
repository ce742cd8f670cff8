"""Fit in per cent of the measured motion about its mean (Ljung): 100 (1 - |e| / |m - mean m|)."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, beside
from rovval.core.errors import BadInput

NAME = "fit_percent"
TITLE = "fit %"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 100.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """100 for no error, 0 for an error as large as the motion, negative below that; refuses a channel that never moved."""
    e, m = beside(NAME, error, ok, measured)
    motion = float(np.linalg.norm(m - m.mean()))
    if motion == 0.0 or np.ptp(m) == 0.0:
        raise BadInput(f"{NAME} is not defined for a channel that never moved")
    return 100.0 * (1.0 - float(np.linalg.norm(e)) / motion)
