"""Weight, buoyancy, trim and inertia that the simulator has wrong."""

from __future__ import annotations

import numpy as np

from rovval.blind.plant.effect import Effect, Planting
from rovval.blind.plant.parameters import Params


class BuoyancyError(Effect):
    """Net buoyancy differs: more volume of foam (severity above zero) or less."""

    name = "buoyancy_error"
    least = -9.0
    form = "equal"
    place = "vehicle"
    unit = "net lift of 0.15 of the working force"

    def setup(self, plan: Planting) -> None:
        """Extra volume (m3) for the wanted lift (N)."""
        self.lift = 0.15 * self.s * plan.scale.force
        self.volume = self.lift / (plan.nominal.density * plan.nominal.gravity)
        self.values = {"lift": self.lift, "volume": self.volume}

    def change(self, p: Params, a: float) -> None:
        """More displaced water."""
        p.volume += a * self.volume


class CgOffset(Effect):
    """The centre of gravity is off along surge (x) or sway (y), in the weight's moment and in the mass matrix alike."""

    name = "cg_offset"
    least = -9.0
    place = "vehicle"
    targets = ("surge", "sway")
    unit = "a static tilt of 4 degrees (on a small vehicle: against its autopilot)"

    def setup(self, plan: Planting) -> None:
        """Offset (m) for the tilt, by the vehicle's own stiffness."""
        self.offset = float(np.tan(np.radians(4.0)) * self.s * plan.scale.upright / (plan.nominal.mass * plan.nominal.gravity))
        self.values = {"offset": self.offset}

    def change(self, p: Params, a: float) -> None:
        """Move the centre of gravity."""
        p.gravity_centre[self.axis] += a * self.offset


class PayloadChange(Effect):
    """A payload is picked up at the bow (severity above zero) or lost there, at the onset: mass, weight, trim, inertia."""

    name = "payload_change"
    least = -2.0
    place = "vehicle"
    event = True
    unit = "a wet weight of 0.15 of the working force (mass x g is four times that), a quarter of the half-length forward"

    def setup(self, plan: Planting) -> None:
        """Mass (kg), volume (m3) and place (m) of the payload: a body of four thirds the density of water."""
        wet = 0.15 * self.s * plan.scale.force
        self.mass = 4.0 * wet / plan.nominal.gravity
        self.volume = 3.0 * wet / (plan.nominal.density * plan.nominal.gravity)
        self.at = np.array([0.25 * plan.scale.length, 0.1 * plan.scale.length, 0.2 * plan.scale.length])
        self.values = {"mass": self.mass, "wet_weight": wet, "at": self.at.tolist()}

    def change(self, p: Params, a: float) -> None:
        """Compose the payload with the vehicle (parallel axes)."""
        mass, volume = a * self.mass, a * self.volume
        total = p.mass + mass
        p.gravity_centre = (p.mass * p.gravity_centre + mass * self.at) / total
        p.buoyancy_centre = (p.volume * p.buoyancy_centre + volume * self.at) / (p.volume + volume)
        p.inertia = p.inertia + mass * (float(self.at @ self.at) * np.eye(3) - np.outer(self.at, self.at))
        p.mass, p.volume = total, p.volume + volume


class InertiaError(Effect):
    """Mass (surge, sway, heave: the same) or one moment of inertia differs, weight and buoyancy kept in balance."""

    name = "inertia_error"
    least = -1.0
    place = "vehicle"
    targets = ("yaw", "roll", "pitch", "surge")
    unit = "0.4 more of the moment of inertia, or 0.25 more of the mass (flooded volume, weightless)"

    def setup(self, plan: Planting) -> None:
        """Relative excess."""
        self.excess = (0.25 if self.axis < 3 else 0.4) * self.s
        self.values = {"relative": self.excess}

    def change(self, p: Params, a: float) -> None:
        """Trapped water: inertia without weight."""
        if self.axis >= 3:
            p.inertia[self.axis - 3, self.axis - 3] *= 1.0 + a * self.excess
            return
        water = a * self.excess * p.mass
        p.volume += water / p.density
        p.buoyancy_centre = p.buoyancy_centre * (1.0 - water / (p.mass + water))
        p.mass += water
