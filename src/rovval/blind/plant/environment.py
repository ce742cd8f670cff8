"""Where and in what a flight takes place; drawn from the seed alone, so that nothing here tells what is planted."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.effect import Kinematics, Setting
from rovval.blind.plant.nominal_vehicle import NominalVehicle
from rovval.blind.plant.scales import Scales
from rovval.blind.plant.spec import STEP_S, stream

VOLTS_WORK, VOLTS_SMALL = 600.0, 16.0  # V, chosen: a work-class DC bus; a four-cell battery


def draw_setting(nominal: NominalVehicle, scale: Scales, seed: int, duration_s: float) -> Setting:
    """Depth, altitude, heading, anchor of the tether, supply."""
    rng = stream(seed, "setting")
    depth = float(np.exp(rng.uniform(np.log(5.0), np.log(30.0))))
    altitude = float(np.exp(rng.uniform(np.log(1.5), np.log(8.0))))
    way, far = float(rng.uniform(-math.pi, math.pi)), float(rng.uniform(8.0, 16.0))
    anchor = np.array([far * math.cos(way), far * math.sin(way), max(0.0, depth - float(rng.uniform(4.0, 10.0)))])
    return Setting(
        seed=seed,
        duration_s=duration_s,
        depth=depth,
        bottom=depth + altitude,
        heading=float(rng.uniform(-math.pi, math.pi)),
        anchor=anchor,
        droop=float(rng.uniform(0.18, 0.30)),
        volts=VOLTS_WORK if scale.work_class else VOLTS_SMALL,
    )


class Background:
    """What nobody models: a small random wrench (turbulence, hoses), Ornstein-Uhlenbeck over 1.5 s.

    Its standard deviation is ``slop`` x 0.1 of the working force (moments: x the vehicle's half-length), so that zero slop is
    the textbook vehicle.
    """

    def __init__(self, scale: Scales, slop: float, rng: np.random.Generator) -> None:
        force = 0.1 * slop * scale.force
        self.size = force * np.array([1.0, 1.0, 1.0, 0.3 * scale.length, 0.3 * scale.length, 0.3 * scale.length])
        self.keep = math.exp(-STEP_S / 1.5)
        self.now, self.rng = self.size * rng.standard_normal(6), rng

    def step(self) -> list[float]:
        """The wrench of the next control step."""
        push = math.sqrt(1.0 - self.keep**2) * self.size * self.rng.standard_normal(6)
        self.now = self.keep * self.now + push
        return [float(a) for a in self.now]


class Supply:
    """The supply voltage: an energy store that empties in proportion to time and work, and an inner resistance."""

    def __init__(self, scale: Scales, setting: Setting) -> None:
        self.setting, self.scale = setting, scale
        self.energy, self.volts = 0.0, setting.volts
        self.full = 0.35 * scale.thrust * scale.rpm * setting.duration_s

    def step(self, t: float, k: Kinematics) -> float:
        """Voltage over nominal, for the next control step."""
        power = float(np.abs(k.static * k.turn).mean())
        self.energy += power * STEP_S
        emptied = 0.5 * t / self.setting.duration_s + 0.5 * (1.0 - math.exp(-1.5 * self.energy / self.full))
        load = 0.03 * min(2.0, power / (self.scale.thrust * self.scale.rpm))
        ratio = 1.0 - self.setting.droop * min(1.0, emptied) - load
        self.volts = self.setting.volts * ratio
        return ratio
