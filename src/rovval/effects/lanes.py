"""Lanes: the numbers of one vehicle, once per lane of a batch, as the effects that alter them see them."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rovval.core.frames import skew
from rovval.vehicle.model import Vehicle, allocation, as_matrix, inertia

Array = NDArray[np.float64]
PASSES = 0.1  # cosine under which a jet passes the hull by (chosen: 6 degrees, as a jet spreads)
WORKING_SPEED = 0.3  # m/s, rad/s, of a vehicle at work, at which its drag is known as a whole (chosen),
UNMEASURED_SPEED = 0.5  # m/s, rad/s: and of an axis of which nobody has measured the linear part (chosen)
LEAST_DRAG = 1.0 / 3.0  # of the median of the axes of its kind: less drag no axis of a published ROV has (0.39 to 6.2 on five vehicles of the library)
SECONDS_PER_MINUTE = 60.0  # thrust gains in a vehicle file are N / rpm^2, here N / (rev/s)^2


@dataclass(frozen=True, slots=True)
class Lanes:
    """``B`` lanes of one vehicle, ``k`` thrusters. SI, body forward-starboard-down, origin where the vehicle file says.

    ``inertia`` (B, 3, 3) about the origin; ``added_mass``, ``linear_drag``, ``quadratic_drag`` (B, 6, 6), positive; ``position`` m
    and ``direction`` (B, k, 3); ``torque_arm`` (B, k) m of propeller torque per newton of thrust; ``k_pos``, ``k_neg`` (B, k) N s2; ``lag`` (B,) s;
    ``shift`` (B,) s and ``drift`` (B,) s/s by which thrusters are stamped early; ``wake`` (B, k) share of thrust lost in
    another thruster's jet; ``side`` (B,) side force per newton of thrust; payload: mass kg, place m, onset s since the run's start.
    """

    vehicle: Vehicle
    mass: Array
    centre_of_gravity: Array
    inertia: Array
    added_mass: Array
    linear_drag: Array
    quadratic_drag: Array
    weight: Array
    buoyancy: Array
    centre_of_buoyancy: Array
    position: Array
    direction: Array
    torque_arm: Array
    k_pos: Array
    k_neg: Array
    lag: Array
    shift: Array
    drift: Array
    wake: Array
    side: Array
    payload_mass: Array
    payload_position: Array
    payload_onset: Array

    def __len__(self) -> int:
        return len(self.mass)

    def take(self, which: NDArray[np.int64]) -> Lanes:
        """Some of the lanes."""
        return replace(self, **{name: getattr(self, name)[which] for name in self._numbers()})

    def repeated(self, size: int) -> Lanes:
        """A single lane ``size`` times over, read-only and at no cost."""
        each: dict[str, Any] = {}
        for name in self._numbers():
            value = getattr(self, name)[0]
            each[name] = np.broadcast_to(value, (size, *value.shape))
        return replace(self, **each)

    def _numbers(self) -> list[str]:
        return [f.name for f in fields(self) if f.name != "vehicle"]


def nominal(vehicle: Vehicle) -> Lanes:
    """One lane of the vehicle as its file has it."""

    def each(value: object) -> Array:
        one = np.array([value], dtype=float)
        one.setflags(write=False)
        return one

    body = vehicle.body
    zero = each(0.0)
    return Lanes(
        vehicle=vehicle,
        mass=each(body.mass),
        centre_of_gravity=each(body.centre_of_gravity),
        inertia=each(inertia(body)),
        added_mass=each(as_matrix(body.added_mass)),
        linear_drag=each(as_matrix(body.linear_drag)),
        quadratic_drag=each(as_matrix(body.quadratic_drag)),
        weight=each(vehicle.weight),
        buoyancy=each(vehicle.buoyancy),
        centre_of_buoyancy=each(body.centre_of_buoyancy),
        position=each([t.position for t in vehicle.thruster]),
        direction=each(allocation(vehicle)[:3].T),
        torque_arm=each(np.zeros(len(vehicle.thruster))),
        k_pos=each([t.k_pos * SECONDS_PER_MINUTE**2 for t in vehicle.thruster]),
        k_neg=each([t.k_neg * SECONDS_PER_MINUTE**2 for t in vehicle.thruster]),
        lag=zero,
        shift=zero,
        drift=zero,
        wake=each(np.zeros(len(vehicle.thruster))),
        side=zero,
        payload_mass=zero,
        payload_position=each(np.zeros(3)),
        payload_onset=zero,
    )


def with_centre_of_gravity(lanes: Lanes, centre: Array) -> tuple[Array, Array]:
    """Centre of gravity (B, 3) moved with the body about it unchanged: (centre, inertia about the origin), Huygens-Steiner."""
    before, after = skew(lanes.centre_of_gravity), skew(centre)
    shift = before @ before - after @ after
    return centre, lanes.inertia + lanes.mass[:, None, None] * shift


def reference_drag(vehicle: Vehicle) -> tuple[Array, Array]:
    """Coefficients (6,) that a relative departure of linear and quadratic drag refers to: the vehicle's own diagonal. Where that
    is zero, linear drag refers to the quadratic force at 0.1 m/s (rad/s), quadratic to the linear force at 1 m/s (chosen).

    Of a drag that a file leaves out on one axis, or has far too small, no share is a size: it refers to `LEAST_DRAG` of the median of its kind at least.
    """
    linear, quadratic = np.diag(as_matrix(vehicle.body.linear_drag)), np.diag(as_matrix(vehicle.body.quadratic_drag))
    return _at_least(np.where(linear > 0, linear, 0.1 * quadratic)), _at_least(np.where(quadratic > 0, quadratic, linear))


def drag_departure(vehicle: Vehicle, part: Literal["linear_drag", "quadratic_drag"], scale: Array) -> Array:
    """Relative departures ``scale`` (B, 6) of one part of the drag in coefficients: more of it by its reference (`reference_drag`), less of it by what the
    file has, of which nobody takes away more than there is."""
    own, reference = np.diag(as_matrix(getattr(vehicle.body, part))), reference_drag(vehicle)[part == "quadratic_drag"]
    return np.asarray(scale * np.where((scale < 0.0) & (own > 0.0), own, reference))


def _at_least(coefficients: Array) -> Array:
    """Of six axes, each at least `LEAST_DRAG` of the median of the three translations or of the three rotations."""
    kinds = coefficients.reshape(2, 3)
    return np.asarray(np.maximum(kinds, LEAST_DRAG * np.median(kinds, axis=1, keepdims=True)).reshape(6))


def drag_tolerances(vehicle: Vehicle) -> tuple[Array, Array]:
    """Standard deviations (6,) of relative departures of linear and of quadratic drag, in calibration tolerances: a drag is known as a whole at
    `WORKING_SPEED`, and each part of it is off by as much as the whole may be there; of an axis without linear drag in the file, where nobody has
    measured it, by as much at `UNMEASURED_SPEED`."""
    linear, quadratic = np.diag(as_matrix(vehicle.body.linear_drag)), np.diag(as_matrix(vehicle.body.quadratic_drag))
    of_linear, of_quadratic = reference_drag(vehicle)
    speed = np.where(linear > 0, WORKING_SPEED, UNMEASURED_SPEED)
    ratios = [np.divide(a, b, out=np.zeros(6), where=b > 0) for a, b in ((quadratic, of_linear), (linear, of_quadratic))]
    return 1.0 + speed * ratios[0], 1.0 + ratios[1] / WORKING_SPEED


def reference_added_mass(vehicle: Vehicle) -> Array:
    """What a relative departure of added mass (6,) refers to: the vehicle's own diagonal, or half of the rigid body's where that
    is zero (chosen; the thesis's Merlin has 0.5 m and 0.1 I)."""
    own = np.diag(as_matrix(vehicle.body.added_mass))
    body = vehicle.body
    rigid = np.array([body.mass, body.mass, body.mass, body.Ixx, body.Iyy, body.Izz])
    return np.where(own > 0, own, 0.5 * rigid)


def reference_drag_force(vehicle: Vehicle) -> float:
    """Drag at 1 m/s ahead, N, at least `LEAST_DRAG` of the median of the three translations; a tenth of the weight for a vehicle without any (chosen: only a
    size for priors and bounds)."""
    drag = float(_at_least(np.diag(as_matrix(vehicle.body.linear_drag)) + np.diag(as_matrix(vehicle.body.quadratic_drag)))[0])
    return drag if drag > 0 else 0.1 * vehicle.weight


def reference_speed(vehicle: Vehicle) -> float:
    """Thruster speed n, rev/s, at which all thrusters together hold the vehicle at 1 m/s ahead, each turning the way that helps,
    at its mean gain: the reference of inflow and dead-band effects."""
    surge = np.abs(allocation(vehicle)[0])
    gain = np.array([0.5 * (t.k_pos + t.k_neg) for t in vehicle.thruster]) * SECONDS_PER_MINUTE**2
    drag = reference_drag_force(vehicle)
    forward = float(surge @ gain)
    strongest = float(gain.sum())
    return float(np.sqrt(drag / (forward if forward > 1e-6 * strongest else strongest)))


def jet_on_hull(vehicle: Vehicle) -> Array:
    """(k, 2): how squarely the jet of each thruster, turning ahead and astern, meets the hull's middle: the cosine over the largest of the vehicle's
    jets, 0 of one that leads away or passes by (under `PASSES`)."""
    place = np.array([thruster.position for thruster in vehicle.thruster])
    away = np.linalg.norm(place, axis=1)
    cosine = np.divide(np.einsum("ki,ik->k", place, allocation(vehicle)[:3]), away, out=np.zeros(len(place)), where=away > 1e-9)
    meets = np.maximum(np.stack([cosine, -cosine], axis=1), 0.0)
    return np.where(meets < PASSES, 0.0, meets / max(float(meets.max()), PASSES))
