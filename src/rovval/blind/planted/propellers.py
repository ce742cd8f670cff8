"""Thrust that depends on the flow at the propeller, on the hull and on the neighbours."""

from __future__ import annotations

import numpy as np

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.parameters import Params
from rovval.blind.plant.spec import Array

OBLIQUE = 0.70710678  # share of the working speed along a 45-degree thruster


def inflow(k: Kinematics, positions: Array) -> Array:
    """Velocity of each unit through the water, (N, 3), body axes."""
    rel = np.array(k.rel)
    return np.asarray(rel[:3] + np.cross(rel[3:], positions))


class _Inflow(Effect):
    """Shared: where the units are and which way they push."""

    place = "input"

    def setup(self, plan: Planting) -> None:
        """Geometry, with the moment arm of rotation as a matrix so that the axial speed is one product."""
        e, r = plan.nominal.directions, plan.nominal.positions
        self.axial = np.hstack([e, np.cross(r, e)])  # (N, 6) times nu_r gives the axial speed
        self.aim, self.at = e, r
        self.scale()

    def scale(self) -> None:
        """Numbers of the effect."""


class InflowLoss(_Inflow):
    """Thrust falls in proportion to the advance ratio: T = k n|n| - c |n| u_a, the linear K_T(J) in all four quadrants."""

    name = "inflow_loss"
    unit = "0.35 of the thrust lost at working speed and working rpm"

    def scale(self) -> None:
        """Loss per rpm and m/s, by the unit's own gain in the direction of rotation."""
        sc = self.plan.scale
        self.per = 0.35 * self.s * sc.rpm / (OBLIQUE * sc.speed)
        self.values = {"loss_at_working_point": 0.35 * self.s, "critical_speed_at_rpm": OBLIQUE * sc.speed / (0.35 * self.s)}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Subtract the linear term, never more than 1.3 times nor less than -0.6 times the thrust at rest."""
        ahead = self.axial @ np.array(k.rel)
        n = k.turn
        ratio = np.clip(self.per * ahead * n / (n * n + 1.0), -0.6, 1.3)
        return np.asarray(thrust * (1.0 - self.level(k.t) * ratio))


class CrossflowLoss(_Inflow):
    """Thrust falls when water crosses the duct: T / (1 + (v_perp/v_0)^2)."""

    name = "crossflow_loss"
    unit = "half of the thrust lost at a cross-flow of 0.7 of the working speed"

    def scale(self) -> None:
        """Inverse square of the half-loss speed."""
        speed = OBLIQUE * self.plan.scale.speed
        self.inverse = self.s / speed**2
        self.values = {"loss_at_0.7_speed": self.s / (1.0 + self.s)}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Divide by one plus the squared cross-flow ratio."""
        v = inflow(k, self.at)
        along = np.sum(v * self.aim, axis=1)
        across = np.sum(v * v, axis=1) - along**2
        return np.asarray(thrust * (1.0 - self.level(k.t) * (1.0 - 1.0 / (1.0 + self.inverse * across))))


PASSES = 0.1  # cosine between jet and the way to the middle under which it passes the hull by


class HullInteraction(_Inflow):
    """A jet that blows at the hull loses thrust and is bent along it: sign-dependent gain and a side force."""

    name = "hull_interaction"
    unit = "0.35 of the thrust of the jets that hit the hull, and 0.2 of it sideways"

    def scale(self) -> None:
        """Which sign of thrust blows at the middle of the vehicle: the jet goes opposite to the push; none of a unit whose jet passes by."""
        inward = np.sum(self.aim * self.at, axis=1)
        self.hits = np.where(np.abs(inward) < PASSES * np.linalg.norm(self.at, axis=1), 0.0, np.sign(inward))
        side = np.cross(self.aim, np.array([0.0, 0.0, 1.0]))
        flat = np.linalg.norm(side, axis=1) < 0.5
        side[flat] = np.array([0.0, 1.0, 0.0])
        side *= np.where(np.sum(side * self.at, axis=1, keepdims=True) < 0.0, -1.0, 1.0)  # the jet clings to the hull and draws it outward
        self.side = np.hstack([side, np.cross(self.at, side)])
        self.loss, self.bend = min(1.0, 0.35 * self.s), 0.2 * self.s
        self.values = {"loss": self.loss, "side_share": self.bend}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Scale what blows at the hull."""
        hit = thrust * self.hits > 0.0
        return np.asarray(np.where(hit, thrust * (1.0 - self.level(k.t) * self.loss), thrust))

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Side force of the bent jets (Coanda)."""
        hit = np.where(k.thrust * self.hits > 0.0, np.abs(k.thrust), 0.0)
        push = (self.level(k.t) * self.bend * hit) @ self.side
        for i, x in enumerate(push.tolist()):
            f[i] += x


class ThrusterInteraction(Effect):
    """A unit in another's jet: it loses thrust as the neighbour's induced speed rises against its own."""

    name = "thruster_interaction"
    place = "input"
    targets = ("thruster",)
    unit = "the target loses up to 0.6 of its thrust while its nearest neighbour runs as hard"

    def setup(self, plan: Planting) -> None:
        """The nearest other unit (the first, of two as near)."""
        self.at = self.unit_index
        gap = np.linalg.norm(plan.nominal.positions - plan.nominal.positions[self.at], axis=1)
        gap[self.at] = np.inf
        self.other = int(np.argmin(gap))
        self.loss = min(1.0, 0.6 * self.s)
        self.values = {"loss": self.loss, "upstream": plan.nominal.thrusters[self.other]}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Loss by the share of the neighbour's thrust in the sum."""
        out = thrust.copy()
        mine, theirs = abs(float(thrust[self.at])), abs(float(thrust[self.other]))
        mix = 2.0 * theirs / (theirs + mine + 0.02 * self.plan.scale.thrust)
        out[self.at] *= 1.0 - self.level(k.t) * self.loss * min(1.0, mix)
        return out


class ThrusterMisaligned(Effect):
    """One unit points elsewhere: turned about a random axis across its own."""

    name = "thruster_misaligned"
    least = -9.0
    form = "equal"
    place = "vehicle"
    targets = ("thruster",)
    unit = "20 degrees"

    def setup(self, plan: Planting) -> None:
        """The sideways unit vector and the angle."""
        self.at = self.unit_index
        e = plan.nominal.directions[self.at]
        across = np.cross(e, plan.rng.standard_normal(3))
        self.across = across / np.linalg.norm(across)
        self.angle = float(np.radians(20.0) * self.s)
        self.values = {"angle_rad": self.angle, "towards": self.across.tolist()}

    def change(self, p: Params, a: float) -> None:
        """Turn the direction."""
        angle = a * self.angle
        p.directions[self.at] = np.cos(angle) * p.directions[self.at] + np.sin(angle) * self.across
        p.directions[self.at] /= np.linalg.norm(p.directions[self.at])


class PropellerTorque(Effect):
    """The reaction torque of each propeller about its axis, all of one hand, with a swirl part that grows with n."""

    name = "propeller_torque"
    unit = "torque per thrust of 0.12 of the vehicle's half-length, all of one hand"

    def setup(self, plan: Planting) -> None:
        """Arm (m)."""
        self.arm = 0.12 * self.s * plan.scale.length
        self.aim = plan.nominal.directions
        self.values = {"arm": self.arm}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Moment against the rotation; a tenth of it goes as |n| n^2 (tip losses)."""
        fast = 0.9 + 0.1 * np.abs(k.turn) / self.plan.scale.rpm
        push = (-self.level(k.t) * self.arm * np.abs(k.static) * np.sign(k.turn) * fast) @ self.aim
        f[3] += float(push[0])
        f[4] += float(push[1])
        f[5] += float(push[2])
