"""From a lane's effect parameters to the numbers that the kernel reads: effects lower the vehicle, then the vehicle is packed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.core.frames import skew
from rovval.effects.lanes import Lanes
from rovval.plant import slots
from rovval.plant.codegen.layout import SYMMETRIC, layout
from rovval.plant.codegen.spec import HOOKS, Spec, component_of, effect_rows, switches

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

ROUNDING = 1e-9  # of a step, in the time of a sample


@dataclass(frozen=True, slots=True)
class Lowered:
    """Lanes after every active effect, each effect's own rows, (B,) or (B, k) under ``effect.row``, which lanes (B,) need the full
    kernel, and which effects of `switches` each has (B, E)."""

    lanes: Lanes
    rows: Mapping[str, Array]
    active: frozenset[str]
    full: Flags
    acts: Flags

    def take(self, which: NDArray[np.int64]) -> Lowered:
        """Some of the lanes; rows of an effect that no lane has stand once for all."""
        rows = {name: values[which] if len(values) == len(self.lanes) and len(values) > 1 else values for name, values in self.rows.items()}
        return Lowered(self.lanes.take(which), rows, self.active, self.full[which], self.acts[which])


def active_effects(found: tuple[slots.Slot, ...], null: Array, beta: Array) -> frozenset[str]:
    """Effects of which some lane has a parameter away from its null value."""
    return frozenset(found[c].effect for c in np.flatnonzero((beta != null).any(axis=0)))


def lower(
    nominal: Lanes, found: tuple[slots.Slot, ...], index: Mapping[str, int], null: Array, beta: Array, resting: Mapping[str, Array] | None = None
) -> Lowered:
    """Lower ``beta`` (B, K) from one ``nominal`` lane. An effect that no lane has is not even called; its rows are those of ``resting`` where
    `rows_at_rest` was called before."""
    active, vehicle = active_effects(found, null, beta), nominal.vehicle
    lanes = nominal.repeated(len(beta))
    given = {name: slots.gather(vehicle, index, name, beta) for name in effects.names() if name in active}
    for name, p in given.items():
        if hasattr(effects.module(name), "lower"):
            lanes = effects.module(name).lower(lanes, p)
    rows = dict(rows_at_rest(nominal, index, null) if resting is None else resting)
    for name, p in given.items():
        rows |= _rows(name, lanes, p)
    return Lowered(lanes, rows, active, _full(found, null, beta), _acts(found, null, beta))


def rows_at_rest(nominal: Lanes, index: Mapping[str, int], null: Array) -> dict[str, Array]:
    """Rows of every effect at its null value, for one lane, under ``effect.row``."""
    rows: dict[str, Array] = {}
    for name in effects.names():
        if effect_rows(name)[0]:
            rows |= _rows(name, nominal, slots.gather(nominal.vehicle, index, name, null[None]))
    return rows


def _rows(name: str, lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """An effect's own rows; none where it has none."""
    own, _ = effect_rows(name)
    values = effects.module(name).rows(lanes, p) if own else {}
    return {f"{name}.{row}": values[row] for row in own}


def _full(found: tuple[slots.Slot, ...], null: Array, beta: Array) -> Flags:
    """Lanes (B,) that need the kernel with every effect in it: some effect acts on more than the numbers of the nominal one."""
    beyond = _beyond_numbers()
    columns = [c for c, slot in enumerate(found) if slot.effect in beyond]
    return np.asarray((beta[:, columns] != null[columns]).any(axis=1))


@cache
def _beyond_numbers() -> frozenset[str]:
    """Effects that act on more than the numbers of the nominal kernel."""
    return frozenset(name for name in effects.names() if any(hasattr(effects.module(name), kind) for kind in (*HOOKS, "FULL_KERNEL")))


def _acts(found: tuple[slots.Slot, ...], null: Array, beta: Array) -> Flags:
    """Which of the effects and components that a kernel can pass over each lane has (B, E)."""
    away, names = beta != null, switches()
    out = np.zeros((len(beta), len(names)), dtype=bool)
    for c in np.flatnonzero(away.any(axis=0)):
        name = found[c].effect + component_of(found[c].effect, found[c].parameter.name)
        if name in names:
            out[:, names[name]] |= away[:, c]
    return out


def rigid_body(mass: Array, first_moment: Array, inertia: Array) -> Array:
    """M_RB (B, 6, 6) of mass, mass times centre of gravity and inertia about the origin (thesis 3.11)."""
    matrix = np.zeros((len(mass), 6, 6))
    cross = skew(first_moment)
    matrix[:, :3, :3] = mass[:, None, None] * np.eye(3)
    matrix[:, :3, 3:] = -cross
    matrix[:, 3:, :3] = cross
    matrix[:, 3:, 3:] = inertia
    return matrix


def with_payload(lanes: Lanes) -> Lanes:
    """The lanes after their payload's onset: its mass at its place is part of the body."""
    m, r = lanes.payload_mass, lanes.payload_position
    total = lanes.mass + m
    centre = (lanes.mass[:, None] * lanes.centre_of_gravity + m[:, None] * r) / total[:, None]
    square = skew(r) @ skew(r)
    return replace(lanes, mass=total, centre_of_gravity=centre, inertia=lanes.inertia - m[:, None, None] * square)


def steps_before_nothing(gone: Array, first: Array, dt: float) -> NDArray[np.int64]:
    """Steps (B,) of a lane that begins at ``first`` (B,) s before the time ``gone`` (B,) s from which nothing is left to move (`nothing_left`); as many as
    there can be where that never comes (infinite)."""
    steps = np.full(len(gone), np.iinfo(np.int64).max // 2)
    ends = np.isfinite(gone)
    steps[ends] = np.maximum(np.ceil((gone[ends] - first[ends]) / dt - ROUNDING), 0.0)
    return steps


def nothing_left(lanes: Lanes) -> Array:
    """When (B,) s a payload leaves the vehicle no inertia of some motion, infinite where it does not: what is set down must have been part of it."""
    onset = np.full(len(lanes), np.inf)
    lighter = np.flatnonzero(lanes.payload_mass < 0.0)
    if len(lighter):
        left = with_payload(lanes.take(lighter))
        whole = rigid_body(left.mass, left.mass[:, None] * left.centre_of_gravity, left.inertia) + left.added_mass
        gone = lighter[np.linalg.eigvalsh(0.5 * (whole + whole.transpose(0, 2, 1)))[:, 0] <= 0.0]
        onset[gone] = lanes.payload_onset[gone]
    return onset


def mass_numbers(lanes: Lanes, spec: Spec) -> Array:
    """(B, 31): m, m r_G, inertia (6), M^-1 (21): of body and added mass, or of the body alone where added mass is a force."""
    moment = lanes.mass[:, None] * lanes.centre_of_gravity
    i = lanes.inertia
    body = rigid_body(lanes.mass, moment, i)
    inverse = np.linalg.inv(body if spec.explicit else body + lanes.added_mass)
    upper = np.stack([0.5 * (inverse[:, a, b] + inverse[:, b, a]) for a, b in SYMMETRIC], axis=1)
    tensor = np.stack([i[:, a, b] for a in range(3) for b in range(a, 3)], axis=1)
    return np.concatenate([lanes.mass[:, None], moment, tensor, upper], axis=1)


def pack(lowered: Lowered, spec: Spec, dt: float, substeps: int) -> Array:
    """(B, rows) in the order of `layout`."""
    lanes, where = lowered.lanes, layout(spec)
    size, k = len(lanes), len(lanes.vehicle.thruster)
    out = np.zeros((size, where.rows))

    def put(first: int, values: Array) -> None:
        out[:, first : first + values.shape[1]] = values

    put(where.first["mass"], mass_numbers(lanes, spec))
    lever = lanes.weight[:, None] * lanes.centre_of_gravity - lanes.buoyancy[:, None] * lanes.centre_of_buoyancy
    put(where.first["restoring"], np.concatenate([(lanes.weight - lanes.buoyancy)[:, None], lever], axis=1))
    displaced = (lanes.buoyancy / lanes.vehicle.water.gravity)[:, None]
    put(where.first["displaced"], np.concatenate([displaced, displaced * lanes.centre_of_buoyancy], axis=1))
    for name, matrix in (("added", lanes.added_mass), ("linear", lanes.linear_drag), ("quadratic", lanes.quadratic_drag)):
        put(where.first[name], matrix.reshape(size, 36) if spec.dense else np.diagonal(matrix, axis1=1, axis2=2))
    put(where.first["lag"], _lag(lanes.lag, dt / substeps))
    put(where.first["shift"], np.stack([lanes.shift / dt, lanes.drift / dt], axis=1))
    put(where.first["jet"], np.concatenate([lanes.wake, lanes.side[:, None]], axis=1))
    moment = np.cross(lanes.position, lanes.direction) + lanes.torque_arm[..., None] * lanes.direction
    thruster = np.zeros((size, k, where.stride))
    thruster[..., 0], thruster[..., 1] = lanes.k_pos, lanes.k_neg
    thruster[..., 2:5], thruster[..., 5:8] = lanes.direction, moment
    if spec.full:
        for name, values in lowered.rows.items():
            if name in where.thruster_first:
                thruster[..., where.thruster_first[name]] = values
            elif name in where.first:
                out[:, where.first[name]] = values
    out[:, where.body_rows :] = thruster.reshape(size, -1)
    return out


def _lag(tau: Array, h: float) -> Array:
    """(B, 4): time constant, and what is left of the past at the start, middle and end of a step; nothing where tau is 0."""
    on = tau > 0
    safe = np.where(on, tau, 1.0)
    left = [np.where(on, np.exp(-f * h / safe), 0.0) for f in (0.0, 0.5, 1.0)]
    return np.stack([tau, *left], axis=1)
