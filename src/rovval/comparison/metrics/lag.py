"""Time by which the simulation is late: the shift at which simulated and measured correlate most (Box and Jenkins 1976, 11.1); negative where it is early."""

from __future__ import annotations

import numpy as np

from rovval.comparison.metrics import Array, Flags, UnitRule, kept
from rovval.core.errors import BadInput

NAME = "lag"
TITLE = "Lag"
UNIT: UnitRule = "s"
SCALES = False
PERFECT = 0.0
LONGEST_S = 3.0  # shifts that are tried: several time constants of a thruster or a sensor filter (chosen)
LEAST_ROWS = 30  # rows that the two must have in common at a shift, or chance decides (chosen)


def compute(error: Array, ok: Flags, dt: float, measured: Array | None = None) -> float:
    """Seconds, between samples by a parabola through the largest correlation and its neighbours. Refuses where nothing moves, and where the best shift
    is the longest that is tried."""
    if measured is None:
        raise BadInput(f"{NAME} needs the measured values beside the error")
    kept(error, ok)
    truth, there = np.asarray(measured, dtype=float), np.asarray(ok, dtype=bool)
    simulated, most = truth + error, round(LONGEST_S / dt)
    correlation = np.array([_correlation(simulated, truth, there, shift) for shift in range(-most, most + 1)])
    if np.isnan(correlation[most]):
        raise BadInput(f"{NAME}: what is constant has none")
    best = int(np.nanargmax(correlation))
    if best in (0, 2 * most):
        raise BadInput(f"{NAME}: no shift of up to {LONGEST_S:g} s is best")
    before, top, after = correlation[best - 1 : best + 2]
    bend = before - 2.0 * top + after
    between = 0.5 * (before - after) / bend if bend < 0.0 else 0.0
    return float(0.0 if best == most and np.allclose(error[there], 0.0) else (best - most + between) * dt)


def _correlation(simulated: Array, measured: Array, ok: Flags, shift: int) -> float:
    """Correlation of the simulated values ``shift`` samples later with the measured ones; NaN without rows in common or where one of them is constant."""
    n = len(measured)
    here, later = slice(max(0, -shift), min(n, n - shift)), slice(max(0, shift), min(n, n + shift))
    both = ok[here] & ok[later]
    m, s = measured[here][both], simulated[later][both]
    if len(m) < LEAST_ROWS or np.std(m) <= 0.0 or np.std(s) <= 0.0:
        return float("nan")
    return float(np.corrcoef(m, s)[0, 1])
