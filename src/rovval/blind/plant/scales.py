"""One vehicle's own yardsticks: working speed, working force, working rpm, size. Severities and pilots are scaled by them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.blind.plant.nominal_vehicle import NominalVehicle, allocation
from rovval.blind.plant.spec import Array

HEAVY_KG = 200.0  # chosen: heavier vehicles right themselves, turn slowly and have large drives
FAST_KG = 1000.0  # chosen: heavier than this flies at 0.8 m/s, lighter at 0.6 m/s
LEVEL_RAD_S = 4.5  # chosen: how stiffly the autopilot of a small vehicle keeps it level
HEADROOM = 1.2  # chosen: the rpm limit over the rpm of working speed


@dataclass(frozen=True, slots=True)
class Scales:
    """Working point of the vehicle (nominal parameters)."""

    speed: float  # m/s, chosen working surge speed
    force: float  # N, drag at that speed
    rpm: float  # rpm that the busiest horizontal thruster turns at that speed
    rpm_limit: float
    length: float  # m, furthest thruster from the origin
    time: float  # s, effective mass x speed / force
    thrust: float  # N, mean thrust of a unit at ``rpm``
    stick: Array  # (6,), full-stick wrench that the pilot asks for, N and N m
    capacity: Array  # (6,), largest wrench axis by axis at the working rpm, N and N m
    share: Array  # (N, 6), thrust of each unit per unit wrench (weighted pseudo-inverse)
    bar: float  # N m/rad, righting moment
    upright: float  # N m/rad, righting moment with the autopilot's share
    work_class: bool  # whether the vehicle is one of the heavy ones


def _share(nominal: NominalVehicle, length: float) -> Array:
    """Weighted least-squares allocation; roll and pitch give way where the thrusters cannot do all six."""
    reach = allocation(nominal.positions, nominal.directions)
    weight = np.array([1.0, 1.0, 1.0, 1.0 / length, 1.0 / length, 1.0 / length])
    if np.linalg.matrix_rank(reach * weight[:, None], tol=1e-3) < 6:
        weight[3:5] *= 0.05
    return np.asarray(np.linalg.pinv(reach * weight[:, None], rcond=1e-3) * weight, dtype=float)


def rpm_for(thrust: Array, k_pos: Array, k_neg: Array) -> Array:
    """Speed (rpm) at which each unit gives ``thrust`` (N) by the nominal square law."""
    return np.asarray(np.sign(thrust) * np.sqrt(np.abs(thrust) / np.where(thrust >= 0.0, k_pos, k_neg)))


def scales(nominal: NominalVehicle) -> Scales:
    """Work out the yardsticks; speeds are chosen so that rpm lands where such vehicles are flown."""
    speed = 0.8 if nominal.mass > FAST_KG else 0.6
    force = float(nominal.linear_drag[0] * speed + nominal.quadratic_drag[0] * speed**2)
    length = max(0.1, float(np.max(np.linalg.norm(nominal.positions, axis=1))))
    share = _share(nominal, length)
    needed = max(float(np.max(np.abs(rpm_for(s * force * share[:, 0], nominal.k_pos, nominal.k_neg)))) for s in (1.0, -1.0))
    limit = HEADROOM * needed
    weak = np.minimum(nominal.k_pos, nominal.k_neg) * needed**2
    capacity = [float(np.min(weak / np.maximum(np.abs(share[:, i]), 1e-6))) for i in range(6)]
    arm = float(np.linalg.norm(nominal.gravity_centre - nominal.buoyancy_centre))
    bar = nominal.mass * nominal.gravity * arm
    spin = float(nominal.inertia[1, 1] + nominal.added_mass[4, 4])
    turn = float(nominal.linear_drag[5] * 0.5 + nominal.quadratic_drag[5] * 0.25)  # drag at 0.5 rad/s, chosen
    wanted = [force, force, force, 0.08 * bar, 0.08 * bar, max(turn, 0.04 * force * length)]
    return Scales(
        speed=speed,
        force=force,
        rpm=needed,
        rpm_limit=limit,
        length=length,
        time=(nominal.mass + float(nominal.added_mass[0, 0])) * speed / force,
        thrust=float(np.mean((nominal.k_pos + nominal.k_neg) / 2.0) * needed**2),
        stick=np.minimum(wanted, capacity),
        capacity=np.array(capacity),
        share=share,
        bar=bar,
        work_class=nominal.mass > HEAVY_KG,
        upright=bar + (0.0 if nominal.mass > HEAVY_KG else spin * LEVEL_RAD_S**2),
    )
