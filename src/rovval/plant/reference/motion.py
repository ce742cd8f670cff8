"""The NumPy twin's equations of motion, with matrices and cross products (thesis 3.10 to 3.15, 2.1 to 2.3; Fossen 2021, 3.57, 8.4)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from rovval.core.frames import rotation_from_quaternion
from rovval.plant.codegen.layout import ADVANCE_LIMIT
from rovval.plant.codegen.spec import LOGGED
from rovval.plant.platforms import load
from rovval.plant.reference.state import Run, chain, total

Array = NDArray[np.float64]


def derivative(run: Run, x: Array, stage: Mapping[str, Array]) -> Array:
    """Time derivative of x y z, q_wxyz, nu (B, 13)."""
    force, _, water = forces(run, x, stage)
    force = force + _matmul(run.lanes.added_mass, water)
    nu_dot = np.linalg.solve(run.mass + run.lanes.added_mass, force[..., None])[..., 0]
    return np.concatenate([*kinematics(x, x[:, 7:]), nu_dot], axis=1)


def engine_step(run: Run, x: Array, stage: Mapping[str, Array], h: float) -> Array:
    """The state after a semi-implicit Euler step of the rigid body, added mass being a force of the filtered acceleration (`plant.platforms.uuv`)."""
    engine = load(run.plant.model).engine
    assert engine is not None
    force, nu_r, _ = forces(run, x, stage)
    if run.before is None:
        run.filtered = np.asarray(np.linalg.solve(run.mass + run.lanes.added_mass, force[..., None])[..., 0], dtype=np.float64)
    else:
        run.filtered = (1.0 - engine.share) * run.filtered + engine.share * (nu_r - run.before) / h
    run.before = nu_r
    force = force - _matmul(run.lanes.added_mass, run.filtered)
    nu = x[:, 7:] + h * np.linalg.solve(run.mass, force[..., None])[..., 0]
    over_ground, q_dot = kinematics(x, nu)
    attitude = x[:, 3:7] + h * q_dot
    return np.concatenate([x[:, :3] + h * over_ground, attitude / np.linalg.norm(attitude, axis=1, keepdims=True), nu], axis=1)


def kinematics(x: Array, nu: Array) -> tuple[Array, Array]:
    """Rates of position (B, 3) and quaternion (B, 4) of a velocity at the attitude of a state."""
    q, omega = x[:, 3:7], nu[:, 3:]
    w, vector = q[:, :1], q[:, 1:]
    q_dot = 0.5 * np.concatenate([-(vector * omega).sum(axis=1, keepdims=True), w * omega + np.cross(vector, omega)], axis=1)
    return _turn(rotation_from_quaternion(q), nu[:, :3]), q_dot


def forces(run: Run, x: Array, stage: Mapping[str, Array]) -> tuple[Array, Array, Array]:
    """All that acts on the body but inertia (B, 6), velocity relative to the water (B, 6), acceleration of the water in the body frame (B, 6)."""
    lanes = run.lanes
    q, nu = x[:, 3:7], x[:, 7:]
    rotation = rotation_from_quaternion(q)
    v, omega = nu[:, :3], nu[:, 3:]
    over_ground = _turn(rotation, v)
    names = _names(x, rotation, over_ground, stage)
    water = total(run, "water", names, 9)
    back = np.swapaxes(rotation, 1, 2)
    current, along, here = (_turn(back, water[:, i : i + 3]) for i in (0, 3, 6))
    nu_r = np.concatenate([v - current, omega], axis=1)
    names |= {"ur": nu_r[:, 0], "vr": nu_r[:, 1], "wr": nu_r[:, 2]} | {n: water[:, i] for i, n in enumerate(("cn", "ce", "cd"))}
    zero = np.zeros_like(omega)
    nu_c_dot = np.concatenate([along - np.cross(omega, current), zero], axis=1)

    down = rotation[:, 2]
    weight, buoyancy = lanes.weight[:, None] * down, lanes.buoyancy[:, None] * down
    restoring = _at(lanes.centre_of_gravity, weight) - _at(lanes.centre_of_buoyancy, buoyancy)
    pressed = _at(lanes.centre_of_buoyancy, lanes.buoyancy[:, None] / lanes.vehicle.water.gravity * here)
    drag = _matmul(lanes.linear_drag, nu_r) + _matmul(lanes.quadratic_drag, np.abs(nu_r) * nu_r)
    force = (
        _thrusters(run, nu_r, stage) + restoring + pressed - drag - _coriolis(run.mass, nu) - _coriolis(lanes.added_mass, nu_r)
        + stage["extra"] + total(run, "wrench", names, 6)
    )  # fmt: skip
    return force, nu_r, nu_c_dot


def _coriolis(mass: Array, nu: Array) -> Array:
    """C(nu) nu of a 6 x 6 mass matrix from its momentum (Kirchhoff; Fossen 2021, 3.57)."""
    momentum = _matmul(mass, nu)
    linear, angular, omega = momentum[:, :3], momentum[:, 3:], nu[:, 3:]
    return np.concatenate([np.cross(omega, linear), np.cross(omega, angular) + np.cross(nu[:, :3], linear)], axis=1)


def _thrusters(run: Run, nu_r: Array, stage: Mapping[str, Array]) -> Array:
    """Wrench (B, 6) of all thrusters in water that flows past them."""
    lanes = run.lanes
    flow = nu_r[:, None, :3] + np.cross(nu_r[:, None, 3:], run.place)
    axial = (flow * lanes.direction).sum(axis=-1)
    cross = np.sqrt(np.maximum((flow**2).sum(axis=-1) - axial**2, 0.0))
    thrust = stage["T"] * _advance(run, stage["n"], axial)
    thrust = chain(run, "thrust", thrust, {**stage, "ua": axial, "cross": cross})
    moment = np.cross(lanes.position, lanes.direction) + lanes.torque_arm[..., None] * lanes.direction
    columns = np.concatenate([lanes.direction, moment], axis=-1)
    side = lanes.side[:, None] * np.abs(stage["T"])
    return np.asarray(np.einsum("bk,bki->bi", thrust, columns) + side @ run.side)


def _advance(run: Run, n: Array, axial: Array) -> Array:
    """K_T(J) / K_T(0), J held within +-ADVANCE_LIMIT (thesis's upstream: rho D^4 n|n| theta K_T(J_a))."""
    factor = np.ones_like(n)
    for i, thruster in enumerate(run.plant.simulated.thruster):
        if thruster.diameter > 0:
            j = np.clip(axial[:, i] * n[:, i] / (thruster.diameter * (n[:, i] ** 2 + 1e-12)), -ADVANCE_LIMIT, ADVANCE_LIMIT)
            powers = np.stack([j, j**2, j**3], axis=1)
            factor[:, i] = 1.0 + np.where(n[:, i] > 0, powers @ np.array(thruster.advance_pos), powers @ np.array(thruster.advance_neg))
    return factor


def _names(x: Array, rotation: Array, over_ground: Array, stage: Mapping[str, Array]) -> dict[str, Array]:
    names = {n: x[:, i] for i, n in enumerate("xyz")} | {n: x[:, 7 + i] for i, n in enumerate("uvwpqr")}
    names |= {f"r{i + 1}{j + 1}": rotation[:, i, j] for i in range(3) for j in range(3)}
    names |= {n: over_ground[:, i] for i, n in enumerate(("vn", "ve", "vd"))}
    return names | {n: stage[n] for n in (*LOGGED, "t")}


def _at(place: Array, force: Array) -> Array:
    """Wrench of a force at a place."""
    return np.concatenate([force, np.cross(place, force)], axis=1)


def _turn(rotation: Array, vector: Array) -> Array:
    return np.asarray(np.einsum("bij,bj->bi", rotation, vector))


def _matmul(matrix: Array, vector: Array) -> Array:
    return np.asarray(np.einsum("bij,bj->bi", matrix, vector))
