"""The numbers that one flight's vehicle really has: the nominal ones, each off by a few per cent."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from rovval.blind.plant.nominal_vehicle import NominalVehicle, allocation
from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import Array


@dataclass(slots=True)
class Params:
    """Everything that a ``vehicle`` effect may change. SI; ``k`` in N/rpm^2.

    Drag on axis i is lin v + quad |v|v (|v|/v_ref)^drag_power (a mild Reynolds dependence); static thrust is
    k n|n| (|n|/n_ref)^thrust_power. Both powers are zero at zero slop.
    """

    mass: float
    inertia: Array
    added_mass: Array
    lin: Array
    quad: Array
    drag_power: Array
    volume: float
    gravity_centre: Array
    buoyancy_centre: Array
    density: float
    gravity: float
    k_pos: Array
    k_neg: Array
    thrust_power: Array
    positions: Array
    directions: Array
    diameter: Array
    advance: Array

    def copy(self) -> Params:
        """Independent copy (arrays too)."""
        fields = ("inertia", "added_mass", "lin", "quad", "drag_power", "gravity_centre", "buoyancy_centre")
        more = ("k_pos", "k_neg", "thrust_power", "positions", "directions")
        return replace(self, **{name: getattr(self, name).copy() for name in fields + more})

    def rigid_mass(self) -> Array:
        """6 x 6 rigid-body mass about the origin (Fossen 2021, 3.44)."""
        s = cross(self.gravity_centre)
        return np.block([[self.mass * np.eye(3), -self.mass * s], [self.mass * s, self.inertia]])

    def total_mass(self) -> Array:
        """Rigid-body plus added mass."""
        return self.rigid_mass() + self.added_mass

    def reach(self) -> Array:
        """6 x N, thrust to wrench."""
        return allocation(self.positions, self.directions)


def cross(v: Array) -> Array:
    """The matrix of the cross product with ``v``."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def nominal_parameters(nominal: NominalVehicle) -> Params:
    """The parameters exactly as the vehicle file states them."""
    many = len(nominal.thrusters)
    return Params(
        mass=nominal.mass,
        inertia=nominal.inertia.copy(),
        added_mass=nominal.added_mass.copy(),
        lin=nominal.linear_drag.copy(),
        quad=nominal.quadratic_drag.copy(),
        drag_power=np.zeros(6),
        volume=nominal.volume,
        gravity_centre=nominal.gravity_centre.copy(),
        buoyancy_centre=nominal.buoyancy_centre.copy(),
        density=nominal.density,
        gravity=nominal.gravity,
        k_pos=nominal.k_pos.copy(),
        k_neg=nominal.k_neg.copy(),
        thrust_power=np.zeros(many),
        positions=nominal.positions.copy(),
        directions=nominal.directions.copy(),
        diameter=nominal.diameter.copy(),
        advance=nominal.advance.copy(),
    )


def perturbed(nominal: NominalVehicle, scale: Scales, slop: float, rng: np.random.Generator) -> Params:
    """Nominal parameters with calibration slop: relative errors N(0, slop), and what depends on a difference of large
    numbers (net buoyancy, trim) in proportion to the vehicle's working force."""
    p = nominal_parameters(nominal)

    def off(size: int) -> Array:
        return 1.0 + slop * np.clip(rng.standard_normal(size), -2.5, 2.5)

    root = np.sqrt(off(6))
    p.added_mass *= np.outer(root, root)
    p.inertia *= np.outer(r := np.sqrt(off(3)), r)
    p.lin *= off(6)
    p.quad *= off(6)
    p.drag_power = -np.abs(off(6) - 1.0)  # drag coefficients fall with the Reynolds number
    gain = off(len(p.k_pos))
    p.k_pos *= gain * (1.0 + 0.3 * (off(len(gain)) - 1.0))
    p.k_neg *= gain * (1.0 + 0.3 * (off(len(gain)) - 1.0))
    p.thrust_power = off(len(gain)) - 1.0
    p.directions = p.directions + 0.3 * slop * rng.standard_normal(p.directions.shape)
    p.directions /= np.linalg.norm(p.directions, axis=1, keepdims=True)
    p.volume += 0.5 * slop * scale.force * float(rng.standard_normal()) / (p.density * p.gravity)
    arm = p.gravity_centre - p.buoyancy_centre
    p.buoyancy_centre = p.gravity_centre - arm * off(1)[0]
    p.buoyancy_centre[:2] += 0.2 * slop * float(np.linalg.norm(arm)) * rng.standard_normal(2)
    return p
