"""The current that the wind drives near the surface, as the thesis's further work asks for (7.2)."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, positive
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

FACTOR = 0.02  # of the wind's speed at 10 m, at the surface: DNV-RP-C205, 4.1.4 has 0.015 to 0.03

EFFECT = Effect(
    name="wind_current",
    title="Current driven by the wind",
    place="water",
    equation="v_c = 0.02 U_10 positive(reach - z) / reach above the depth reach, its change along the path -0.02 U_10 (dz/dt) / reach there; the still "
    "water's surface at z = 0.",
    symbols={
        "v_c": "horizontal velocity of the water (north, east); m/s",
        "U_10": "velocity of the wind 10 m above the sea (north, east), the way it blows; m/s",
        "z": "the vehicle's depth, down; m",
        "reach": "depth at which nothing is left of it; m",
    },
    parameters=(
        Parameter("north", "m/s", -50.0, 50.0, 0.0, 8.0, "DNV-RP-C205, 4.1.4: any wind; 8 m/s is the mean of the North Sea (chosen)"),
        Parameter("east", "m/s", -50.0, 50.0, 0.0, 8.0, "as north"),
        Parameter("reach", "m", 5.0, 200.0, 50.0, 20.0, "DNV-RP-C205, 4.1.4: 50 m", role="extent"),
    ),
    signature="a current that fades with depth, by a few per cent of the wind",
    confused_with=("current_shear", "current_constant", "waves"),
    separates="a dive up and down, and the day's wind",
    literature=("DNV 2010, section 4.1: current profiles", "thesis, section 7.2"),
    needs=("z",),
    competes=False,
)
ROWS = ("north", "east", "inverse")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Velocity of the water at the surface, and the inverse of its reach."""
    return {"north": FACTOR * p["north"], "east": FACTOR * p["east"], "inverse": 1.0 / p["reach"]}


def water(north: Number, east: Number, inverse: Number, z: Number, vd: Number) -> tuple[Number, ...]:
    """Velocity of the water and its change along the path; nothing of either below its reach."""
    left = positive(1.0 - z * inverse)
    fades = -vd * inverse * (left / (left + 1e-12))
    return north * left, east * left, 0.0, north * fades, east * fades, 0.0, 0.0, 0.0, 0.0
