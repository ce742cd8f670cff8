"""Orbital motion of the water under a regular wave in deep water, or a swell of a few that run the same way."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, exp, positive, sin
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

TRAINS = (2, 3)
SEA = "as amplitude: a sea is no regular wave, its spectrum has a width"

EFFECT = Effect(
    name="waves",
    title="Waves at the surface",
    place="water",
    equation="v = a omega exp(-k z) (cos(arg) along the wave, -sin(arg) down), arg = k (x cos(dir) + y sin(dir)) - omega t + phase, k = omega^2 / g; "
    "force (rho V + M_A) dv/dt and drag relative to the water. Two further trains add to it, of surface cosine_i cos(arg_i) + sine_i sin(arg_i), phase 0.",
    symbols={
        "v": "orbital velocity of the water, north-east-down; m/s",
        "a": "amplitude of the surface; m",
        "cosine_i, sine_i": "amplitudes of a further train of the same direction, period_i; m",
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
        *(
            parameter
            for i in TRAINS
            for parameter in (
                Parameter(f"cosine_{i}", "m", -3.0, 3.0, 0.0, 0.2, SEA),
                Parameter(f"sine_{i}", "m", -3.0, 3.0, 0.0, 0.2, SEA),
                Parameter(f"period_{i}", "s", 2.0, 20.0, 6.0, 2.0, "as period", role="further period"),
            )
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
    refines=tuple(f"{name}_{i}" for i in TRAINS for name in ("cosine", "sine", "period")),
)
ROWS = ("velocity", "omega", "k", "north", "east", "phase", "a2", "b2", "omega2", "k2", "a3", "b3", "omega3", "k3")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Orbital speed at the surface, frequency and wave number."""
    omega, omega2, omega3 = (2.0 * np.pi / p[period] for period in ("period", "period_2", "period_3"))
    k, k2, k3 = (rate**2 / lanes.vehicle.water.gravity for rate in (omega, omega2, omega3))
    trains = {"a2": p["cosine_2"] * omega2, "b2": p["sine_2"] * omega2, "a3": p["cosine_3"] * omega3, "b3": p["sine_3"] * omega3}
    return trains | {
        "omega2": omega2,
        "omega3": omega3,
        "k2": k2,
        "k3": k3,
        "velocity": p["amplitude"] * omega,
        "omega": omega,
        "k": k,
        "north": np.cos(p["direction"]),
        "east": np.sin(p["direction"]),
        "phase": p["phase"],
    }


def water(
    velocity: Number, omega: Number, k: Number, north: Number, east: Number, phase: Number,
    a2: Number, b2: Number, omega2: Number, k2: Number, a3: Number, b3: Number, omega3: Number, k3: Number,
    x: Number, y: Number, z: Number, t: Number, vn: Number, ve: Number, vd: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Velocity of the water, its change along the vehicle's path and at a fixed point: of each train and in all."""
    ahead, speed, deep = north * x + east * y, north * vn + east * ve, positive(z)
    angle, angle2, angle3 = k * ahead - omega * t + phase, k2 * ahead - omega2 * t, k3 * ahead - omega3 * t
    size, size2, size3 = velocity * exp(-k * deep), exp(-k2 * deep), exp(-k3 * deep)
    turn, turn2, turn3 = k * speed - omega, k2 * speed - omega2, k3 * speed - omega3
    c, s = size * cos(angle), size * sin(angle)
    cos2, sin2, cos3, sin3 = cos(angle2), sin(angle2), cos(angle3), sin(angle3)
    c2, s2 = size2 * (a2 * cos2 + b2 * sin2), size2 * (a2 * sin2 - b2 * cos2)
    c3, s3 = size3 * (a3 * cos3 + b3 * sin3), size3 * (a3 * sin3 - b3 * cos3)
    ground, fall = c + c2 + c3, s + s2 + s3
    along = -s * turn - s2 * turn2 - s3 * turn3 - (c * k + c2 * k2 + c3 * k3) * vd
    down = -c * turn - c2 * turn2 - c3 * turn3 + (s * k + s2 * k2 + s3 * k3) * vd
    here, below = s * omega + s2 * omega2 + s3 * omega3, c * omega + c2 * omega2 + c3 * omega3
    return north * ground, east * ground, -fall, north * along, east * along, down, north * here, east * here, below
