"""Control allocation: a wrench to thruster speeds by the pseudo-inverse of the thesis's matrix T, with limits of speed and of its change.

tau = T U (thesis 3.15), U = T^+ tau (Fossen 2011, 12.3.2), n = sign(U) sqrt(|U| / k). Where a thruster cannot give its part, heave, roll, pitch and yaw
come first and are scaled together; surge and sway get what is left (direction-preserving: Johansen and Fossen 2013).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array, Flags
from rovval.core.errors import UsageProblem
from rovval.fly.mission import Limits
from rovval.vehicle.audit import uncontrolled_axes
from rovval.vehicle.model import Vehicle, allocation

SECOND = [AXES.index("surge"), AXES.index("sway")]  # they wait where thrust is short: a vehicle that loses depth or heading is lost


@dataclass(frozen=True, slots=True)
class Thrusters:
    """A vehicle's thrusters as a controller knows them: gains ahead and astern (k,) N s2, greatest speed (k,) rev/s (infinite where none is known),
    greatest change of speed rev/s2, the pseudo-inverse (k, 6), and which axes (6,) they can push."""

    names: tuple[str, ...]
    k_pos: Array
    k_neg: Array
    limit: Array
    rate: float
    inverse: Array
    controlled: Flags

    @property
    def most(self) -> Array:
        """Greatest thrust ahead and astern (k, 2), N, at rest in the water."""
        with np.errstate(invalid="ignore"):
            return np.stack([self.k_pos, self.k_neg], axis=1) * self.limit[:, None] ** 2

    def refuse_uncontrolled(self, axes: Iterable[str], who: str) -> None:
        """Raises UsageProblem where the thrusters cannot push along one of these axes alone."""
        if beyond := [a for a in axes if not self.controlled[AXES.index(a)]]:
            raise UsageProblem(
                f"{who} needs {', '.join(beyond)}, which these thrusters ({', '.join(self.names)}) cannot push alone", "leave it out for this vehicle"
            )

    def share(self, wrench: Array) -> Array:
        """Thrust (B, k) N of each thruster for a wrench (B, 6), without limits."""
        return wrench @ self.inverse.T

    def speed_of(self, thrust: Array) -> Array:
        """Speed (B, k) rev/s at which thrusters give ``thrust`` (B, k) N at rest in the water."""
        return np.asarray(np.sign(thrust) * np.sqrt(np.abs(thrust) / np.where(thrust >= 0, self.k_pos, self.k_neg)))

    def allocate(self, wrench: Array) -> tuple[Array, Array]:
        """Speeds (B, k) rev/s for a wrench (B, 6) N and N m within the limits, and which share of each axis (B, 6) they give."""
        first = wrench.copy()
        first[:, SECOND] = 0.0
        before, then = self.share(first), self.share(wrench - first)
        some = _scale(np.zeros_like(before), before, self.most)
        rest = _scale(some * before, then, self.most)
        given = np.repeat(some, 6, axis=1)
        given[:, SECOND] = rest
        return self.speed_of(some * before + rest * then), given

    def turned(self, now: Array, wanted: Array, dt: float) -> Array:
        """Speeds (B, k) after ``dt`` s on the way from ``now`` to ``wanted``, as fast as they can change."""
        return np.asarray(now + np.clip(wanted - now, -self.rate * dt, self.rate * dt))


def _scale(base: Array, more: Array, most: Array) -> Array:
    """The greatest share (B, 1) up to 1 of ``more`` (B, k) that every thruster can give beside ``base``, N."""
    room = np.where(more >= 0, most[:, 0] - base, most[:, 1] + base)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(np.abs(more) > 0, room / np.abs(more), np.inf)
    return np.asarray(np.clip(share.min(axis=1, keepdims=True), 0.0, 1.0))


def thrusters_of(vehicle: Vehicle, limits: Limits) -> Thrusters:
    """The thrusters of a vehicle under a mission's limits."""
    columns = allocation(vehicle)
    controlled = np.array([axis not in uncontrolled_axes(vehicle) for axis in AXES])
    inverse = np.zeros((columns.shape[1], 6))
    inverse[:, controlled] = np.linalg.pinv(columns[controlled])
    k_pos, k_neg = (np.array([getattr(t, k) for t in vehicle.thruster]) * 3600.0 for k in ("k_pos", "k_neg"))
    rate = np.inf if limits.rpm_per_s is None else limits.rpm_per_s / 60.0
    return Thrusters(vehicle.thrusters, k_pos, k_neg, greatest_speed(vehicle, limits.rpm), rate, inverse, controlled)


def greatest_speed(vehicle: Vehicle, rpm: float | None = None) -> Array:
    """Greatest speed (k,) rev/s of each thruster: ``rpm``, else its own ``rpm_max``, else that of the pulse table's greatest thrust, else infinite."""
    table = vehicle.pulse_table
    by_table = [np.inf if table is None else float(np.sqrt(max(table.thrust) / t.k_pos)) for t in vehicle.thruster]
    return np.array([rpm or t.rpm_max or most for t, most in zip(vehicle.thruster, by_table, strict=True)]) / 60.0
