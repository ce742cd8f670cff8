"""Orbital motion of the water under a regular wave in deep water, or a sea of several that run the same way."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, exp, positive, sin
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

COMPONENTS = ("", *(f"_{i}" for i in range(2, 9)))  # trains of waves
SEA = "as cosine: a sea is no regular wave, its spectrum has a width"

EFFECT = Effect(
    name="waves",
    title="Waves at the surface",
    place="water",
    equation="surface: cosine cos(arg) + sine sin(arg), arg = k (x cos(dir) + y sin(dir)) - omega t, k = omega^2 / g; velocity of the water: omega exp(-k z) "
    "times it along the wave, and times cosine sin(arg) - sine cos(arg) upwards. Further trains of cosine_i, sine_i and period_i add to it. Force "
    "(rho V + M_A) dv/dt and drag relative to the water.",
    symbols={
        "cosine, sine": "amplitudes of the surface of a train of waves, at the origin at the start; m",
        "cosine_i, sine_i, period_i": "of a further train that runs the same way; m, s",
        "omega": "angular frequency, 2 pi over the period; rad/s",
        "k": "wave number in deep water; 1/m",
        "x, y, z": "position north, east, down; m",
        "dir": "direction towards which the waves run, from north; rad",
        "g": "gravity; m/s2",
        "rho V, M_A": "mass of the displaced water, added mass; kg",
    },
    parameters=(
        Parameter("cosine", "m", -3.0, 3.0, 0.0, 0.2, "0 to 0.5 m of amplitude for observation work (chosen)"),
        Parameter("sine", "m", -3.0, 3.0, 0.0, 0.2, "as cosine"),
        Parameter("period", "s", 2.0, 20.0, 6.0, 2.0, "3 to 12 s: wind sea to swell (DNV 2010)", role="period", starts=(6.0,)),
        Parameter(
            "direction", "rad", -2.0 * np.pi, 2.0 * np.pi, 0.0, 1.5, "towards which it runs, from north; a turn to spare, so that no fit stops half-way",
            role="direction", starts=(-0.75 * np.pi, -0.25 * np.pi, 0.25 * np.pi, 0.75 * np.pi),
        ),
        *(
            parameter
            for train in COMPONENTS[1:]
            for parameter in (
                Parameter(f"cosine{train}", "m", -3.0, 3.0, 0.0, 0.2, SEA),
                Parameter(f"sine{train}", "m", -3.0, 3.0, 0.0, 0.2, SEA),
                Parameter(f"period{train}", "s", 2.0, 20.0, 6.0, 2.0, "as period", role="further period"),
            )
        ),
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
    refines=tuple(f"{name}{train}" for train in COMPONENTS[1:] for name in ("cosine", "sine", "period")),
)
ROWS = ("north", "east", *(f"{row}{train}" for train in COMPONENTS for row in ("a", "b", "omega", "k")))


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Direction; and of each train orbital speeds at the surface, frequency and wave number."""
    found = {"north": np.cos(p["direction"]), "east": np.sin(p["direction"])}
    for train in COMPONENTS:
        omega = 2.0 * np.pi / p[f"period{train}"]
        found |= {f"a{train}": p[f"cosine{train}"] * omega, f"b{train}": p[f"sine{train}"] * omega}
        found |= {f"omega{train}": omega, f"k{train}": omega**2 / lanes.vehicle.water.gravity}
    return found


def water(
    north: Number, east: Number, a: Number, b: Number, omega: Number, k: Number,
    x: Number, y: Number, z: Number, t: Number, vn: Number, ve: Number, vd: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Velocity of the water in one train, its change along the vehicle's path and at a fixed point."""
    arg = k * (north * x + east * y) - omega * t
    size = exp(-k * positive(z))
    c = size * (a * cos(arg) + b * sin(arg))
    s = size * (a * sin(arg) - b * cos(arg))
    turn = k * (north * vn + east * ve) - omega
    along, down = -s * turn - c * k * vd, s * k * vd - c * turn
    return north * c, east * c, -s, north * along, east * along, down, north * s * omega, east * s * omega, c * omega
