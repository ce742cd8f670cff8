"""Foreign effects of the machine: drives, autopilots, loads that move."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.effect import Kinematics, Planting
from rovval.blind.plant.parameters import Params
from rovval.blind.plant.spec import STEP_S, Array
from rovval.blind.planted.foreign_flow import _Foreign


class StickyThruster(_Foreign):
    """A vane that sticks: the thrust of one unit stays at that of an old speed until the speed has moved enough.

    It begins with the speed of some time before the log, never with rest: where it never lets go it would be a dead thruster, which the library knows.
    """

    name = "sticky_thruster"
    place = "input"
    targets = ("thruster",)
    unit = "it lets go after a change of 0.8 of the working speed"

    def setup(self, plan: Planting) -> None:
        """Band (rpm) and memory: half to all of the working speed, ahead or astern (chosen)."""
        self.at, self.band = self.unit_index, 0.8 * self.s * plan.scale.rpm
        self.held = float(plan.rng.choice((-1.0, 1.0)) * plan.rng.uniform(0.5, 1.0)) * plan.scale.rpm
        self.values = {"band_rpm": self.band, "first_rpm": self.held}

    def tick(self, k: Kinematics) -> None:
        """Slip when the pull exceeds the band."""
        n = float(k.n[self.at])
        if abs(n - self.held) > self.band:
            self.held = n

    def speed(self, n: Array, k: Kinematics) -> Array:
        """The held speed acts."""
        out = n.copy()
        out[self.at] += self.level(k.t) * (self.held - out[self.at])
        return out


class PowerLimit(_Foreign):
    """A common supply that gives way: all thrust falls when the sum of powers is high (hydraulic pressure drop)."""

    name = "power_limit"
    place = "input"
    unit = "half of all thrust lost when every unit works at working speed"

    def setup(self, plan: Planting) -> None:
        """Share lost."""
        self.full = plan.scale.thrust * plan.scale.rpm
        self.values = {"half_power_share": 1.0 / max(self.s, 1e-9)}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Divide by one plus the power share."""
        power = float(np.abs(thrust * k.turn).mean()) / self.full
        return np.asarray(thrust / (1.0 + self.level(k.t) * self.s * power))


class IntermittentThruster(_Foreign):
    """A loose coupling: one unit now and then gives nothing for a second or two while its shaft turns."""

    name = "intermittent_thruster"
    place = "input"
    targets = ("thruster",)
    unit = "off for 1.5 s at a time, a third of the time"

    def setup(self, plan: Planting) -> None:
        """Chances a step, to fall out and to come back."""
        self.at, self.off = self.unit_index, False
        self.out, self.back = STEP_S / 3.0, STEP_S / 1.5
        self.values = {"loss": self.s, "mean_off_s": 1.5, "mean_on_s": 3.0}

    def tick(self, k: Kinematics) -> None:
        """Two-state chain."""
        self.off = bool(self.plan.rng.random() < (1.0 - self.back if self.off else self.out))

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Nothing while off."""
        if not self.off:
            return thrust
        out = thrust.copy()
        out[self.at] *= 1.0 - min(1.0, self.s) * self.level(k.t)
        return out


class HiddenTrim(_Foreign):
    """An autopilot's integral trim through a unit that the log does not have: it winds up against drift and yaw, and leaks."""

    name = "hidden_trim"
    unit = "0.15 of the working force after 5 s at 0.3 of the working speed"

    def setup(self, plan: Planting) -> None:
        """Gains."""
        sc = plan.scale
        self.gain = 0.15 * self.s * sc.force / (5.0 * 0.3 * sc.speed)
        self.spin = 0.15 * self.s * float(sc.stick[5]) / (5.0 * 0.3)
        self.values = {"gain": self.gain, "yaw_gain": self.spin, "leak_s": 20.0}

    def start(self, k: Kinematics) -> Array:
        """Sway, heave and yaw trim, in metres and radians."""
        return np.zeros(3)

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """Leaky integral."""
        return np.asarray(np.array([k.vel[1], k.vel[2], k.vel[5]]) - own / 20.0)

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Against the sum."""
        a = self.level(k.t)
        f[1] -= a * self.gain * float(own[0])
        f[2] -= a * self.gain * float(own[1])
        f[5] -= a * self.spin * float(own[2])


class LimitCycle(_Foreign):
    """A machine on board that hunts: heave force and pitch moment at a steady beat (Van der Pol)."""

    name = "limit_cycle"
    unit = "heave force of 0.25 of the working force, period of three of the vehicle's time constants (4 to 10 s)"

    def setup(self, plan: Planting) -> None:
        """Beat and size."""
        self.beat = math.tau / min(10.0, max(4.0, 3.0 * plan.scale.time))
        self.force = 0.25 * self.s * plan.scale.force
        self.values = {"period_s": math.tau / self.beat, "force": self.force}

    def start(self, k: Kinematics) -> Array:
        """On the cycle."""
        return np.array([2.0, 0.0])

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """q'' + w (q^2 - 1) q' + w^2 q = 0; states q and q'/w."""
        q, d = float(own[0]), float(own[1])
        return np.array([self.beat * d, -self.beat * (q + (q * q - 1.0) * d)])

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Heave and pitch."""
        push = 0.5 * self.level(k.t) * self.force * float(own[0])
        f[2] += push
        f[4] += 0.3 * self.plan.scale.length * push


class Manipulator(_Foreign):
    """A manipulator that reaches about: the centre of gravity wanders between a few places, seconds at each."""

    name = "manipulator"
    place = "vehicle"
    unit = "tilts of up to 6 degrees, a new place every 8 s or so"

    def setup(self, plan: Planting) -> None:
        """Reach of the centre of gravity (m), and the plan."""
        arm = plan.scale.upright / (plan.nominal.mass * plan.nominal.gravity)
        self.reach = math.tan(math.radians(6.0)) * self.s * arm
        self.times = np.cumsum(plan.rng.uniform(5.0, 11.0, 200))
        self.places = self.reach * plan.rng.uniform(-1.0, 1.0, (201, 2))
        self.now = np.zeros(2)
        self.values = {"reach_m": self.reach}

    def level(self, t: float) -> float:
        """The time itself: the parameters are brought up to date at every step."""
        self.share = super().level(t)
        return t

    def change(self, p: Params, a: float) -> None:
        """Glide to the place of the moment, over two seconds."""
        i = int(np.searchsorted(self.times, a))
        since = a - (float(self.times[i - 1]) if i else -9.0)
        x = min(1.0, since / 2.0)
        x = x * x * (3.0 - 2.0 * x)
        p.gravity_centre[:2] += self.share * (self.places[i - 1] * (1.0 - x) + self.places[i] * x)


class SwingingLoad(_Foreign):
    """A load on a sling under the vehicle: a mass on a spring in surge and sway that swings in its own time."""

    name = "swinging_load"
    unit = "0.12 of the vehicle's mass, swinging at about a fifth of a hertz"

    def setup(self, plan: Planting) -> None:
        """Mass (kg), frequency (rad/s), place below."""
        self.load, self.w = 0.12 * self.s * plan.nominal.mass, 1.3
        self.below = 0.6 * plan.scale.length
        self.values = {"mass": self.load, "frequency_rad_s": self.w, "below_m": self.below}

    def start(self, k: Kinematics) -> Array:
        """Displacement and velocity over ground, surge and sway."""
        return np.zeros(4)

    def _spring(self, k: Kinematics, own: Array) -> tuple[float, float]:
        a, b = self.load * self.w**2, 0.16 * self.load * self.w
        return a * own[0] + b * (own[2] - k.vel[0]), a * own[1] + b * (own[3] - k.vel[1])

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """The load in the body's turning frame."""
        r = k.vel[5]
        fx, fy = self._spring(k, own)
        return np.array(
            [
                own[2] - k.vel[0] + r * own[1],
                own[3] - k.vel[1] - r * own[0],
                -fx / self.load + r * own[3],
                -fy / self.load - r * own[2],
            ]
        )

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Pull of the sling at its hook."""
        fx, fy = (self.level(k.t) * x for x in self._spring(k, own))
        f[0] += fx
        f[1] += fy
        f[3] -= self.below * fy
        f[4] += self.below * fx
