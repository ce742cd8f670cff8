"""Forces near the bottom and near a wall."""

from __future__ import annotations

import math

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.rotation import to_body
from rovval.blind.plant.spec import Array


class GroundEffect(Effect):
    """Close to the bottom: a steady lift, suction with surge and sway speed, and a cushion against heave.

    The share falls as an image vortex does, (1 + (h/l)^2)^(-3/2) with h the altitude.
    """

    name = "ground_effect"
    unit = "at half a metre (small vehicles 0.25 m): steady lift of a quarter of the working force"

    def setup(self, plan: Planting) -> None:
        """Reach (m) and force (N)."""
        self.reach = 1.6 if plan.scale.work_class else 0.8
        self.force = 0.35 * self.s * plan.scale.force
        self.values = {"reach_m": self.reach, "force": self.force, "start_altitude": plan.setting.bottom - plan.setting.depth}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Lift away from the bottom, less with forward speed, more on the way down."""
        near = max(0.05, k.altitude) / self.reach
        share = self.level(k.t) * (1.0 + near * near) ** -1.5
        u = math.hypot(k.rel[0], k.rel[1]) / self.plan.scale.speed
        w = k.rel[2] / self.plan.scale.speed
        lift = share * self.force * (0.8 - 0.5 * u * u + 1.2 * abs(w) * w)
        fx, fy, fz = to_body(k.r, 0.0, 0.0, -lift)
        f[0] += fx
        f[1] += fy
        f[2] += fz


class WallSuction(Effect):
    """A wall beside the start: the passage between draws the vehicle in, with the square of speed and with the jets."""

    name = "wall_suction"
    unit = "0.3 of the working force at 1 m and working speed; the wall is 1.5 to 3 m from the start"

    def setup(self, plan: Planting) -> None:
        """Wall as a vertical plane: direction to it and distance from the start."""
        way = plan.setting.heading + float(plan.rng.choice([-1.0, 1.0])) * math.pi / 2
        self.north, self.east = math.cos(way), math.sin(way)
        self.distance = float(plan.rng.uniform(1.5, 3.0))
        self.force = 0.3 * self.s * plan.scale.force
        self.values = {"towards_rad": way, "distance_m": self.distance, "force": self.force}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Pull along the normal; the gap is never less than 0.6 m (fenders)."""
        gap = max(0.6, self.distance - self.north * k.x - self.east * k.y)
        sc = self.plan.scale
        speed2 = (k.rel[0] ** 2 + k.rel[1] ** 2) / sc.speed**2
        jets = float(abs(k.thrust).sum()) / (len(k.thrust) * sc.thrust)
        pull = self.level(k.t) * self.force * (0.7 * speed2 + 0.5 * jets) / gap
        fx, fy, fz = to_body(k.r, pull * self.north, pull * self.east, 0.0)
        f[0] += fx
        f[1] += fy
        f[2] += fz
