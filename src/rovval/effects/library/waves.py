"""Orbital motion of the water under a regular wave in deep water, or a sea of several that run the same way."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, exp, positive, sin
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

TRAINS = (2, 3, 4, 5, 6, 7, 8)
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
            for i in TRAINS
            for parameter in (
                Parameter(f"cosine_{i}", "m", -3.0, 3.0, 0.0, 0.2, SEA),
                Parameter(f"sine_{i}", "m", -3.0, 3.0, 0.0, 0.2, SEA),
                Parameter(f"period_{i}", "s", 2.0, 20.0, 6.0, 2.0, "as period", role="further period"),
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
    refines=tuple(f"{name}_{i}" for i in TRAINS for name in ("cosine", "sine", "period")),
)
ROWS = ("north", "east", *(f"{row}{i}" for i in ("", *TRAINS) for row in ("a", "b", "omega", "k")))


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Direction; and of each train orbital speeds at the surface, frequency and wave number."""
    found = {"north": np.cos(p["direction"]), "east": np.sin(p["direction"])}
    for i, suffix in (("", ""), *((i, f"_{i}") for i in TRAINS)):
        omega = 2.0 * np.pi / p[f"period{suffix}"]
        found |= {f"a{i}": p[f"cosine{suffix}"] * omega, f"b{i}": p[f"sine{suffix}"] * omega}
        found |= {f"omega{i}": omega, f"k{i}": omega**2 / lanes.vehicle.water.gravity}
    return found


def water(
    north: Number, east: Number,
    a: Number, b: Number, omega: Number, k: Number,
    a2: Number, b2: Number, omega2: Number, k2: Number,
    a3: Number, b3: Number, omega3: Number, k3: Number,
    a4: Number, b4: Number, omega4: Number, k4: Number,
    a5: Number, b5: Number, omega5: Number, k5: Number,
    a6: Number, b6: Number, omega6: Number, k6: Number,
    a7: Number, b7: Number, omega7: Number, k7: Number,
    a8: Number, b8: Number, omega8: Number, k8: Number,
    x: Number, y: Number, z: Number, t: Number, vn: Number, ve: Number, vd: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Velocity of the water, its change along the vehicle's path and at a fixed point, of all trains together: one after the other, since a kernel has no loops
    but its own."""
    ahead, speed, deep = north * x + east * y, north * vn + east * ve, positive(z)
    arg, size, turn = k * ahead - omega * t, exp(-k * deep), k * speed - omega
    c, s = size * (a * cos(arg) + b * sin(arg)), size * (a * sin(arg) - b * cos(arg))
    along, down = -s * turn - c * k * vd, s * k * vd - c * turn
    arg2, size2, turn2 = k2 * ahead - omega2 * t, exp(-k2 * deep), k2 * speed - omega2
    c2, s2 = size2 * (a2 * cos(arg2) + b2 * sin(arg2)), size2 * (a2 * sin(arg2) - b2 * cos(arg2))
    along2, down2 = -s2 * turn2 - c2 * k2 * vd, s2 * k2 * vd - c2 * turn2
    arg3, size3, turn3 = k3 * ahead - omega3 * t, exp(-k3 * deep), k3 * speed - omega3
    c3, s3 = size3 * (a3 * cos(arg3) + b3 * sin(arg3)), size3 * (a3 * sin(arg3) - b3 * cos(arg3))
    along3, down3 = -s3 * turn3 - c3 * k3 * vd, s3 * k3 * vd - c3 * turn3
    arg4, size4, turn4 = k4 * ahead - omega4 * t, exp(-k4 * deep), k4 * speed - omega4
    c4, s4 = size4 * (a4 * cos(arg4) + b4 * sin(arg4)), size4 * (a4 * sin(arg4) - b4 * cos(arg4))
    along4, down4 = -s4 * turn4 - c4 * k4 * vd, s4 * k4 * vd - c4 * turn4
    arg5, size5, turn5 = k5 * ahead - omega5 * t, exp(-k5 * deep), k5 * speed - omega5
    c5, s5 = size5 * (a5 * cos(arg5) + b5 * sin(arg5)), size5 * (a5 * sin(arg5) - b5 * cos(arg5))
    along5, down5 = -s5 * turn5 - c5 * k5 * vd, s5 * k5 * vd - c5 * turn5
    arg6, size6, turn6 = k6 * ahead - omega6 * t, exp(-k6 * deep), k6 * speed - omega6
    c6, s6 = size6 * (a6 * cos(arg6) + b6 * sin(arg6)), size6 * (a6 * sin(arg6) - b6 * cos(arg6))
    along6, down6 = -s6 * turn6 - c6 * k6 * vd, s6 * k6 * vd - c6 * turn6
    arg7, size7, turn7 = k7 * ahead - omega7 * t, exp(-k7 * deep), k7 * speed - omega7
    c7, s7 = size7 * (a7 * cos(arg7) + b7 * sin(arg7)), size7 * (a7 * sin(arg7) - b7 * cos(arg7))
    along7, down7 = -s7 * turn7 - c7 * k7 * vd, s7 * k7 * vd - c7 * turn7
    arg8, size8, turn8 = k8 * ahead - omega8 * t, exp(-k8 * deep), k8 * speed - omega8
    c8, s8 = size8 * (a8 * cos(arg8) + b8 * sin(arg8)), size8 * (a8 * sin(arg8) - b8 * cos(arg8))
    along8, down8 = -s8 * turn8 - c8 * k8 * vd, s8 * k8 * vd - c8 * turn8
    ground, fall = c + c2 + c3 + c4 + c5 + c6 + c7 + c8, s + s2 + s3 + s4 + s5 + s6 + s7 + s8
    met, met_down = along + along2 + along3 + along4 + along5 + along6 + along7 + along8, down + down2 + down3 + down4 + down5 + down6 + down7 + down8
    here = s * omega + s2 * omega2 + s3 * omega3 + s4 * omega4 + s5 * omega5 + s6 * omega6 + s7 * omega7 + s8 * omega8
    here_down = c * omega + c2 * omega2 + c3 * omega3 + c4 * omega4 + c5 * omega5 + c6 * omega6 + c7 * omega7 + c8 * omega8
    return north * ground, east * ground, -fall, north * met, east * met, met_down, north * here, east * here, here_down
