"""Foreign effects of the water: nothing in the library is of these kinds."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.rotation import to_body
from rovval.blind.plant.spec import Array
from rovval.blind.planted.hydrodynamic import working_drag


class _Foreign(Effect):
    """Shared: not in the library."""

    known = False


class VortexShedding(_Foreign):
    """Side force and yaw of shed vortices: a wake oscillator (Facchinetti 2004) at the Strouhal frequency of the speed."""

    name = "vortex_shedding"
    unit = "side force of 0.45 of the working force at working speed"

    def setup(self, plan: Planting) -> None:
        """Strouhal number 0.2 over a width of 1.2 half-lengths."""
        self.width = 1.2 * plan.scale.length
        self.force = 0.45 * self.s * plan.scale.force
        self.values = {"force": self.force, "width_m": self.width, "strouhal": 0.2}

    def start(self, k: Kinematics) -> Array:
        """Oscillator near its limit cycle."""
        return np.array([0.5, 0.0])

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """q'' + 0.3 w (q^2 - 1) q' + w^2 q = 0 with w the shedding frequency; states q and q'/w."""
        w = math.tau * 0.2 * (math.hypot(k.rel[0], k.rel[1]) + 1e-3) / self.width
        q, d = float(own[0]), float(own[1])
        return np.array([w * d, -w * (q + 0.3 * (q * q - 1.0) * d)])

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Across the motion in the horizontal plane, a little ahead of the middle."""
        u, v = k.rel[0], k.rel[1]
        size = math.hypot(u, v) + 1e-6
        push = 0.5 * self.level(k.t) * self.force * float(own[0]) * size / self.plan.scale.speed**2
        fx, fy = -push * v, push * u
        f[0] += fx
        f[1] += fy
        f[5] += 0.4 * self.plan.scale.length * fy


class MemoryDrag(_Foreign):
    """Drag that remembers: it follows its steady value with a time of some lengths over the speed (Basset-like)."""

    name = "memory_drag"
    unit = "one and a half half-lengths of travel to build up"

    def setup(self, plan: Planting) -> None:
        """Length of the memory, m."""
        self.reach = 1.5 * self.s * plan.scale.length
        self.lin, self.quad = plan.nominal.linear_drag[:3], plan.nominal.quadratic_drag[:3]
        self.values = {"length_m": self.reach}

    def start(self, k: Kinematics) -> Array:
        """Remembered drag of the three axes, N."""
        return np.zeros(3)

    def _steady(self, k: Kinematics) -> Array:
        v = np.array(k.rel[:3])
        return np.asarray((self.lin + self.quad * np.abs(v)) * v)

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """First order, faster at speed, never quicker than 20/s."""
        speed = math.sqrt(sum(a * a for a in k.rel[:3])) + 0.05 * self.plan.scale.speed
        return np.asarray((self._steady(k) - own) * min(20.0, speed / max(self.reach, 1e-6)))

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Remembered instead of steady."""
        gap = self.level(k.t) * (self._steady(k) - own)
        for i in range(3):
            f[i] += float(gap[i])


class PositionJet(_Foreign):
    """Outflows fixed in space, on a lattice of 6 m: each pushes north-east and up within about a metre and a half."""

    name = "position_jet"
    unit = "0.5 of the working force in the middle of a jet"

    def setup(self, plan: Planting) -> None:
        """Force (N) and place of the lattice."""
        self.force = 0.5 * self.s * plan.scale.force
        self.shift = plan.rng.uniform(-1.0, 1.0, 2).tolist()
        self.values = {"force": self.force, "lattice_m": 6.0, "shift": self.shift}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Raised cosine in x and y."""
        a = math.cos(math.pi * (k.x - self.shift[0]) / 6.0) * math.cos(math.pi * (k.y - self.shift[1]) / 6.0)
        push = self.level(k.t) * self.force * a**6
        for i, x in enumerate(to_body(k.r, 0.6 * push, 0.6 * push, -0.5 * push)):
            f[i] += x


class OneSidedDrag(_Foreign):
    """A net hung on the frame: it opens when the vehicle backs up and folds when it goes ahead."""

    name = "one_sided_drag"
    unit = "drag doubled astern, unchanged ahead"

    def setup(self, plan: Planting) -> None:
        """Coefficient, N s2/m2."""
        ref, drag = working_drag(plan, 0)
        self.coefficient = self.s * drag / ref**2
        self.values = {"coefficient": self.coefficient}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Astern only, tied a third of the length below."""
        u = min(0.0, k.rel[0])
        push = self.level(k.t) * self.coefficient * u * u
        f[0] += push
        f[4] += 0.3 * self.plan.scale.length * push


class BodyLift(_Foreign):
    """Lift of the hull at an angle of attack: forces as u v and u w, ahead of the middle."""

    name = "body_lift"
    unit = "0.9 of the working force at working speed and 45 degrees of drift"

    def setup(self, plan: Planting) -> None:
        """Coefficient, N s2/m2, and arm, m."""
        self.coefficient = 1.8 * self.s * plan.scale.force / plan.scale.speed**2
        self.arm = 0.3 * plan.scale.length
        self.values = {"coefficient": self.coefficient, "arm_m": self.arm}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Side and heave force with their moments."""
        c = -self.level(k.t) * self.coefficient * k.rel[0]
        fy, fz = c * k.rel[1], 0.6 * c * k.rel[2]
        f[1] += fy
        f[2] += fz
        f[4] -= self.arm * fz
        f[5] += self.arm * fy


class DryFriction(_Foreign):
    """A clump dragged over the bottom: a force of nearly constant size against the motion, over ground."""

    name = "dry_friction"
    unit = "0.2 of the working force"

    def setup(self, plan: Planting) -> None:
        """Force (N)."""
        self.force = 0.2 * self.s * plan.scale.force
        self.values = {"force": self.force}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Against u and v, smooth through zero."""
        u, v = k.vel[0], k.vel[1]
        pull = -self.level(k.t) * self.force / math.sqrt(u * u + v * v + 0.03**2)
        f[0] += pull * u
        f[1] += pull * v
