"""The force that a simulator misses, along a log: what would have had to push for the vehicle to move as it did.

Windows of a second are short enough for the difference of velocity at their end to be an acceleration, and long enough for the sensor's noise to
be small beside it: force = (mass and added mass) times that difference over the window's length.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rovval.core.data import Array, SimResult
from rovval.vehicle.model import Vehicle, as_matrix, rigid_body_mass

WINDOW_S = 1.0  # chosen: 0.004 m/s of noise over it are 2 N of a vehicle of 500 kg


def missing_force(sim: SimResult, beside: Array, vehicle: Vehicle) -> tuple[NDArray[np.int64], Array]:
    """Rows (m,) of the middles of the windows of ``sim``, and the mean force (m, 6), N and N m in body axes, that takes its motion to ``beside``: body
    velocities (n, 6) on the same grid, measured or of a simulation restarted at the same samples. NaN where either is missing."""
    stretch = sim.windowed.stretch
    edge = stretch[1:] != stretch[:-1]
    first, last = np.flatnonzero(np.r_[True, edge]), np.flatnonzero(np.r_[edge, True])
    there = (stretch[first] >= 0) & (last > first)
    first, last = first[there], last[there]
    mass = rigid_body_mass(vehicle.body) + as_matrix(vehicle.body.added_mass)
    acceleration = (beside[last] - sim.windowed.nu[last]) / ((last - first) * sim.dt)[:, None]
    return (first + last) // 2, np.asarray(acceleration @ mass.T)
