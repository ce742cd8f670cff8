"""Clocks and filters: the log, not the world, is late."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.signal import lfilter

from rovval.blind.plant.effect import Effect, Planting
from rovval.blind.plant.sensors import DVL
from rovval.blind.plant.spec import STEP_S, Array

GROUPS: Mapping[str, tuple[str, ...]] = {
    "velocity": DVL,
    "attitude": ("Roll", "Pitch", "Heading", "AngVelX", "AngVelY", "AngVelZ"),
    "depth": ("Depth",),
}


class _Sensor(Effect):
    """Shared by the sensor effects: the level as an array."""

    place = "sensor"

    def levels(self, t: Array) -> Array:
        """Level at every row."""
        return np.array([self.level(float(x)) for x in t])


class TimeOffset(_Sensor):
    """One group of channels is stamped late: DVL velocities (default), attitude, depth or the thrusters."""

    name = "time_offset"
    least = -9.0
    form = "equal"
    targets = ("velocity", "attitude", "depth", "thruster_feedback")
    unit = "0.4 s late"

    def setup(self, plan: Planting) -> None:
        """Delay, s."""
        self.delay = 0.4 * self.s
        self.values = {"delay_s": self.delay}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Read each channel earlier."""
        names = GROUPS.get(self.target or "velocity") or tuple(f"{n}_PV" for n in self.plan.nominal.thrusters)
        for name in names:
            log[name] = np.interp(t - self.delay * self.levels(t), t, log[name])


class ClockDrift(_Sensor):
    """The thruster logger's clock runs away from the navigation's, faster as it warms up."""

    name = "clock_drift"
    least = -9.0
    unit = "1.5 s late by the end, a quarter of it by the middle"

    def setup(self, plan: Planting) -> None:
        """Offset at the end, s."""
        self.end = 1.5 * self.s
        self.values = {"offset_at_end_s": self.end}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Shift the thruster rows by a square law in time."""
        late = self.levels(t) * self.end * (t / t[-1]) ** 2
        for unit in self.plan.nominal.thrusters:
            for name in (f"{unit}_PV", f"{unit}_SP"):
                log[name] = np.interp(t - late, t, log[name])
            log[f"{unit}_SP"] = np.round(log[f"{unit}_SP"])


class VelocityFilterLag(_Sensor):
    """The DVL's output filter: second order, critically damped."""

    name = "velocity_filter_lag"
    unit = "two poles of 0.35 s"

    def setup(self, plan: Planting) -> None:
        """Pole time constant, s."""
        self.tau = 0.35 * self.s
        self.values = {"pole_s": self.tau, "delay_s": 2.0 * self.tau}

    def record(self, log: dict[str, Array], true: Mapping[str, Array], t: Array) -> None:
        """Two exponential smoothers in a row."""
        keep = float(np.exp(-STEP_S / max(self.tau, 1e-6)))
        a = self.levels(t)
        for name in DVL:
            x = log[name]
            y = x
            for _ in range(2):
                y = lfilter([1.0 - keep], [1.0, -keep], y, zi=[keep * y[0]])[0]
            log[name] = x + a * (y - x)
