"""The integration step: how many Runge-Kutta steps a sample keep the damping of a vehicle stable."""

from __future__ import annotations

from math import ceil

import numpy as np

from rovval.core.data import Array
from rovval.plant import Plant
from rovval.vehicle.model import Vehicle, allocation, as_matrix, rigid_body_mass

STABLE = 2.0  # step times decay rate: the classic Runge-Kutta scheme is stable up to 2.785 (Hairer and Wanner 1996, IV.2), accurate well below
MOST = 8  # steps a sample: a vehicle that needs more has a drag or a mass that no vehicle has; it is left to the sanity limits


def steps_a_sample(vehicle: Vehicle, thrust: Array, dt: float, stiffer: float = 1.0) -> int:
    """Runge-Kutta steps for each ``dt`` (s) for which the fastest decay of a motion is integrated stably, and one that is ``stiffer`` by this factor.

    That is the decay about the steady motion which the largest recorded wrench of ``thrust`` (n, k) N would keep up on an axis: with drag
    d1 v + d2 v^2 = F it is (d1 + 2 d2 v) / m, m with added mass. A light vehicle that rolls fast is stiff: BlueROV2 at 6 rad/s decays in 0.03 s.
    """
    body = vehicle.body
    linear, quadratic = np.diag(as_matrix(body.linear_drag)), np.diag(as_matrix(body.quadratic_drag))
    mass = np.diag(rigid_body_mass(body)) + np.diag(as_matrix(body.added_mass))
    force = np.abs(thrust @ allocation(vehicle).T).max(axis=0, initial=0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = np.where(quadratic > 0, (np.sqrt(linear**2 + 4 * quadratic * force) - linear) / (2 * quadratic), force / linear)
    decay = (linear + 2 * quadratic * np.nan_to_num(speed, nan=0.0, posinf=0.0)) / mass
    return min(max(1, ceil(stiffer * float(decay.max()) * dt / STABLE)), MOST)


def stable_plant(vehicle: Vehicle, model: str, speed: Array, dt: float, stiffer: float = 1.0) -> Plant:
    """The plant of a platform in as many steps as `steps_a_sample` asks for with the thrust of thruster speeds ``speed`` (n, k) rev/s."""
    return Plant(vehicle, model, steps_a_sample(vehicle, Plant(vehicle, model).thrust(speed), dt, stiffer))
