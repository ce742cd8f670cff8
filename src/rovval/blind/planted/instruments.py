"""Scale, mounting and bias of the instruments."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.blind.plant.effect import Planting
from rovval.blind.plant.sensors import DVL, wander
from rovval.blind.plant.spec import Array
from rovval.blind.planted.timing import _Sensor

RATES = ("AngVelX", "AngVelY", "AngVelZ")
ANGLES = ("Roll", "Pitch", "Heading")
ROTATIONS = ("roll", "pitch", "yaw")


class DvlScale(_Sensor):
    """Sound speed set wrong: velocities too large, slightly more so deeper (warmer water above)."""

    name = "dvl_scale"
    least = -9.0
    unit = "0.07 too fast at the starting depth"

    def setup(self, plan: Planting) -> None:
        """Relative error and its depth slope (1/m)."""
        self.excess, self.slope = 0.07 * self.s, 0.001 * self.s
        self.values = {"relative": self.excess, "per_metre": self.slope}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Scale all three."""
        gain = 1.0 + self.levels(t) * (self.excess + self.slope * (true["z"] - self.plan.setting.depth))
        for name in DVL:
            log[name] = gain * log[name]


class DvlMisalignment(_Sensor):
    """The DVL is mounted turned, about the body's yaw (default), pitch or roll axis."""

    name = "dvl_misalignment"
    least = -9.0
    form = "equal"
    targets = ("yaw", "pitch", "roll")
    unit = "7 degrees"

    def setup(self, plan: Planting) -> None:
        """Angle, rad."""
        self.angle = float(np.radians(7.0) * self.s)
        self.values = {"angle_rad": self.angle}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Turn the other two components (the instrument turned by +angle reads the vector turned by -angle)."""
        first, second = {"yaw": (0, 1), "pitch": (2, 0), "roll": (1, 2)}[self.target or "yaw"]
        angle = self.angle * self.levels(t)
        x, y = log[DVL[first]], log[DVL[second]]
        log[DVL[first]] = np.cos(angle) * x + np.sin(angle) * y
        log[DVL[second]] = -np.sin(angle) * x + np.cos(angle) * y


class DvlLeverArm(_Sensor):
    """The DVL's place on the vehicle is not taken into account: it sees the velocity of its own spot."""

    name = "dvl_lever_arm"
    form = "equal"
    unit = "0.8 of the vehicle's half-length forward, 0.3 to starboard, 0.4 down"

    def setup(self, plan: Planting) -> None:
        """Arm, m."""
        self.arm = plan.scale.length * self.s * np.array([0.8, 0.3, 0.4])
        self.values = {"arm": self.arm.tolist()}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Add w x r."""
        rates = np.stack([true["p"], true["q"], true["r"]], axis=1)
        extra = self.levels(t)[:, None] * np.cross(rates, self.arm)
        for i, name in enumerate(DVL):
            log[name] = log[name] + extra[:, i]


class GyroBias(_Sensor):
    """A bias on one rate, with a slow walk of a fifth of it."""

    name = "gyro_bias"
    least = -9.0
    targets = ("yaw", "pitch", "roll")
    unit = "1 degree a second"

    def setup(self, plan: Planting) -> None:
        """Bias, deg/s."""
        self.bias = self.s * float(plan.rng.choice([-1.0, 1.0]))
        self.values = {"bias_deg_s": self.bias}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Constant and walk."""
        name = RATES[ROTATIONS.index(self.target or "yaw")]
        walk = 1.0 + wander(self.plan.rng, len(t), 0.2, 60.0)
        log[name] = log[name] + self.bias * self.levels(t) * walk


class CompassDeviation(_Sensor):
    """Heading error with heading (hard and soft iron) and with the current of the thrusters."""

    name = "compass_deviation"
    unit = "10 degrees in the first harmonic, 3 in the second, 3 with thrust"

    def setup(self, plan: Planting) -> None:
        """Amplitudes (deg) and phases (rad)."""
        self.phase = plan.rng.uniform(-np.pi, np.pi, 2)
        self.first, self.second, self.thrust_part = 10.0 * self.s, 3.0 * self.s, 3.0 * self.s
        self.values = {"first_deg": self.first, "second_deg": self.second, "phases": self.phase.tolist()}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Deviation by true heading and by the mean of the horizontal units' speed."""
        psi = true["psi"]
        load = np.mean([true[f"n:{n}"] for n in self.plan.nominal.thrusters], axis=0) / self.plan.scale.rpm
        error = self.first * np.sin(psi + self.phase[0]) + self.second * np.sin(2.0 * psi + self.phase[1])
        log["Heading"] = log["Heading"] + self.levels(t) * (error + self.thrust_part * load)


class AttitudeBias(_Sensor):
    """The attitude unit is mounted with a tilt."""

    name = "attitude_bias"
    least = -9.0
    form = "equal"
    targets = ("pitch", "roll")
    unit = "3 degrees"

    def setup(self, plan: Planting) -> None:
        """Tilt, deg."""
        self.tilt = 3.0 * self.s * float(plan.rng.choice([-1.0, 1.0]))
        self.values = {"tilt_deg": self.tilt}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Add to the angle."""
        name = ANGLES[ROTATIONS.index(self.target or "pitch")]
        log[name] = log[name] + self.tilt * self.levels(t)
