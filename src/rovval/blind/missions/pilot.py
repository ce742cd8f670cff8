"""The pilot's instruments and reflexes: holds for heading, depth and position, and the way from a wrench to set-points.

Gains are proportional-integral-derivative from a wanted natural frequency; the pilot knows the nominal vehicle only.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from rovval.blind.plant.nominal_vehicle import NominalVehicle
from rovval.blind.plant.rotation import wrap
from rovval.blind.plant.scales import LEVEL_RAD_S, Scales, rpm_for
from rovval.blind.plant.spec import STEP_S, Array


@dataclass(slots=True)
class Nav:
    """What the pilot sees: position and depth (m), angles (rad), body velocities, altitude (m)."""

    x: float
    y: float
    z: float
    phi: float
    theta: float
    psi: float
    u: float
    v: float
    w: float
    p: float
    q: float
    r: float
    altitude: float


class Hold:
    """One-axis PID on an error in metres or radians, giving a force or moment within the stick's reach."""

    def __init__(self, inertia: float, frequency: float, reach: float, integral: float = 0.15) -> None:
        self.stiff = inertia * frequency**2
        self.damp = 1.4 * inertia * frequency  # damping ratio 0.7
        self.slow = integral * self.stiff * frequency
        self.reach, self.sum = reach, 0.0

    def __call__(self, error: float, rate: float) -> float:
        """Demand for an error (wanted minus seen) and the rate of what is held."""
        raw = self.stiff * error - self.damp * rate + self.sum
        demand = max(-self.reach, min(self.reach, raw))
        if raw == demand:
            self.sum += self.slow * error * STEP_S
        return demand


class Reflexes:
    """Holds of one vehicle, shared by the missions."""

    def __init__(self, nominal: NominalVehicle, scale: Scales, floor: float, ceiling: float) -> None:
        self.scale, self.nominal = scale, nominal
        self.floor, self.ceiling = floor, ceiling  # least altitude, least depth, m
        mass = np.diag(nominal.added_mass)[:3] + nominal.mass
        spin = float(nominal.inertia[2, 2] + nominal.added_mass[5, 5])
        w = min(1.5, max(0.35, 1.2 / scale.time))
        stick = scale.stick
        self.heading = Hold(spin, 1.2 * w, float(max(stick[5], 1.5 * spin * w * w * 0.3)))
        self.depth = Hold(float(mass[2]), w, float(stick[2]))
        self.north = Hold(float(mass[0]), 0.6 * w, float(stick[0]))
        self.east = Hold(float(mass[1]), 0.6 * w, float(stick[1]))
        small = 0.0 if scale.work_class else LEVEL_RAD_S
        roll, pitch = (float(nominal.inertia[i, i] + nominal.added_mass[i + 3, i + 3]) for i in (0, 1))
        self.roll = Hold(roll, small, float(0.5 * scale.capacity[3]), 0.0)
        self.pitch = Hold(pitch, small, float(0.5 * scale.capacity[4]), 0.0)
        self.guard = float(mass[2]) * w * w

    def hold_heading(self, nav: Nav, psi: float) -> float:
        """Yaw moment towards heading ``psi``."""
        return self.heading(wrap(psi - nav.psi), nav.r)

    def hold_depth(self, nav: Nav, z: float) -> float:
        """Heave force towards depth ``z``."""
        return self.depth(z - nav.z, nav.w)

    def hold_level(self, nav: Nav) -> tuple[float, float]:
        """Roll and pitch moment towards level; none on a work-class vehicle, which rights itself."""
        return self.roll(-nav.phi, nav.p), self.pitch(-nav.theta, nav.q)

    def hold_place(self, nav: Nav, x: float, y: float) -> tuple[float, float]:
        """Surge and sway force towards a point."""
        c, s = math.cos(nav.psi), math.sin(nav.psi)
        vx, vy = c * nav.u - s * nav.v, s * nav.u + c * nav.v
        fx, fy = self.north(x - nav.x, vx), self.east(y - nav.y, vy)
        return c * fx + s * fy, -s * fx + c * fy

    def keep_off(self, nav: Nav, heave: float) -> float:
        """Heave demand with the bottom and the surface respected (a pilot's eye on the altimeter)."""
        low = self.floor + 1.5 * max(0.0, nav.w) * self.scale.time - nav.altitude
        high = self.ceiling - 1.5 * min(0.0, nav.w) * self.scale.time - nav.z
        push = float(self.scale.stick[2])
        if low > 0.0:
            return max(-push, min(heave, -self.guard * low))
        if high > 0.0:
            return min(push, max(heave, self.guard * high))
        return heave


def set_points(wrench: Array, nominal: NominalVehicle, scale: Scales) -> Array:
    """Set-points (whole rpm) for a body wrench: least-squares allocation and square law.

    At the speed limit surge and sway give way first, in steps of a fifth, then everything together.
    """
    ahead = wrench.copy()
    ahead[2:] = 0.0
    for share in (1.0, 0.8, 0.6, 0.4, 0.2, 0.0):
        thrust = scale.share @ (wrench - (1.0 - share) * ahead)
        rpm = rpm_for(thrust, nominal.k_pos, nominal.k_neg)
        peak = float(np.max(np.abs(rpm)))
        if peak <= scale.rpm_limit:
            return np.round(rpm)
    return np.round(rpm * (scale.rpm_limit / peak))
