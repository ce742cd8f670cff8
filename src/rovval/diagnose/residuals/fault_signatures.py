"""What late sensors leave in the parity rows: of a vehicle that turns, half a second of it is not ten times a twentieth.

An angle is held against its rate, and both are of one sensor: no delay shows there, though the windows slide along what else is wrong there. (At no
delay that slide is a trace as any other, by which a tolerance of half a sample takes up some of what is wrong there: a real tank run has much of it.)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags
from rovval.diagnose.residuals.dead_reckoning import pose_drift, without_margin, wrap_angles
from rovval.diagnose.windows.windows import Windows
from rovval.effects.log import Log
from rovval.plant.sensors import observe

STEP = 0.25  # finite-difference step, in typical sizes


@dataclass(frozen=True, slots=True)
class FaultSignatures:
    """Smooth measured motion ``nu`` and ``eta`` (m, margin + n + margin, 6) of the windows, ``usable`` (m,) of them, its drift ``as_is`` (m, rows, 6), and
    what sensors make of it (`traced`)."""

    windows: Windows
    nu: Array
    eta: Array
    usable: Flags
    as_is: Array

    def of(self, column: int) -> Array:
        """Change of the drift (m, rows, 6) per unit of a fault, at none."""
        step = self._step(column)
        return wrap_angles(self._drift({column: step}) - self.as_is) / step

    def late(self, delays: dict[int, float]) -> tuple[Array, dict[int, Array]]:
        """What sensors that are late by ``delays`` (column: seconds) make of the drift (m, rows, 6): the drift as it is, less that of the motion once
        they are undone; and its change per second more of each."""
        undone = self._drift({c: -value for c, value in delays.items()})
        slopes = dict[int, Array]()
        for column in delays:
            step = self._step(column)
            slopes[column] = _of_places(undone - self._drift({c: -value - step * (c == column) for c, value in delays.items()})) / step
        return _of_places(self.as_is - undone), slopes

    def _step(self, column: int) -> float:
        return STEP * self.windows.plant.slots[column].parameter.typical

    def _drift(self, faults: dict[int, float]) -> Array:
        """Drift of the motion as sensors with ``faults`` (column: value) would have logged it."""
        plant, beta = self.windows.plant, self.windows.plant.null.copy()
        beta[list(faults)] += list(faults.values())
        log = Log(self.nu, self.eta, self.windows.run.dt, self.nu[:, 0], self.eta[:, 0])
        seen = observe(plant.vehicle, plant.index, plant.null, np.tile(beta, (len(self.nu), 1)), log)
        return _drift_of(seen.nu, seen.eta, self.windows.run.dt, self.usable)


def fault_signatures(windows: Windows, nu: Array, eta: Array, usable: Flags) -> FaultSignatures:
    """Traces of a smooth motion."""
    return FaultSignatures(windows, nu, eta, usable, _drift_of(nu, eta, windows.run.dt, usable))


def _drift_of(nu: Array, eta: Array, dt: float, usable: Flags) -> Array:
    rows = pose_drift(without_margin(nu), without_margin(eta), dt)
    rows[~usable] = 0.0
    return rows


def _of_places(rows: Array) -> Array:
    """Rows (m, rows, 6) with the relations of angles taken out."""
    return np.concatenate([rows[..., :3], np.zeros_like(rows[..., 3:])], axis=-1)
