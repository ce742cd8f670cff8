"""Variance accounted for (Verhaegen and Verdult 2007): 100 (1 - var(error) / var(measured)). A constant offset does not count."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, beside
from rovval.core.errors import BadInput

NAME = "vaf"
TITLE = "variance accounted for, %"
UNIT: UnitRule = "1"
SCALES = False
PERFECT = 100.0


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Per cent, 100 at most; negative where the error varies more than the motion. Refuses a motion that does not vary."""
    e, m = beside(NAME, error, ok, measured)
    if np.var(m) == 0.0:
        raise BadInput(f"{NAME} of a channel that never changes", "look at rmse instead")
    return float(100.0 * (1.0 - np.var(e) / np.var(m)))
