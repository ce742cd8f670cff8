"""Fault signatures: how the drift of dead reckoning changes with each parameter of a sensor.

Of most faults the drift is a linear function; of a delay it is not, in a vehicle that turns, and the signature is taken at the delay itself. An angle
and its rate come from one sensor, so that no delay shows in their relation: at a delay, the signatures of the three angles are zero. (At no delay they
are not: there the windows slide along whatever else is wrong with the relation, which the tolerance of a delay may take up.)
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
ROUNDING = 1e-9  # m or rad: a smaller change of the drift is none


@dataclass(frozen=True, slots=True)
class FaultSignatures:
    """The measured motion of one run's windows, of which the signatures are computed.

    Attributes:
        windows: the windows.
        nu, eta: smoothed velocities and poses (m, margin + n + margin, 6), SI units and radians.
        usable: windows (m,) that were measured nearly throughout; of the others every signature is zero.
        nominal: drift (m, rows, 6) of the motion as it was measured, m and rad.
    """

    windows: Windows
    nu: Array
    eta: Array
    usable: Flags
    nominal: Array

    def of(self, column: int) -> Array:
        """Signature (m, rows, 6) of the plant slot ``column``: change of the drift per unit of it, at its null value."""
        step = self._step(column)
        change = wrap_angles(self._drift({column: step}) - self.nominal)
        return change / step if np.abs(change).max(initial=0.0) > ROUNDING else np.zeros_like(change)

    def of_delays(self, delays: dict[int, float]) -> tuple[Array, dict[int, Array]]:
        """The part (m, rows, 6) of the drift that ``delays`` (slot: seconds) cause, and its change per second more of each.

        The part is the drift as it was measured less that of the motion with the delays taken back.
        """
        undone = self._drift({c: -value for c, value in delays.items()})
        slopes = dict[int, Array]()
        for column in delays:
            step = self._step(column)
            slopes[column] = _of_positions(undone - self._drift({c: -value - step * (c == column) for c, value in delays.items()})) / step
        return _of_positions(self.nominal - undone), slopes

    def _step(self, column: int) -> float:
        """Finite difference, in the unit of the parameter."""
        return STEP * self.windows.plant.slots[column].parameter.typical

    def _drift(self, faults: dict[int, float]) -> Array:
        """Drift (m, rows, 6) of the motion as sensors with ``faults`` (slot: value) would have logged it."""
        plant, beta = self.windows.plant, self.windows.plant.null.copy()
        beta[list(faults)] += list(faults.values())
        log = Log(self.nu, self.eta, self.windows.run.dt, self.nu[:, 0], self.eta[:, 0])
        seen = observe(plant.vehicle, plant.index, plant.null, np.tile(beta, (len(self.nu), 1)), log)
        return _drift_of(self.windows, seen.nu, seen.eta, self.usable)


def fault_signatures(windows: Windows, nu: Array, eta: Array, usable: Flags) -> FaultSignatures:
    """Signatures of a smoothed motion ``nu``, ``eta`` (m, margin + n + margin, 6); ``usable`` (m,) are the windows that were measured nearly throughout."""
    return FaultSignatures(windows, nu, eta, usable, _drift_of(windows, nu, eta, usable))


def _drift_of(windows: Windows, nu: Array, eta: Array, usable: Flags) -> Array:
    """Drift (m, rows, 6) of dead reckoning, zero in windows that are not usable."""
    return pose_drift(without_margin(nu), without_margin(eta), windows.run, usable)


def _of_positions(rows: Array) -> Array:
    """Drift (m, rows, 6) with that of the three angles set to zero."""
    return np.concatenate([rows[..., :3], np.zeros_like(rows[..., 3:])], axis=-1)
