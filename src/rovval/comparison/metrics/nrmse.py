"""Root mean square error over the range of the measured values."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, beside
from rovval.core.errors import BadInput

NAME = "nrmse"
TITLE = "RMSE over range"
UNIT: UnitRule = "1"
SCALES = True
PERFECT = 0.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """A share of the range (1). Refuses a motion without any."""
    e, m = beside(NAME, error, ok, measured)
    if np.ptp(m) == 0.0:
        raise BadInput(f"{NAME} of a channel that never changes", "look at rmse instead")
    return float(np.sqrt(np.mean(np.square(e))) / np.ptp(m))
