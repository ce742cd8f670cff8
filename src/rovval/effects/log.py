"""A motion on its way into the log, as the effects of sensors take and give it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Log:
    """``B`` lanes of ``T + 1`` samples, ``dt`` s apart: ``nu`` (B, T + 1, 6) m/s and rad/s in body axes, ``eta`` (B, T + 1, 6) m and rad in the
    north-east-down frame. ``nu0`` and ``eta0`` (B, 6) are what was measured at sample ``first``, where the window begins: the samples before and
    after the window are those that a late or an early sensor shows in it."""

    nu: Array
    eta: Array
    dt: float
    nu0: Array
    eta0: Array
    first: int = 0
