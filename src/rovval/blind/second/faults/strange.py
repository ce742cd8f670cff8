"""What no library holds: things that happen to vehicles and that a diagnosis should call unknown."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from rovval.blind.plant.spec import Array
from rovval.blind.second.fault import Fault, Instant, Log, pull


class _Strange(Fault):
    known = False


class TwistedTether(_Strange):
    """A stiff tether that is wound up as the vehicle turns: a moment against the turns made since the start, that slips beyond one turn."""

    name = "twisted_tether"
    unit = "half of the largest yaw moment a pilot asks for, at half a turn"

    def prepare(self) -> None:
        """Stiffness, N m/rad."""
        self.stiff, self.twist = 0.5 * self.size * float(self.sheet.ask[5]) / math.pi, 0.0
        self.values = {"stiffness": self.stiff}

    def advance(self, s: Instant, dt: float) -> None:
        """Wind up."""
        self.twist = min(math.tau, max(-math.tau, self.twist + dt * s.nu[5]))

    def wrench(self, s: Instant) -> Array:
        """Unwind."""
        return np.array([0.0, 0.0, 0.0, 0.0, 0.0, -self.on(s.t) * self.stiff * self.twist])


class OwnWash(_Strange):
    """A tank that is too small: the water set in motion by the jets comes back some seconds later, from everywhere at once."""

    name = "own_wash"
    unit = "a quarter of the thrusters' force ten seconds later"

    def prepare(self) -> None:
        """Delay and decay, s."""
        self.slow, self.mix = np.zeros(6), np.zeros(6)
        self.values = {"share": 0.25 * self.size, "delay_s": 10.0}

    def advance(self, s: Instant, dt: float) -> None:
        """Two stages of five seconds."""
        force = self.sheet.reach @ s.thrust
        self.mix = self.mix + dt / 5.0 * (force - self.mix)
        self.slow = self.slow + dt / 5.0 * (self.mix - self.slow)

    def wrench(self, s: Instant) -> Array:
        """The wash pushes the other way."""
        return np.asarray(-0.25 * self.size * self.on(s.t) * self.slow)


class TowedSled(_Strange):
    """A sled on a short line behind: it is dragged along, overruns when the vehicle slows, and pulls only when the line is taut."""

    name = "towed_sled"
    unit = "a third of the vehicle's mass on two metres of line, with half of its drag"

    def prepare(self) -> None:
        """Mass, drag, line."""
        self.mass, self.drag = 0.33 * self.size * self.sheet.mass, 0.5 * self.size * self.sheet.force / self.sheet.cruise**2
        self.long, self.stiff = 2.0, 3.0 * self.sheet.force
        self.tie = self.sheet.half_length * np.array([-0.9, 0.0, 0.1])
        self.at: Array | None = None
        self.v = np.zeros(3)
        self.values = {"mass": self.mass, "line_m": self.long}

    def _line(self, s: Instant) -> Array:
        """Force of the line on the vehicle, world."""
        if self.at is None:
            return np.zeros(3)
        away = self.at - s.at - s.world(self.tie)
        far = float(np.linalg.norm(away)) + 1e-6
        return np.asarray(away / far * self.stiff * max(0.0, far - self.long))

    def advance(self, s: Instant, dt: float) -> None:
        """Move the sled."""
        if self.at is None:
            self.at = s.at + s.world(self.tie) - s.world(np.array([1.9, 0.0, 0.0]))
        force = -self._line(s) - (self.drag * float(np.linalg.norm(self.v)) + 0.3 * self.mass) * self.v
        self.v = self.v + dt / (1.0 + 0.3 * dt) * force / self.mass
        self.at = self.at + dt * self.v

    def wrench(self, s: Instant) -> Array:
        """The line at the tie."""
        return pull(self.on(s.t) * s.body(self._line(s)), self.tie)


class Ventilation(_Strange):
    """Units that draw air or cavitate: beyond a shaft speed thrust falls, and comes back only well below it."""

    name, place = "ventilation", "input"
    unit = "0.6 of the thrust gone once the shaft exceeds 0.8 of the working speed, back below 0.5 of it"

    def prepare(self) -> None:
        """Which units ventilate now."""
        self.air = np.zeros(len(self.sheet.units), dtype=bool)
        self.values = {"loss": min(1.0, 0.6 * self.size)}

    def advance(self, s: Instant, dt: float) -> None:
        """Air comes and goes."""
        speed = np.abs(s.spin) / self.sheet.rpm
        self.air = np.where(self.air, speed > 0.5, speed > 0.8)

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Less with air."""
        return np.asarray(np.where(self.air, thrust * (1.0 - self.on(s.t) * min(1.0, 0.6 * self.size)), thrust))


class Kelp(_Strange):
    """Patches of kelp that stand still: inside one the vehicle is held by stalks, whatever its speed, and dragged up or down a little."""

    name = "kelp"
    unit = "0.5 of the working force against the motion in the middle of a patch, on a third of the ground"

    def prepare(self) -> None:
        """Where the patches are: where a sum of random waves over the ground is high."""
        self.number, self.phase = self.rng.normal(0.0, 1.2, (5, 2)), self.rng.uniform(0.0, math.tau, 5)
        self.hold = 0.5 * self.size * self.sheet.force
        self.values = {"force": self.hold}

    def wrench(self, s: Instant) -> Array:
        """Against the motion over ground, a little up."""
        thick = max(0.0, float(np.cos(self.number @ s.at[:2] + self.phase).mean()) - 0.1)
        v = np.array(s.nu[:3])
        back = -self.on(s.t) * self.hold * min(1.0, 3.0 * thick) * v / math.sqrt(float(v @ v) + 0.04**2)
        return pull(back - 0.15 * float(np.linalg.norm(back)) * s.down, self.sheet.half_length * np.array([0.4, 0.0, 0.3]))


class SlidingBattery(_Strange):
    """A battery tray that has come loose: it slides to an end when the vehicle tilts or speeds up enough, and stays there until tipped back."""

    name, place = "sliding_battery", "wrench"
    unit = "a shift worth 6 degrees of pitch, from one end to the other"

    def prepare(self) -> None:
        """Moment, N m; what makes it slide."""
        self.moment = math.radians(6.0) * self.size * self.sheet.stiffness
        self.at, self.goal, self.before = 0.0, 1.0, 0.0
        self.values = {"moment": self.moment}

    def advance(self, s: Instant, dt: float) -> None:
        """Slide in about a second once pulled by more than 2 % of the weight."""
        pulls = float(s.down[0]) - (s.nu[0] - self.before) / (dt * self.sheet.gravity)
        self.before = s.nu[0]
        if abs(pulls) > 0.02:
            self.goal = math.copysign(1.0, pulls)
        self.at += dt * (self.goal - self.at)

    def wrench(self, s: Instant) -> Array:
        """Bow down when it lies ahead."""
        return np.array([0.0, 0.0, 0.0, 0.0, -self.on(s.t) * self.moment * self.at * float(s.down[2]), 0.0])


class BeamLost(_Strange):
    """One beam of the DVL hears the hull's own noise: when the vehicle pitches or goes fast its velocity is drawn towards nothing."""

    name, place = "beam_lost", "sensor"
    unit = "0.35 of the surge speed missing above 0.6 of the working speed, for seconds at a time"

    def prepare(self) -> None:
        """Share."""
        self.values = {"share": 0.35 * self.size}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Bursts when fast."""
        fast = np.abs(true["u"]) > 0.6 * self.sheet.cruise
        falls, back = self.rng.random(len(t)) < 0.05, self.rng.random(len(t)) < 0.04
        bad = np.zeros(len(t))
        for i in range(1, len(t)):
            bad[i] = 1.0 if (bad[i - 1] and not back[i]) or (fast[i] and falls[i]) else 0.0
        log["LinVelX"] = log["LinVelX"] * (1.0 - self.levels(t) * bad * min(1.0, 0.35 * self.size))
        log["LinVelZ"] = log["LinVelZ"] + self.levels(t) * bad * 0.2 * min(1.0, 0.35 * self.size) * true["u"]


class SurgingPump(_Strange):
    """A dredge pump hung below: it pushes astern and up in bursts of its own making, about every ten seconds."""

    name = "surging_pump"
    unit = "0.4 of the working force in bursts of two to five seconds"

    def prepare(self) -> None:
        """Times of the bursts."""
        gaps = self.rng.uniform(6.0, 16.0, 400)
        self.begin, self.long = np.cumsum(gaps), self.rng.uniform(2.0, 5.0, 400)
        self.force = 0.4 * self.size * self.sheet.force
        self.values = {"force": self.force}

    def wrench(self, s: Instant) -> Array:
        """A burst with soft edges."""
        i = int(np.searchsorted(self.begin, s.t)) - 1
        since = s.t - float(self.begin[i]) if i >= 0 else 1e9
        if since > float(self.long[max(0, i)]):
            return np.zeros(6)
        edge = min(1.0, since / 0.4, (float(self.long[i]) - since) / 0.4)
        return pull(self.on(s.t) * edge * self.force * np.array([-0.8, 0.0, -0.6]), self.sheet.half_length * np.array([0.3, 0.1, 0.5]))
