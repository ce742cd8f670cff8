"""Who flies and what: each pilot gives, ten times a second, a wrench to ask of the thrusters.

Pilots know the nominal vehicle only, and see what its instruments say. The joystick is a human: it decides, waits for its reaction time, moves the
stick no faster than a hand does, and corrects what it notices.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from rovval.blind.plant.spec import STEP_S, Array
from rovval.blind.second.fault import Site
from rovval.blind.second.sheet import LEVEL_RAD_S, Sheet

HAND_S = 0.35  # time constant of a hand on a stick (chosen)
REACTION_S = 0.4  # of a human (chosen)
QUICKEST = 1.2  # rad/s, widest bandwidth of a hold (chosen)
KEEP_OFF_M = 1.0  # altitude, and depth, that pilots keep clear of


@dataclass(slots=True)
class Seen:
    """What the pilot's instruments say: place (m), attitude (rad), velocities in body axes, altitude (m)."""

    at: Array
    roll: float
    pitch: float
    yaw: float
    nu: Array
    altitude: float


def apart(a: float, b: float) -> float:
    """Angle from ``b`` to ``a``, -pi to pi."""
    return math.atan2(math.sin(a - b), math.cos(a - b))


class Pilot:
    """What pilots have in common: holds, thumbs and an eye on surface and bottom."""

    def __init__(self, sheet: Sheet, site: Site, rng: np.random.Generator) -> None:
        self.sheet, self.site, self.rng = sheet, site, rng
        mass = np.array([*(sheet.mass + np.diag(sheet.added)[:3]), *(np.diag(sheet.inertia) + np.diag(sheet.added)[3:])])
        full = np.array([1.0, 1.0, 1.0, 0.3, 0.3, 0.5])  # m or rad: the error at which a hold asks for all that it may
        self.mass, self.wide = mass, np.minimum(QUICKEST, np.sqrt(sheet.ask / (mass * full)))
        self.trim = np.zeros(6)
        self.until, self.heading, self.depth = 0.0, site.heading, site.depth
        self.start()

    def start(self) -> None:
        """Draw the plan."""

    def fly(self, t: float, seen: Seen) -> Array:
        """Wrench (6,) to ask for; roll and pitch are left to `level`."""
        raise NotImplementedError

    def ask(self, t: float, seen: Seen) -> Array:
        """Whole set-points (rpm) of the units."""
        wrench = self.fly(t, seen)
        wrench[3:5] = self.level(seen)
        wrench[2] = self.clear(seen, float(wrench[2]))
        speeds = self.sheet.speeds(self.sheet.share @ wrench)
        over = float(np.abs(speeds).max()) / self.sheet.rpm_limit
        return np.asarray(np.round(speeds / max(1.0, over)))

    def hold(self, axis: int, error: float, rate: float) -> float:
        """Proportional, derivative and slowly integral action on an error (m or rad), critically damped, within what may be asked for."""
        w, most = float(self.wide[axis]), float(self.sheet.ask[axis])
        wanted = float(self.mass[axis]) * (w * w * error - 2.0 * w * rate) + float(self.trim[axis])
        if abs(wanted) < most:
            self.trim[axis] += STEP_S * 0.2 * float(self.mass[axis]) * w**3 * error
        return max(-most, min(most, wanted))

    def level(self, seen: Seen) -> tuple[float, float]:
        """Roll and pitch moment of an autopilot, where the vehicle does not right itself."""
        if self.sheet.uprights_itself:
            return 0.0, 0.0
        stiff, damp = LEVEL_RAD_S**2, 1.6 * LEVEL_RAD_S
        roll = float(self.mass[3]) * (-stiff * seen.roll - damp * float(seen.nu[3]))
        pitch = float(self.mass[4]) * (-stiff * seen.pitch - damp * float(seen.nu[4]))
        most = self.sheet.ask[3:5]
        return float(np.clip(roll, -most[0], most[0])), float(np.clip(pitch, -most[1], most[1]))

    def clear(self, seen: Seen, heave: float) -> float:
        """The heave asked for, or away from bottom or surface where they are near."""
        ahead = 3.0 * float(seen.nu[2])
        if seen.altitude - max(0.0, ahead) < KEEP_OFF_M:
            return -0.8 * float(self.sheet.ask[2])
        if float(seen.at[2]) + min(0.0, ahead) < KEEP_OFF_M + 0.5:
            return 0.8 * float(self.sheet.ask[2])
        return heave

    def steer(self, seen: Seen, heading: float) -> float:
        """Yaw moment towards a heading."""
        return self.hold(5, apart(heading, seen.yaw), float(seen.nu[5]))

    def dive(self, seen: Seen, depth: float) -> float:
        """Heave force towards a depth."""
        deepest = self.site.seabed - KEEP_OFF_M - 0.3
        return self.hold(2, min(deepest, max(2.0, depth)) - float(seen.at[2]), float(seen.nu[2]))

    def pace(self, axis: int, speed: float, seen: Seen) -> float:
        """Surge or sway force that holds a speed: the sheet's drag there and a part of what is missing."""
        feed = math.copysign(self.sheet.drag(axis, abs(speed)), speed)
        most = float(self.sheet.ask[axis])
        return max(-most, min(most, feed + float(self.mass[axis]) * 0.5 * (speed - float(seen.nu[axis]))))

    def place(self, seen: Seen, north: float, east: float) -> tuple[float, float]:
        """Surge and sway force towards a place."""
        c, s = math.cos(seen.yaw), math.sin(seen.yaw)
        dn, de = north - float(seen.at[0]), east - float(seen.at[1])
        return self.hold(0, c * dn + s * de, float(seen.nu[0])), self.hold(1, -s * dn + c * de, float(seen.nu[1]))


class Joystick(Pilot):
    """A human who goes places: one intention at a time on one to three axes, held for some seconds, with taps of correction and rests."""

    WAYS = ((0,), (0,), (1,), (2,), (5,), (0, 5), (0, 1), (1, 5), (0, 2), (0, 1, 5), ())

    def start(self) -> None:
        """Thumbs off."""
        self.thumb, self.wish, self.moves_at, self.next_wish, self.check_at = np.zeros(6), np.zeros(6), 0.0, np.zeros(6), 0.0
        self.free: tuple[int, ...] = ()

    def fly(self, t: float, seen: Seen) -> Array:
        """Decide, react, move the stick, correct."""
        if t >= self.until:
            self.until, self.moves_at = t + float(self.rng.uniform(3.0, 11.0)), t + REACTION_S
            self.free = self.WAYS[int(self.rng.integers(len(self.WAYS)))]
            self.next_wish = np.zeros(6)
            for axis in self.free:
                self.next_wish[axis] = float(self.rng.choice([-1.0, 1.0]) * self.rng.uniform(0.3, 1.0))
            if 0 in self.free and self.rng.random() < 0.4:
                self.next_wish[0] = abs(self.next_wish[0])
        if t >= self.moves_at:
            self.wish = self.next_wish.copy()
            self._correct(t, seen)
        self.thumb += (self.wish - self.thumb) * (STEP_S / HAND_S)
        tremor = 0.01 * self.rng.standard_normal(6) * (np.abs(self.thumb) > 0.05)
        return np.asarray((self.thumb + tremor) * self.sheet.ask)

    def _correct(self, t: float, seen: Seen) -> None:
        """What is not being moved on purpose is kept, by taps, where it has gone visibly astray."""
        if 5 in self.free:
            self.heading = seen.yaw
        elif abs(off := apart(self.heading, seen.yaw)) > 0.12:
            self.wish[5] = math.copysign(min(0.6, 1.2 * abs(off)), off)
        if 2 in self.free:
            self.depth = float(seen.at[2])
        elif abs(deep := self.depth - float(seen.at[2])) > 0.4:
            self.wish[2] = math.copysign(min(0.6, 0.5 * abs(deep)), deep)


class Transects(Pilot):
    """A lawnmower: lines at a held speed, headings and depth held, short cross legs, now and then a crab."""

    def start(self) -> None:
        """The first line."""
        self.leg, self.speed, self.crab = -1, 0.0, 0.0

    def fly(self, t: float, seen: Seen) -> Array:
        """The present leg."""
        if t >= self.until:
            self.leg += 1
            long = self.leg % 2 == 0
            self.until = t + float(self.rng.uniform(28.0, 48.0) if long else self.rng.uniform(9.0, 14.0))
            self.speed = float(self.rng.uniform(0.4, 1.0)) * self.sheet.cruise
            self.crab = float(self.rng.choice([0.0, 0.0, 0.25, -0.25])) * self.sheet.cruise if long else 0.0
            if self.leg:
                self.heading += math.pi / 2 * (1.0 if (self.leg - 1) // 2 % 2 == 0 else -1.0)
                self.depth += float(self.rng.choice([0.0, 0.0, 0.0, -1.0, 0.8]))
        eased = self.speed * max(0.2, math.cos(min(1.5, abs(apart(self.heading, seen.yaw)))))
        return np.array([self.pace(0, eased, seen), self.pace(1, self.crab, seen), self.dive(seen, self.depth), 0.0, 0.0, self.steer(seen, self.heading)])


class Hover(Pilot):
    """Station keeping on place, heading and depth, with a new station every half minute or so."""

    def start(self) -> None:
        """The first station is where it starts."""
        self.station = np.zeros(2)

    def fly(self, t: float, seen: Seen) -> Array:
        """Hold the station."""
        if t >= self.until:
            if t > 0.0:
                self.station = self.station + self.rng.normal(0.0, 1.3, 2)
                self.heading += float(self.rng.normal(0.0, 0.7))
                self.depth += float(self.rng.normal(0.0, 0.5))
            self.until = t + float(self.rng.uniform(18.0, 40.0))
        surge, sway = self.place(seen, float(self.station[0]), float(self.station[1]))
        return np.array([surge, sway, self.dive(seen, self.depth), 0.0, 0.0, self.steer(seen, self.heading)])


class Square(Pilot):
    """Round a square, one side after another with a stop at each corner, sides alternately ahead, to starboard, astern and to port."""

    def start(self) -> None:
        """Sides of 12 to 20 s; each round either turns at the corners or keeps its heading and goes sideways."""
        self.phase, self.speed, self.turns = -1, 0.0, True

    def fly(self, t: float, seen: Seen) -> Array:
        """The present side or stop."""
        if t >= self.until:
            self.phase += 1
            going = self.phase % 2 == 0
            self.until = t + float(self.rng.uniform(12.0, 20.0) if going else self.rng.uniform(5.0, 9.0))
            if going and self.phase % 8 == 0:
                self.turns, self.speed = bool(self.rng.random() < 0.5), float(self.rng.uniform(0.45, 1.0)) * self.sheet.cruise
                self.depth += float(self.rng.choice([-0.7, 0.0, 0.7]))
            if not going and self.turns:
                self.heading += math.pi / 2
        side, going = self.phase // 2 % 4, self.phase % 2 == 0
        u = v = 0.0
        if going and self.turns:
            u = self.speed
        elif going:
            u, v = ((self.speed, 0.0), (0.0, 0.7 * self.speed), (-self.speed, 0.0), (0.0, -0.7 * self.speed))[side]
        return np.array([self.pace(0, u, seen), self.pace(1, v, seen), self.dive(seen, self.depth), 0.0, 0.0, self.steer(seen, self.heading)])


class Pirouette(Pilot):
    """Turns on the spot and on the move: a held yaw moment each way at several sizes, with none, surge or sway beside it, and coasts."""

    def start(self) -> None:
        """Nothing asked yet."""
        self.stick = np.zeros(6)

    def fly(self, t: float, seen: Seen) -> Array:
        """The present figure."""
        if t >= self.until:
            self.until = t + float(self.rng.uniform(6.0, 18.0))
            self.stick = np.zeros(6)
            if self.rng.random() > 0.15:
                self.stick[5] = float(self.rng.choice([-1.0, 1.0]) * self.rng.uniform(0.35, 1.0))
                beside = int(self.rng.choice([0, 1, 3]))
                self.stick[beside] = float(self.rng.choice([-1.0, 1.0]) * self.rng.uniform(0.3, 0.9))
                self.stick[3] = 0.0
            self.depth += float(self.rng.choice([-0.6, 0.0, 0.6]))
        out = self.stick * self.sheet.ask
        out[2] = self.dive(seen, self.depth)
        return np.asarray(out)


class Orbit(Pilot):
    """Round a structure, looking at it: sideways at a held distance, up or down a step after each arc, backing off now and then."""

    def start(self) -> None:
        """The structure stands a few metres ahead."""
        self.radius = float(self.rng.uniform(3.0, 5.0))
        ahead = self.radius * np.array([math.cos(self.site.heading), math.sin(self.site.heading)])
        self.centre, self.speed, self.wide_by = ahead, 0.0, 0.0

    def fly(self, t: float, seen: Seen) -> Array:
        """Keep distance and look at it."""
        if t >= self.until:
            self.until = t + float(self.rng.uniform(12.0, 26.0))
            self.speed = float(self.rng.choice([-1.0, 1.0]) * self.rng.uniform(0.25, 0.7)) * self.sheet.cruise
            self.wide_by = float(self.rng.choice([0.0, 0.0, 0.0, 1.5]))
            self.depth += float(self.rng.choice([-1.0, -0.5, 0.5, 1.0]))
        way = self.centre - seen.at[:2]
        look = math.atan2(float(way[1]), float(way[0]))
        gap = float(np.hypot(*way)) - self.radius - self.wide_by
        return np.array([
            self.hold(0, gap, float(seen.nu[0])), self.pace(1, self.speed, seen), self.dive(seen, self.depth), 0.0, 0.0, self.steer(seen, look),
        ])  # fmt: skip


PILOTS: Mapping[str, Any] = MappingProxyType(
    {"joystick": Joystick, "transects": Transects, "hover": Hover, "square": Square, "pirouette": Pirouette, "orbit": Orbit}
)
