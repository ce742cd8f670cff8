"""Drag and added mass that the simulator has wrong."""

from __future__ import annotations

import numpy as np

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.parameters import Params
from rovval.blind.plant.spec import AXES, Array

TURN = 0.5  # rad/s, the working rate of roll, pitch and yaw drag (chosen)
LEAST_COEFFICIENT = 0.8  # of a coefficient of the file, four standard deviations of 5 % slop below it


def working_drag(plan: Planting, axis: int) -> tuple[float, float]:
    """Working speed of an axis (m/s or rad/s) and the nominal drag there (N or N m)."""
    speed = plan.scale.speed if axis < 3 else TURN
    lin, quad = float(plan.nominal.linear_drag[axis]), float(plan.nominal.quadratic_drag[axis])
    return speed, lin * speed + quad * speed * speed


def passive(own: float, coefficient: float) -> float:
    """What is added to an axis's ``own`` coefficient of drag. Where more would be taken away than a vehicle within slop is sure to have, so
    that the water would push it on, as much is added."""
    return coefficient if LEAST_COEFFICIENT * own + coefficient >= 0.0 else abs(coefficient)


class QuadraticDrag(Effect):
    """Extra form drag on one axis, with a drag coefficient that falls with the Reynolds number as Re^-0.2."""

    name = "quadratic_drag"
    least = -1.0
    targets = AXES
    unit = "half of the axis's working drag more, at working speed"

    def setup(self, plan: Planting) -> None:
        """Coefficient at working speed."""
        self.ref, drag = working_drag(plan, self.axis)
        self.coefficient = passive(float(plan.nominal.quadratic_drag[self.axis]), 0.5 * self.s * drag / self.ref**2)
        self.values = {"coefficient": self.coefficient, "reference_speed": self.ref, "reynolds_power": -0.2}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """-c |v| v (|v|/v_ref)^-0.2."""
        v = k.rel[self.axis]
        size = abs(v)
        f[self.axis] -= self.level(k.t) * self.coefficient * size * v * (size / self.ref + 0.01) ** -0.2


class LinearDrag(Effect):
    """Extra drag in proportion to speed on one axis."""

    name = "linear_drag"
    least = -1.0
    form = "equal"
    targets = AXES
    unit = "0.4 of the axis's working drag more at working speed, in proportion to speed"

    def setup(self, plan: Planting) -> None:
        """Coefficient, N s/m or N m s."""
        ref, drag = working_drag(plan, self.axis)
        self.coefficient = passive(float(plan.nominal.linear_drag[self.axis]), 0.4 * self.s * drag / ref)
        self.values = {"coefficient": self.coefficient}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """-d v."""
        f[self.axis] -= self.level(k.t) * self.coefficient * k.rel[self.axis]


class AddedMass(Effect):
    """More (or, below zero, less) added mass on one axis; its Coriolis and Munk terms follow from the momentum."""

    name = "added_mass"
    form = "equal"
    place = "vehicle"
    targets = AXES
    unit = "0.35 of the axis's rigid-body mass more"

    def setup(self, plan: Planting) -> None:
        """Extra, kg or kg m2."""
        i = self.axis
        rigid = plan.nominal.mass if i < 3 else float(plan.nominal.inertia[i - 3, i - 3])
        self.extra = 0.35 * self.s * rigid
        self.values = {"extra": self.extra, "nominal": float(plan.nominal.added_mass[i, i])}

    def change(self, p: Params, a: float) -> None:
        """One diagonal term."""
        p.added_mass[self.axis, self.axis] += a * self.extra


class CrossDrag(Effect):
    """Bow-heavy lateral drag by strips: sideways motion turns the vehicle, turning pushes it sideways (and heave-pitch)."""

    name = "cross_drag"
    least = -9.0
    unit = "centre of lateral pressure 0.2 of the vehicle's half-length ahead"

    def setup(self, plan: Planting) -> None:
        """Strip stations and weights; the weights sum to zero so that straight drag is unchanged."""
        reach = plan.scale.length
        self.stations: list[float] = (reach * np.linspace(-1.0, 1.0, 7)).tolist()
        arm = 0.2 * self.s * reach
        total = sum(x * x for x in self.stations)
        self.weights = [arm * x / total for x in self.stations]
        self.qy, self.qz = (working_drag(plan, i)[1] / plan.scale.speed**2 for i in (1, 2))
        self.values = {"arm": arm}

    def wrench(self, k: Kinematics, own: Array, f: list[float]) -> None:
        """Strip theory: -w_j q |v + x_j r| (v + x_j r) at station x_j."""
        a = self.level(k.t)
        v, w, q, r = k.rel[1], k.rel[2], k.rel[4], k.rel[5]
        for x, weight in zip(self.stations, self.weights, strict=True):
            side, down = v + x * r, w - x * q
            fy = -a * weight * self.qy * abs(side) * side
            fz = -a * 0.5 * weight * self.qz * abs(down) * down
            f[1] += fy
            f[2] += fz
            f[4] -= x * fz
            f[5] += x * fy
