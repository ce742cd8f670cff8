"""The craft: forces on a moving body in moving water, and one step of its motion.

    M_RB nu' + C_RB(nu) nu + M_A nu_r' + C_A(nu_r) nu_r = forces        (velocities over ground nu, through the water nu_r)

The step is the implicit midpoint rule, solved by two fixed-point sweeps from the last acceleration (Hairer, Lubich and Wanner 2006, II.1.3); the
attitude moves along the exponential map of the rotation group (ibid., IV.8). Second order: half the step, a quarter of the error.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from rovval.blind.plant.spec import Array
from rovval.blind.second.blades import Drives, OpenWater
from rovval.blind.second.fault import Fault, Instant
from rovval.blind.second.hull import Hull
from rovval.blind.second.sheet import Sheet

STEP_S = 0.02  # the vehicles' quickest motion takes ten steps and more
SWEEPS = 2
LOOK_S = 0.02  # between the two moments whose difference is the acceleration of the water along the way
ACTIONS = ("alter", "current", "spins", "pushes", "wrench", "advance")
BUMPER_M = 0.4  # depth or altitude below which surface or bottom push back, so that a lost vehicle stays in the water


def turned(q: Array, by: Array) -> Array:
    """Quaternion ``w x y z`` after a turn by the body rotation vector ``by`` (rad): the exponential map."""
    angle = math.sqrt(float(by @ by))
    w, c = math.cos(angle / 2.0), (math.sin(angle / 2.0) / angle if angle > 1e-12 else 0.5)
    x, y, z = (c * by).tolist()
    a, b, d, e = q.tolist()
    return np.array([a * w - b * x - d * y - e * z, a * x + b * w + d * z - e * y, a * y - b * z + d * w + e * x, a * z + b * y - d * x + e * w])


def rotation(q: Array) -> Array:
    """Matrix body to world of a unit quaternion, by Rodrigues: 1 + 2 w [v] + 2 [v]^2."""
    w, x, y, z = q.tolist()
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + 2.0 * (w * k + k @ k))


def cross(a: Sequence[float], b: Sequence[float]) -> list[float]:
    """Cross product of two triples."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Craft:
    """One vehicle with its effects, in the middle of a flight."""

    def __init__(self, sheet: Sheet, healthy: Hull, drives: Drives, faults: Sequence[Fault], seabed: float) -> None:
        self.sheet, self.healthy, self.drives, self.faults, self.seabed = sheet, healthy, drives, list(faults), seabed
        self.doing = {name: [f for f in faults if f.has(name)] for name in ACTIONS}
        self.open_water = OpenWater(sheet)
        self.t, self.at, self.q, self.nu = 0.0, np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(6)
        self.rate = np.zeros(6)
        self.gust, self.volts = np.zeros(6), 1.0
        self.last: Instant = Instant()
        self.altered: tuple[float, ...] = ()
        self.refresh()

    def refresh(self) -> None:
        """Bring the hull's numbers to the present moment."""
        levels = tuple(f.on(self.t) for f in self.doing["alter"])
        if levels != self.altered or not hasattr(self, "hull"):
            self.altered, self.hull = levels, self.hull_without(None)
            self.mass = self.masses(self.hull)
            self.inverse, self.lever = np.linalg.inv(self.mass[0] + self.mass[1]), self.hull.reach()

    def hull_without(self, gone: Fault | None) -> Hull:
        """The hull with all effects that change it, but one."""
        hull = self.healthy.copy()
        for fault in self.doing["alter"]:
            if fault is not gone:
                fault.alter(hull, fault.on(self.t))
        return hull

    @staticmethod
    def masses(hull: Hull) -> tuple[Array, Array]:
        """Mass matrices of the body and of the water about it."""
        return hull.rigid(), hull.added

    def current(self, t: float, at: Array, gone: Fault | None) -> Array:
        """Velocity of the water at a place, world."""
        return np.asarray(sum((f.current(t, at) for f in self.doing["current"] if f is not gone), np.zeros(3)))

    def see(self, t: float, at: Array, turn: Array, nu: Array, n: Array, hull: Hull, gone: Fault | None = None) -> Instant:
        """The instant: velocities through the water, speeds and thrusts, with all effects but one."""
        s = Instant(t=t, at=at, turn=turn, nu=nu.tolist(), n=n, volts=self.volts, altitude=self.seabed - float(at[2]))
        s.water = self.current(t, at, gone)
        drift = s.body(s.water).tolist()
        s.rel = [s.nu[0] - drift[0], s.nu[1] - drift[1], s.nu[2] - drift[2], *s.nu[3:]]
        s.spin = n
        for f in self.doing["spins"]:
            if f is not gone:
                s.spin = f.spins(s.spin, s)
        speed = np.abs(s.spin)
        s.static = np.where(s.spin >= 0.0, hull.ahead, hull.astern) * s.spin * speed * (speed / self.sheet.rpm + 1e-9) ** hull.curve
        s.axial = np.array(s.rel) @ self.sheet.reach
        s.thrust = s.static * self.open_water.factor(s.spin, s.axial) if self.open_water.there else s.static
        for f in self.doing["pushes"]:
            if f is not gone:
                s.thrust = f.pushes(s.thrust, s)
        return s

    def force(self, s: Instant, hull: Hull, mass: tuple[Array, Array], lever: Array, gone: Fault | None = None) -> Array:
        """Everything that is not mass times acceleration, (6,)."""
        v, w, rel = s.nu[:3], s.nu[3:], s.rel[:3]
        own, water = (mass[0] @ np.array(s.nu)).tolist(), (mass[1] @ np.array(s.rel)).tolist()
        out = np.array(hull.resistance(s.rel)) + self.gust + lever @ s.thrust
        swirl = [a + b for a, b in zip(cross(w, own[:3]), cross(w, water[:3]), strict=True)]
        twist = [a + b + c + d for a, b, c, d in zip(cross(w, own[3:]), cross(v, own[:3]), cross(w, water[3:]), cross(rel, water[:3]), strict=True)]
        out -= np.array([*swirl, *twist])
        weight, lift = hull.mass * hull.gravity, hull.density * hull.volume * hull.gravity
        down = s.turn[2].tolist()
        arm = (weight * hull.cg - lift * hull.cb).tolist()
        out += np.array([*((weight - lift) * x for x in down), *cross(arm, down)])
        if any(f is not gone for f in self.doing["current"]):
            out += self._carried(s, hull, mass[1], gone)
        if s.altitude < BUMPER_M or s.at[2] < BUMPER_M:
            out[:3] += self._bumper(s)
        for f in self.doing["wrench"]:
            if f is not gone:
                out += f.wrench(s)
        return np.asarray(out)

    def _carried(self, s: Instant, hull: Hull, added: Array, gone: Fault | None) -> Array:
        """What the acceleration of the water does: it takes its added mass along, and presses on the volume displaced."""
        way = s.world(np.array(s.nu[:3]))
        speeding = s.body((self.current(s.t + LOOK_S, s.at + LOOK_S * way, gone) - s.water) / LOOK_S)
        seen = speeding - np.array(cross(s.nu[3:], s.body(s.water).tolist()))
        press = hull.density * hull.volume * speeding
        return np.asarray(added[:, :3] @ seen + np.array([*press, *cross(hull.cb.tolist(), press.tolist())]))

    def _bumper(self, s: Instant) -> Array:
        """Bottom and surface, as a spring with damping."""
        depth = max(0.0, BUMPER_M - s.altitude) - max(0.0, BUMPER_M - float(s.at[2]))
        sink = float(s.down @ np.array(s.nu[:3]))
        return np.asarray(-5.0 * self.sheet.force * (depth / BUMPER_M + abs(depth) / BUMPER_M * sink / self.sheet.cruise) * s.down)

    def step(self, dt: float = STEP_S) -> None:
        """Move on by ``dt``."""
        n, mid = self.drives.after(dt / 2.0), self.nu + 0.5 * dt * self.rate
        for _ in range(SWEEPS):
            turn = rotation(turned(self.q, 0.5 * dt * mid[3:]))
            at = self.at + 0.5 * dt * (turn @ mid[:3])
            s = self.see(self.t + dt / 2.0, at, turn, mid, n, self.hull)
            self.rate = self.inverse @ self.force(s, self.hull, self.mass, self.lever)
            mid = self.nu + 0.5 * dt * self.rate
        self.at = self.at + dt * (turn @ mid[:3])
        self.q = turned(self.q, dt * mid[3:])
        self.q /= math.sqrt(float(self.q @ self.q))
        self.nu, self.t, self.drives.n, self.last = self.nu + dt * self.rate, self.t + dt, self.drives.after(dt), s
        for f in self.doing["advance"]:
            f.advance(s, dt)

    def now(self) -> Instant:
        """The present moment."""
        return self.see(self.t, self.at, rotation(self.q), self.nu, self.drives.n, self.hull)

    def extra(self, s: Instant, gone: Fault) -> Array:
        """The wrench (6,) that the craft without one effect would need beside its own forces to move as this one does."""
        acceleration = self.inverse @ self.force(s, self.hull, self.mass, self.lever)
        hull = self.hull_without(gone)
        mass = self.masses(hull)
        there = self.see(s.t, s.at, s.turn, np.array(s.nu), s.n, hull, gone)
        return np.asarray((mass[0] + mass[1]) @ acceleration - self.force(there, hull, mass, hull.reach(), gone))
