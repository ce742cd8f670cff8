"""What the pilots fly. A mission is called once a control step and gives a body wrench to ask for, or set-points directly."""

from __future__ import annotations

import math
from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from rovval.blind.missions.pilot import Nav, Reflexes, set_points
from rovval.blind.plant.effect import Setting
from rovval.blind.plant.nominal_vehicle import NominalVehicle
from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import Array


class Mission:
    """Base: what every mission knows. ``__call__(t, nav)`` gives set-points in rpm."""

    def __init__(self, nominal: NominalVehicle, scale: Scales, setting: Setting, rng: np.random.Generator) -> None:
        self.nominal, self.scale, self.setting, self.rng = nominal, scale, setting, rng
        floor = 0.8 if scale.work_class else 0.4
        self.reflexes = Reflexes(nominal, scale, floor, 2.0 if scale.work_class else 0.8)
        self.prepare()

    def prepare(self) -> None:
        """Draw the plan."""

    def wrench(self, t: float, nav: Nav) -> Array:
        """Body wrench (N, N m) to ask for at ``t``."""
        raise NotImplementedError

    def __call__(self, t: float, nav: Nav) -> Array:
        """Set-points (rpm)."""
        wrench = self.wrench(t, nav)
        roll, pitch = self.reflexes.hold_level(nav)
        wrench[3] += roll
        wrench[4] += pitch
        return set_points(wrench, self.nominal, self.scale)


class Rich(Mission):
    """Free flight, open loop: random steps on all axes at two amplitudes, held 3 to 9 s, with coasts in between."""

    def prepare(self) -> None:
        """Draw the plan."""
        self.until, self.stick = 0.0, np.zeros(6)

    def wrench(self, t: float, nav: Nav) -> Array:
        """Body wrench to ask for."""
        if t >= self.until:
            self.until = t + float(self.rng.uniform(3.0, 9.0))
            size = self.rng.choice([0.0, 0.4, 0.9], 6, p=[0.35, 0.3, 0.35])
            self.stick = size * self.rng.choice([-1.0, 1.0], 6) * self.scale.stick
            if self.rng.random() < 0.12:
                self.stick = np.zeros(6)
        out = self.stick.copy()
        out[2] = self.reflexes.keep_off(nav, out[2])
        return out


class Survey(Mission):
    """Transects with heading and depth hold, surge stick by leg, turns of 90 degrees, now and then a new depth."""

    def prepare(self) -> None:
        """Draw the plan."""
        self.until, self.heading, self.depth, self.surge, self.side = 0.0, self.setting.heading, self.setting.depth, 0.0, 0.0
        self.first = True

    def wrench(self, t: float, nav: Nav) -> Array:
        """Body wrench to ask for."""
        if t >= self.until:
            self.until = t + float(self.rng.uniform(25.0, 45.0))
            self.surge = float(self.rng.choice([0.45, 0.7, 0.95]))
            self.side = float(self.rng.choice([0.0, 0.0, -0.3, 0.3]))
            if not self.first:
                self.heading += float(self.rng.choice([-1.0, 1.0])) * math.pi / 2
                high = max(1.0, self.setting.bottom - 1.0)
                self.depth = min(high, max(3.0, self.depth + float(self.rng.choice([0.0, 0.0, -1.5, 1.0]))))
            self.first = False
        r, stick = self.reflexes, self.scale.stick
        heave = r.keep_off(nav, r.hold_depth(nav, self.depth))
        return np.array([self.surge * stick[0], self.side * stick[1], heave, 0.0, 0.0, r.hold_heading(nav, self.heading)])


class Station(Mission):
    """Station keeping on position, heading and depth, with small jumps of the set-point."""

    def prepare(self) -> None:
        """Draw the plan."""
        self.until, self.place, self.heading, self.depth = 0.0, np.zeros(2), self.setting.heading, self.setting.depth

    def wrench(self, t: float, nav: Nav) -> Array:
        """Body wrench to ask for."""
        if t >= self.until:
            self.until = t + float(self.rng.uniform(20.0, 40.0))
            self.place = self.place + self.rng.uniform(-1.5, 1.5, 2)
            self.heading += float(self.rng.uniform(-0.8, 0.8))
            self.depth = min(self.setting.bottom - 0.9, max(2.5, self.depth + float(self.rng.uniform(-0.6, 0.6))))
        r = self.reflexes
        surge, sway = r.hold_place(nav, float(self.place[0]), float(self.place[1]))
        heave = r.keep_off(nav, r.hold_depth(nav, self.depth))
        return np.array([surge, sway, heave, 0.0, 0.0, r.hold_heading(nav, self.heading)])


class Protocol(Mission):
    """The thesis's movement protocol (its table 4.6): surge, sway, heave and yaw, each way, on and at rest for as long.

    30 s each in the thesis; here the sixteen parts share the duration. Up comes before down.
    """

    def prepare(self) -> None:
        """Draw the plan."""
        self.part = min(30.0, self.setting.duration_s / 16.0)
        self.size = float(self.rng.uniform(0.55, 0.95))

    def wrench(self, t: float, nav: Nav) -> Array:
        """Body wrench to ask for."""
        out = np.zeros(6)
        step, resting = divmod(int(t / self.part), 2)
        if not resting:
            axis = (0, 1, 2, 5)[(step // 2) % 4]
            sign = 1.0 if step % 2 == 0 else -1.0
            out[axis] = self.size * self.scale.stick[axis] * (-sign if axis == 2 else sign)
        out[2] = self.reflexes.keep_off(nav, out[2])
        return out


class Steps(Mission):
    """Each thruster alone, forward then reverse at two speeds, 5 s on and 5 s off."""

    def __call__(self, t: float, nav: Nav) -> Array:
        """Set-points (rpm): one unit at a time."""
        many = len(self.nominal.thrusters)
        count, resting = divmod(int(t / 5.0), 2)
        out = np.zeros(many)
        if not resting:
            sign = 1.0 if (count // many) % 2 == 0 else -1.0
            size = 0.7 if (count // (2 * many)) % 2 == 0 else 0.45
            out[count % many] = round(sign * size * self.scale.rpm)
        heave = self.reflexes.keep_off(nav, 0.0)
        roll, pitch = self.reflexes.hold_level(nav)
        if heave or roll or pitch:
            out += set_points(np.array([0.0, 0.0, heave, roll, pitch, 0.0]), self.nominal, self.scale)
        return out


class Yoyo(Mission):
    """Vertical saw-tooth over several metres with heading hold, a new heading each cycle, slow surge on every other."""

    def prepare(self) -> None:
        """Draw the plan."""
        self.reach = min(5.0, self.setting.depth - 2.5, 12.0 * self.scale.speed)
        self.rate = 0.3 * self.scale.speed

    def wrench(self, t: float, nav: Nav) -> Array:
        """Body wrench to ask for."""
        cycle, along = divmod(t * self.rate, 2.0 * self.reach)
        up = along if along < self.reach else 2.0 * self.reach - along
        r, stick = self.reflexes, self.scale.stick
        heave = r.keep_off(nav, r.hold_depth(nav, self.setting.depth - up))
        heading = self.setting.heading + cycle * math.pi / 2
        surge = 0.4 * float(stick[0]) if int(cycle) % 2 else 0.0
        return np.array([surge, 0.0, heave, 0.0, 0.0, r.hold_heading(nav, heading)])


MISSIONS: Mapping[str, type[Mission]] = MappingProxyType(
    {"rich": Rich, "survey": Survey, "station": Station, "protocol": Protocol, "steps": Steps, "yoyo": Yoyo}
)
