"""The log is off, not the world: mounting, scale, bias and time of the instruments."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.signal import butter, lfilter, lfilter_zi

from rovval.blind.plant.spec import STEP_S, Array
from rovval.blind.second.fault import Fault, Log
from rovval.blind.second.instruments import RATES, VELOCITIES, walk

TURNS = ("roll", "pitch", "yaw")
ANGLES = ("Roll", "Pitch", "Heading")
CHANNELS = {"velocity": VELOCITIES, "attitude": (*ANGLES, *RATES), "depth": ("Depth",)}


class _Sensor(Fault):
    place = "sensor"


class TimeOffset(_Sensor):
    """A group of channels is stamped late, by a delay that jitters by a tenth of itself (a network)."""

    name, targets, both_signs = "time_offset", ("velocity", "attitude", "depth", "thruster_feedback"), True
    unit = "0.35 s late"

    def prepare(self) -> None:
        """Delay, s."""
        self.delay = 0.35 * self.size
        self.values = {"delay_s": self.delay}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Read it earlier."""
        names = CHANNELS.get(str(self.target)) or tuple(f"{unit}_PV" for unit in self.sheet.units)
        held = np.repeat(self.rng.uniform(-1.0, 1.0, len(t) // 20 + 1), 20)[: len(t)]
        for name in names:
            log[name] = np.interp(t - self.levels(t) * self.delay * (1.0 + 0.1 * held), t, log[name])


class ClockDrift(_Sensor):
    """The logger of the thrusters runs slow, and is set right once in mid-log by half of what it is off."""

    name, both_signs = "clock_drift", True
    unit = "6 ms a second"

    def prepare(self) -> None:
        """Rate."""
        self.rate = 0.006 * self.size
        self.values = {"rate": self.rate}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Later and later."""
        off = self.rate * t
        off = np.where(t > 0.55 * t[-1], off - 0.5 * self.rate * 0.55 * t[-1], off)
        for unit in self.sheet.units:
            for name in (f"{unit}_PV", f"{unit}_SP"):
                log[name] = np.interp(t - self.levels(t) * off, t, log[name])
            log[f"{unit}_SP"] = np.round(log[f"{unit}_SP"])


class DvlScale(_Sensor):
    """The DVL's beams stand at another angle than is assumed: horizontal velocity is scaled, the vertical the other way and less."""

    name, both_signs = "dvl_scale", True
    unit = "0.07 too fast, and vertically 0.02 too slow"

    def prepare(self) -> None:
        """Shares."""
        self.values = {"horizontal": 0.07 * self.size}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Scale."""
        on = self.levels(t)
        for name, share in zip(VELOCITIES, (0.07, 0.07, -0.02), strict=True):
            log[name] = log[name] * (1.0 + on * share * self.size)


class DvlMisalignment(_Sensor):
    """The DVL is mounted turned about one axis, and a sixth of that about another."""

    name, targets, both_signs = "dvl_misalignment", ("yaw", "pitch", "roll"), True
    unit = "6 degrees"

    def prepare(self) -> None:
        """Small rotation vector, rad."""
        main = TURNS.index(str(self.target))
        self.by = np.radians(6.0) * self.size * np.eye(3)[main]
        self.by[(main + 1) % 3] = self.by[main] / 6.0
        self.values = {"angle_rad": float(self.by[main])}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """The turned instrument reads the vector turned back."""
        v = np.stack([log[name] for name in VELOCITIES], axis=1)
        angle = float(np.linalg.norm(self.by))
        axis = self.by / max(angle, 1e-12)
        a = -angle * self.levels(t)[:, None]
        turned = np.cos(a) * v + np.sin(a) * np.cross(axis, v) + (1.0 - np.cos(a)) * (v @ axis)[:, None] * axis
        for i, name in enumerate(VELOCITIES):
            log[name] = turned[:, i]


class DvlLeverArm(_Sensor):
    """The DVL sits elsewhere, and its velocity is not brought to the origin."""

    name, form = "dvl_lever_arm", "equal"
    unit = "0.7 half-lengths aft, 0.2 to port, 0.4 below"

    def prepare(self) -> None:
        """Arm, m."""
        self.arm = self.size * self.sheet.half_length * np.array([-0.7, -0.2, 0.4])
        self.values = {"arm": self.arm.tolist()}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Add rotation times arm."""
        extra = np.cross(np.stack([true[k] for k in "pqr"], axis=1), self.arm)
        for i, name in enumerate(VELOCITIES):
            log[name] = log[name] + self.levels(t) * extra[:, i]


class GyroBias(_Sensor):
    """A bias that settles as the gyro warms up (time constant 200 s), and walks."""

    name, targets, both_signs = "gyro_bias", TURNS, True
    unit = "1 degree a second when cold, 0.6 when warm"

    def prepare(self) -> None:
        """Bias, deg/s."""
        self.values = {"cold_deg_s": self.size}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Add it."""
        name = RATES[TURNS.index(str(self.target))]
        log[name] = log[name] + self.levels(t) * self.size * (0.6 + 0.4 * np.exp(-t / 200.0)) + walk(self.rng, len(t), 0.02)


class CompassDeviation(_Sensor):
    """Iron aboard: the deviation of a magnetised hull, exact (the heading of the sum of the earth's field and the hull's)."""

    name = "compass_deviation"
    unit = "a field of 0.18 of the earth's horizontal one, and soft iron of 0.04"

    def prepare(self) -> None:
        """Hard iron, soft iron."""
        way = float(self.rng.uniform(-np.pi, np.pi))
        self.hard = 0.18 * min(2.5, self.size) * np.array([np.cos(way), np.sin(way)])
        self.soft = 0.04 * min(2.5, self.size)
        self.values = {"hard": self.hard.tolist(), "soft": self.soft}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Heading of the sum."""
        ahead, side = np.cos(true["yaw"]), -np.sin(true["yaw"])
        x, y = ahead * (1.0 + self.soft) + self.hard[0], side * (1.0 - self.soft) + self.hard[1]
        off = np.arctan2(np.sin(-np.arctan2(y, x) - true["yaw"]), np.cos(-np.arctan2(y, x) - true["yaw"]))
        log["Heading"] = log["Heading"] + self.levels(t) * np.degrees(off)


class AttitudeBias(_Sensor):
    """The attitude unit sits crooked, by one angle and a fifth of it by the other."""

    name, targets, both_signs = "attitude_bias", ("pitch", "roll"), True
    unit = "3 degrees"

    def prepare(self) -> None:
        """Tilts, deg."""
        self.values = {"tilt_deg": 3.0 * self.size}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Add them."""
        main = TURNS.index(str(self.target))
        for i in (0, 1):
            log[ANGLES[i]] = log[ANGLES[i]] + self.levels(t) * 3.0 * self.size * (1.0 if i == main else 0.2)


class VelocityFilterLag(_Sensor):
    """The DVL's output goes through a Butterworth filter of second order."""

    name = "velocity_filter_lag"
    unit = "corner at 0.35 Hz; twice the severity, half the corner"

    def prepare(self) -> None:
        """Corner, Hz."""
        self.corner = min(4.0, 0.35 / self.size)
        self.values = {"corner_hz": self.corner, "delay_s": float(np.sqrt(2.0) / (2.0 * np.pi * self.corner))}

    def record(self, log: Log, true: Mapping[str, Array], t: Array) -> None:
        """Filter."""
        b, a = butter(2, self.corner * 2.0 * STEP_S)
        for name in VELOCITIES:
            x = log[name]
            log[name] = x + self.levels(t) * (lfilter(b, a, x, zi=lfilter_zi(b, a) * x[0])[0] - x)
