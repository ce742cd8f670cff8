"""Foreign events and foreign faults of the log."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rovval.blind.plant.effect import Kinematics, Planting
from rovval.blind.plant.rotation import to_body
from rovval.blind.plant.sensors import DVL
from rovval.blind.plant.spec import Array
from rovval.blind.planted.foreign_flow import _Foreign


class CollisionBumps(_Foreign):
    """The vehicle is knocked now and then: half-sine pushes of 0.4 s from random sides, at random spots."""

    name = "collision_bumps"
    unit = "twice the working force at the peak, every 12 s or so"

    def setup(self, plan: Planting) -> None:
        """When, which way, where."""
        rng = plan.rng
        count = int(plan.setting.duration_s / 12.0) + 1
        self.when = np.sort(rng.uniform(0.0, plan.setting.duration_s, count))
        way = rng.standard_normal((count, 3)) * [1.0, 1.0, 0.5]
        self.push = 2.0 * self.s * plan.scale.force * way / np.linalg.norm(way, axis=1, keepdims=True)
        self.spot = 0.5 * plan.scale.length * rng.uniform(-1.0, 1.0, (count, 3))
        self.values = {"times_s": self.when.tolist(), "peak": 2.0 * self.s * plan.scale.force}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """The bump of the moment, if any."""
        i = int(np.searchsorted(self.when, k.t)) - 1
        if i < 0 or k.t - self.when[i] > 0.4:
            return
        gain = self.level(k.t) * math.sin(math.pi * float(k.t - self.when[i]) / 0.4)
        force, spot = gain * self.push[i], self.spot[i]
        for j, x in enumerate((*force.tolist(), *np.cross(spot, force).tolist())):
            f[j] += x


class WaterLeak(_Foreign):
    """A housing fills: weight grows from the onset on, quickly at first, at the stern."""

    name = "water_leak"
    event = True
    unit = "0.25 of the working force heavier by the end"

    def setup(self, plan: Planting) -> None:
        """Final weight (N) and place."""
        self.final = 0.25 * self.s * plan.scale.force
        self.tau = 0.4 * (plan.setting.duration_s - (self.onset or 0.0)) + 1.0
        self.at = -0.3 * plan.scale.length
        self.values = {"final_weight": self.final, "tau_s": self.tau}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Weight at the stern."""
        since = max(0.0, k.t - (self.onset or 0.0))
        weight = 1.09 * self.final * (1.0 - math.exp(-since / self.tau))
        fx, fy, fz = to_body(k.r, 0.0, 0.0, weight)
        f[0] += fx
        f[1] += fy
        f[2] += fz
        f[4] -= self.at * fz
        f[5] += self.at * fy


class BallastPump(_Foreign):
    """A trim pump that nobody logs: net buoyancy goes up and down in steps, half a minute each."""

    name = "ballast_pump"
    unit = "+-0.15 of the working force, changing every 30 s over 4 s"

    def setup(self, plan: Planting) -> None:
        """Force (N) and phase (s)."""
        self.force, self.phase = 0.15 * self.s * plan.scale.force, float(plan.rng.uniform(0.0, 60.0))
        self.values = {"force": self.force, "phase_s": self.phase}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Square wave with soft edges."""
        beat = math.sin(math.tau * (k.t + self.phase) / 60.0)
        push = self.level(k.t) * self.force * math.tanh(8.0 * beat)
        for i, x in enumerate(to_body(k.r, 0.0, 0.0, push)):
            f[i] += x


class VelocityQuantised(_Foreign):
    """The velocities come in coarse steps and are held between pings."""

    name = "velocity_quantised"
    place = "sensor"
    unit = "steps of 0.1 m/s, a ping every 0.8 s"

    def setup(self, plan: Planting) -> None:
        """Step (m/s) and hold (rows)."""
        self.step, self.hold = 0.1 * self.s, max(1, round(8 * self.s))
        self.values = {"step_m_s": self.step, "hold_rows": float(self.hold)}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Hold, then round."""
        rows = np.arange(len(t)) // self.hold * self.hold
        late = np.array([self.level(float(x)) for x in t]) >= 1.0
        for name in DVL:
            log[name] = np.where(late, np.round(log[name][rows] / self.step) * self.step, log[name])


class DepthScale(_Foreign):
    """The depth reads wrong with speed: the pressure port sees the flow (a static-port error), and its scale is off."""

    name = "depth_port_error"
    least = -9.0
    place = "sensor"
    unit = "0.25 m at working speed, scale 0.06 off the start depth"

    def setup(self, plan: Planting) -> None:
        """Sizes."""
        self.port, self.scale = 0.25 * self.s, 0.06 * self.s
        self.values = {"port_m": self.port, "relative": self.scale}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Quadratic in surge, linear in depth."""
        a = np.array([self.level(float(x)) for x in t])
        flow = (true["u"] / self.plan.scale.speed) ** 2
        log["Depth"] = log["Depth"] + a * (self.port * flow + self.scale * (true["z"] - self.plan.setting.depth))


class GyroSaturation(_Foreign):
    """The yaw gyro clips: rates beyond a limit read the limit, and its scale is asymmetric."""

    name = "gyro_saturation"
    place = "sensor"
    unit = "clips at 0.12 rad/s (7 degrees a second); larger severity clips earlier"

    def setup(self, plan: Planting) -> None:
        """Limit, deg/s."""
        self.limit = 7.0 / self.s if self.s > 0.0 else math.inf
        self.values = {"limit_deg_s": self.limit}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Soft clip."""
        a = np.array([self.level(float(x)) for x in t])
        x = log["AngVelZ"]
        log["AngVelZ"] = x + a * (np.clip(x, -self.limit, 0.8 * self.limit) - x)
