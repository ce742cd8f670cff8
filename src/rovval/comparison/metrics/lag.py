"""Time by which the simulation is late: the shift at which simulated and measured correlate most (Box and Jenkins 1976, 11.1); negative where it is early."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from rovval.comparison.metrics import Array, Flags, UnitRule, beside
from rovval.core.errors import BadInput
from rovval.core.peak import peak

NAME = "lag"
TITLE = "Lag"
UNIT: UnitRule = "s"
SCALES = False
PERFECT = 0.0
LONGEST_S = 3.0  # shifts that are tried: several time constants of a thruster or a sensor filter (chosen)
ROUNDING = 1e-12  # of the mean square: a variance below it is what rounding leaves of a constant
LEAST_ROWS = 30  # rows that the two must have in common at a shift, or chance decides (chosen)


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Seconds, between samples by a parabola through the largest correlation and its neighbours. Refuses where nothing moves, and where the best shift
    is the longest that is tried."""
    e, m = beside(NAME, error, ok, measured)
    there, most = np.asarray(ok, dtype=bool), round(LONGEST_S / dt)
    truth, simulated = np.zeros((2, len(there)))
    truth[there], simulated[there] = m - m.mean(), m + e - (m + e).mean()  # what is not there is no part of any sum
    correlation = _correlations(simulated, truth, there.astype(float), most)
    if np.isnan(correlation[most]):
        raise BadInput(f"{NAME}: what is constant has none")
    at = peak(correlation)
    if at is None:
        raise BadInput(f"{NAME}: no shift of up to {LONGEST_S:g} s is best")
    return float(0.0 if np.allclose(e, 0.0) else (at - most) * dt)


def _correlations(simulated: Array, measured: Array, there: Array, most: int) -> Array:
    """Correlation of the simulated values with the measured ones of 0 to ``most`` samples later and earlier (2 most + 1,), over the rows that are ``there``
    in both; NaN with too few of them or where one of the two is constant."""

    def late(values: Array) -> Array:
        """The values at every shift, a row each."""
        return np.asarray(sliding_window_view(np.pad(values, most), len(values)))

    flags, moved = late(there), late(simulated)
    n = flags @ there
    enough = np.where(n >= LEAST_ROWS, n, np.nan)
    s, m = moved @ there / enough, flags @ measured / enough
    ss, mm, sm = late(simulated**2) @ there / enough - s**2, flags @ measured**2 / enough - m**2, moved @ measured / enough - s * m
    constant = (ss <= ROUNDING * np.mean(simulated**2)) | (mm <= ROUNDING * np.mean(measured**2))
    return np.where(constant, np.nan, sm / np.sqrt(np.where(constant, 1.0, ss * mm)))
