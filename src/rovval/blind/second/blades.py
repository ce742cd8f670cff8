"""Thrust in all four quadrants, and the drives that turn the shafts.

A blade at 0.7 of the radius meets the water at the angle of advance theta = atan2(u_a, 0.7 pi n D); lift goes as sin 2 alpha and drag as
(1 - cos 2 alpha)/2 of its angle of attack alpha = pitch angle - theta (Healey, Rock, Cody, Miles and Brown 1995, IEEE J. Oceanic Eng. 20(4),
"Toward an improved understanding of thruster dynamics for underwater vehicles", eqs. 8 to 14).
"""

from __future__ import annotations

import numpy as np

from rovval.blind.plant.spec import Array
from rovval.blind.second.sheet import Sheet

PITCH = float(np.arctan(1.0 / (0.7 * np.pi)))  # rad, blade angle at 0.7 R of pitch ratio one
GLIDE = 0.6  # largest drag over largest lift of a stalled plate (Healey 1995: 1.2 and 2.0 or so)
TABLE = np.linspace(-1.0, 1.0, 17)  # advance ratios of the sheet's open-water curve; held beyond, where nothing was measured
TAU_S = (0.08, 0.3)  # time constant of a drive, of vehicles below and above 200 kg (chosen)
SLEW_S = 1.2  # a drive takes as long at least from rest to its limit, in seconds times its time constant over 0.3 s (chosen)


def blade(n: Array, axial: Array, diameter: Array) -> Array:
    """Thrust over that at rest of the same shaft speed, times n^2 (rpm^2): (N,), of speeds ``n`` (rpm) in an inflow ``axial`` (m/s)."""
    flow = 60.0 * axial / (0.7 * np.pi * diameter)  # the shaft speed at which the blade would move as fast as the inflow
    way = np.where(n < 0.0, -1.0, 1.0)
    theta = np.arctan2(way * flow, np.abs(n))
    alpha = PITCH - theta
    push = np.sin(2.0 * alpha) * np.cos(theta) - GLIDE * np.sin(alpha) ** 2 * np.sin(theta)
    return np.asarray(way * (n * n + flow * flow) * push / np.sin(2.0 * PITCH))


class OpenWater:
    """The sheet's open-water curves as tables over the advance ratio, where it states any."""

    def __init__(self, sheet: Sheet) -> None:
        self.there = bool(np.any(sheet.advance))
        self.diameter = sheet.diameter
        powers = np.stack([TABLE, TABLE**2, TABLE**3])
        self.rows: Array = 1.0 + sheet.advance @ powers

    def factor(self, n: Array, axial: Array) -> Array:
        """(N,): thrust over that at rest."""
        rev = n / 60.0
        j = axial * rev / (self.diameter * (rev * rev + 1e-9))
        return np.array([np.interp(x, TABLE, self.rows[int(speed < 0.0), i]) for i, (x, speed) in enumerate(zip(j, n, strict=True))])


class Drives:
    """Shaft speeds that follow their set-points: first order, and no faster than a slew limit."""

    def __init__(self, sheet: Sheet, rng: np.random.Generator) -> None:
        many = len(sheet.units)
        tau = TAU_S[int(sheet.mass > 200.0)]
        self.tau = tau * (1.0 + 0.15 * rng.uniform(-1.0, 1.0, many))
        self.slew = sheet.rpm_limit / (SLEW_S * tau / TAU_S[1])
        self.n = np.zeros(many)
        self.wanted = np.zeros(many)  # set-points, rpm

    def after(self, dt: float) -> Array:
        """Speeds (rpm) after ``dt`` seconds from now."""
        change = (self.wanted - self.n) * -np.expm1(-dt / self.tau)
        return np.asarray(self.n + np.clip(change, -self.slew * dt, self.slew * dt))
