"""The water moves, or its density changes with depth."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.effect import RAMP_S, Effect, Flow, Kinematics, Planting
from rovval.blind.plant.spec import STEP_S, Array

SALT = 14.0  # kg/m3, half of what sea water is heavier than fresh (1027 - 999): a small vehicle's step would else be that to a brine


class _Moving(Effect):
    """Shared by the currents: a level with its rate, and Ornstein-Uhlenbeck walks held linear within a control step."""

    place = "water"

    def ramp(self, t: float) -> tuple[float, float]:
        """Level and its time derivative."""
        if self.onset is None:
            return 1.0, 0.0
        x = min(1.0, max(0.0, (t - self.onset) / RAMP_S))
        return x * x * (3.0 - 2.0 * x), 6.0 * x * (1.0 - x) / RAMP_S

    def walk(self, size: float, tau: float) -> None:
        """Prepare a horizontal walk of standard deviation ``size`` (m/s) on each axis, correlation time ``tau`` (s)."""
        self.keep = math.exp(-STEP_S / tau)
        self.kick = size * math.sqrt(1.0 - self.keep**2)
        self.here = size * self.plan.rng.standard_normal(2)
        self.next = self.here.copy()
        self.since = 0.0
        self.now = (float(self.here[0]), float(self.here[1]), 0.0, 0.0)

    def tick(self, k: Kinematics) -> None:
        """One step of the walk."""
        if not hasattr(self, "keep"):
            return
        self.here = self.next
        self.next = self.keep * self.here + self.kick * self.plan.rng.standard_normal(2)
        self.since = k.t
        rate = (self.next - self.here) / STEP_S
        self.now = (float(self.here[0]), float(self.here[1]), float(rate[0]), float(rate[1]))

    def walked(self, t: float) -> tuple[float, float, float, float]:
        """North, east, and their rates at ``t``."""
        x, y, dx, dy = self.now
        late = t - self.since
        return x + dx * late, y + dy * late, dx, dy


class CurrentConstant(_Moving):
    """A steady horizontal current, with turbulence of a twentieth of it."""

    name = "current_constant"
    least = -9.0
    unit = "0.3 of the working speed, from a direction drawn by the seed"

    def setup(self, plan: Planting) -> None:
        """Size and direction."""
        size, way = 0.3 * self.s * plan.scale.speed, float(plan.rng.uniform(-math.pi, math.pi))
        self.north, self.east = size * math.cos(way), size * math.sin(way)
        self.walk(0.05 * size, 8.0)
        self.values = {"speed": size, "towards_rad": way, "north": self.north, "east": self.east}

    def flow(self, t: float, x: float, y: float, z: float) -> Flow:
        """Constant plus walk."""
        a, rate = self.ramp(t)
        n, e, dn, de = self.walked(t)
        n, e = n + self.north, e + self.east
        return a * n, a * e, 0.0, a * dn + rate * n, a * de + rate * e, 0.0, 0.0, 0.0


class CurrentShear(_Moving):
    """A current that changes with depth around the starting depth, as the hyperbolic tangent of the distance to it."""

    name = "current_shear"
    unit = "+-0.5 of the working speed above and below, over a layer of 3 m"

    def setup(self, plan: Planting) -> None:
        """Size, direction, middle of the layer."""
        size, way = 0.5 * self.s * plan.scale.speed, float(plan.rng.uniform(-math.pi, math.pi))
        self.north, self.east = size * math.cos(way), size * math.sin(way)
        self.middle = plan.setting.depth + float(plan.rng.uniform(-1.0, 1.0))
        self.thick = 3.0
        self.values = {"speed": size, "towards_rad": way, "middle_m": self.middle, "thickness_m": self.thick}

    def flow(self, t: float, x: float, y: float, z: float) -> Flow:
        """Profile and its slope."""
        a, rate = self.ramp(t)
        shape = math.tanh((self.middle - z) / self.thick)
        slope = -(1.0 - shape * shape) / self.thick * a
        n, e = self.north, self.east
        return a * n * shape, a * e * shape, 0.0, rate * n * shape, rate * e * shape, 0.0, n * slope, e * slope


class CurrentVarying(_Moving):
    """A current without a mean: a slow random walk with a turning tide-like part."""

    name = "current_varying"
    unit = "a walk of 0.1 of the working speed over 40 s, and 0.15 of it turning once in 200 s"

    def setup(self, plan: Planting) -> None:
        """Walk and rotation."""
        self.size = 0.15 * self.s * plan.scale.speed
        self.walk(0.67 * self.size, 40.0)
        self.phase, self.rate = float(plan.rng.uniform(0.0, math.tau)), math.tau / 200.0
        self.values = {"speed": self.size, "tau_s": 40.0, "period_s": 200.0}

    def flow(self, t: float, x: float, y: float, z: float) -> Flow:
        """Walk plus slow rotation."""
        a, rate = self.ramp(t)
        n, e, dn, de = self.walked(t)
        c, s = math.cos(self.phase + self.rate * t), math.sin(self.phase + self.rate * t)
        n, e = n + self.size * c, e + self.size * s
        dn, de = dn - self.size * self.rate * s, de + self.size * self.rate * c
        return a * n, a * e, 0.0, a * dn + rate * n, a * de + rate * e, 0.0, 0.0, 0.0


class Waves(_Moving):
    """Swell: linear deep-water orbital motion of two neighbouring components, decaying with depth (Airy; Fossen 2021, 10.2)."""

    name = "waves"
    unit = "orbital speed 0.12 of the working speed at the starting depth"

    def setup(self, plan: Planting) -> None:
        """Frequencies, wave numbers and amplitudes."""
        depth = plan.setting.depth
        period = max(float(plan.rng.uniform(4.0, 7.0)), 1.6 * math.sqrt(depth))
        self.way = float(plan.rng.uniform(-math.pi, math.pi))
        orbit = 0.12 * self.s * plan.scale.speed
        self.parts: list[tuple[float, float, float, float]] = []
        for share, factor in ((0.8, 1.0), (0.4, 1.17)):
            w = math.tau / (period / factor)
            number = w * w / plan.nominal.gravity
            surface = share * orbit * math.exp(number * depth)
            self.parts.append((w, number, surface, float(plan.rng.uniform(0.0, math.tau))))
        self.values = {"period_s": period, "towards_rad": self.way, "orbital_speed": orbit}

    def flow(self, t: float, x: float, y: float, z: float) -> Flow:
        """Orbital velocity, its local acceleration and the depth slope of its horizontal part."""
        a, rate = self.ramp(t)
        c, s = math.cos(self.way), math.sin(self.way)
        along = h = v = dh = dv = slope = 0.0
        along = c * x + s * y
        for w, number, surface, phase in self.parts:
            size = surface * math.exp(-number * max(0.0, z))
            angle = number * along - w * t + phase
            ca, sa = math.cos(angle), math.sin(angle)
            h, v = h + size * ca, v + size * sa
            dh, dv = dh + size * w * sa, dv - size * w * ca
            slope -= number * size * ca
        dh, dv, slope = a * dh + rate * h, a * dv + rate * v, a * slope
        return a * h * c, a * h * s, a * v, dh * c, dh * s, dv, slope * c, slope * s


class DensityGradient(Effect):
    """A pycnocline near the starting depth: buoyancy grows by a smooth step with depth."""

    name = "density_gradient"
    least = -9.0
    place = "water"
    unit = "net buoyancy changes by +-0.15 of the working force across a layer of 3 m, at most as from fresh water to sea water"

    def setup(self, plan: Planting) -> None:
        """Half step (N), middle and thickness (m)."""
        salt = SALT * plan.nominal.gravity * plan.nominal.volume
        self.step = float(np.clip(0.15 * self.s * plan.scale.force, -salt, salt))
        self.middle = plan.setting.depth + float(plan.rng.uniform(-1.5, 0.5))
        self.values = {
            "half_step_n": self.step,
            "middle_m": self.middle,
            "thickness_m": 3.0,
            "half_step_density": self.step / (plan.nominal.gravity * plan.nominal.volume),
        }

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """More lift below, less above, at the centre of buoyancy."""
        lift = self.level(k.t) * self.step * math.tanh((k.z - self.middle) / 1.5)
        rb = self.plan.nominal.buoyancy_centre
        fx, fy, fz = -lift * k.r[6], -lift * k.r[7], -lift * k.r[8]
        f[0] += fx
        f[1] += fy
        f[2] += fz
        f[3] += rb[1] * fz - rb[2] * fy
        f[4] += rb[2] * fx - rb[0] * fz
        f[5] += rb[0] * fy - rb[1] * fx
