"""Integral over time of the absolute error (thesis 6.2), over the time that was measured: a masked sample adds nothing."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept

NAME = "iae"
TITLE = "IAE"
UNIT: UnitRule = "times_s"
SCALES = True
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Sum of the absolute error times ``dt``: m for a velocity in m/s, rad for a rate in rad/s."""
    return float(np.sum(np.abs(kept(error, ok)[0])) * dt)
