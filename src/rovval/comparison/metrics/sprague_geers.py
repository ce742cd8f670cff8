"""Comprehensive error of Sprague and Geers (2003): sqrt(M^2 + P^2), of magnitude M = sqrt(sum s^2 / sum m^2) - 1 and phase
P = arccos(sum s m / sqrt(sum s^2 sum m^2)) / pi, s simulated and m measured."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, theil
from rovval.core.errors import BadInput

NAME = "sprague_geers"
TITLE = "Sprague-Geers error"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """0 is perfect; 0.1 is a tenth off in size or in phase. Refuses a motion that is zero throughout, in the log or in the simulation."""
    mse, s, m = theil(NAME, error, ok, measured)
    if mse == 0.0:
        return PERFECT
    ss, mm = float(s @ s), float(m @ m)
    if ss == 0.0 or mm == 0.0:
        raise BadInput(f"{NAME} of a channel that never moves", "look at rmse instead")
    size = np.sqrt(ss / mm) - 1.0
    phase = np.arccos(np.clip(float(s @ m) / np.sqrt(ss * mm), -1.0, 1.0)) / np.pi
    return float(np.hypot(size, phase))
