"""Orbital motion of the water under a regular wave in deep water."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, exp, positive, sin
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="waves",
    title="Waves at the surface",
    place="water",
    equation="v = a omega exp(-k z) (cos(arg) along the wave, -sin(arg) down), arg = k (x cos(dir) + y sin(dir)) - omega t + phase, k = omega^2 / g; "
    "force (rho V + M_A) dv/dt and drag relative to the water.",
    symbols={
        "v": "orbital velocity of the water, north-east-down; m/s",
        "a": "amplitude of the surface; m",
        "omega": "angular frequency, 2 pi over the period; rad/s",
        "k": "wave number in deep water; 1/m",
        "x, y, z": "position north, east, down; m",
        "dir": "direction towards which the wave runs, from north; rad",
        "g": "gravity; m/s2",
        "rho V, M_A": "mass of the displaced water, added mass; kg",
    },
    parameters=(
        Parameter("amplitude", "m", 0.0, 3.0, 0.0, 0.2, "0 to 0.5 m for observation work (chosen)", role="amplitude"),
        Parameter("period", "s", 2.0, 20.0, 6.0, 2.0, "3 to 12 s: wind sea to swell (DNV 2010)", role="period", starts=(6.0,)),
        Parameter(
            "direction", "rad", -2.0 * np.pi, 2.0 * np.pi, 0.0, 1.5, "towards which it runs, from north; a turn to spare, so that no fit stops half-way",
            role="direction", starts=(-0.75 * np.pi, -0.25 * np.pi, 0.25 * np.pi, 0.75 * np.pi),
        ),
        Parameter("phase", "rad", -2.0 * np.pi, 2.0 * np.pi, 0.0, 1.5, "any; the same", role="phase", starts=(0.0, np.pi / 2)),
    ),
    signature="a narrow band of frequencies in surge, sway and heave, 90 degrees apart, dying out with depth as exp(-k z)",
    confused_with=("current_varying", "tether_tension"),
    separates="the same station at two depths; the spectrum",
    literature=(
        "Faltinsen 1990, table 2.1: regular waves in deep water (Airy)",
        "DNV 2010, section 3.3: wave periods",
        "Longuet-Higgins 1984: a sea comes in groups, so its amplitude wanders",
    ),
    needs=("z",),
    wanders=True,
)
ROWS = ("velocity", "omega", "k", "north", "east", "phase")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Orbital speed at the surface, frequency and wave number."""
    omega = 2.0 * np.pi / p["period"]
    k = omega**2 / lanes.vehicle.water.gravity
    return {
        "velocity": p["amplitude"] * omega,
        "omega": omega,
        "k": k,
        "north": np.cos(p["direction"]),
        "east": np.sin(p["direction"]),
        "phase": p["phase"],
    }


def water(
    velocity: Number, omega: Number, k: Number, north: Number, east: Number, phase: Number,
    x: Number, y: Number, z: Number, t: Number, vn: Number, ve: Number, vd: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Velocity of the water, its change along the vehicle's path and at a fixed point."""
    angle = k * (north * x + east * y) - omega * t + phase
    size = velocity * exp(-k * positive(z))
    c, s = size * cos(angle), size * sin(angle)
    turn, sink = k * (north * vn + east * ve) - omega, -k * vd
    along, down = -s * turn + c * sink, -c * turn - s * sink
    here, below = s * omega, c * omega
    return north * c, east * c, -s, north * along, east * along, down, north * here, east * here, below
