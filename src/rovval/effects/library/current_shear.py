"""A current that grows with depth."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SOURCE = "0 to 0.1 1/s (chosen); across a salt wedge up to 1"

EFFECT = Effect(
    name="current_shear",
    title="Current sheared with depth",
    place="water",
    equation="v_c = (north, east) (z - depth), its change along the path (north, east) dz/dt.",
    symbols={
        "v_c": "horizontal velocity of the water (north, east); m/s",
        "z": "the vehicle's depth, down; m",
        "depth": "depth at which the sheared part is zero; m",
        "north, east": "change of the velocity with depth; 1/s",
    },
    parameters=(
        Parameter("north", "1/s", -1.0, 1.0, 0.0, 0.02, SOURCE),
        Parameter("east", "1/s", -1.0, 1.0, 0.0, 0.02, SOURCE),
        Parameter("depth", "m", -10.0, 6000.0, 0.0, 10.0, "where the shear's part is zero: set it to the log's mean depth", role="datum"),
    ),
    signature="a body force that grows with depth and turns with the heading",
    confused_with=("current_constant", "density_gradient", "tether_drag"),
    separates="a dive up and down, at two headings",
    literature=("DNV 2010, section 4.1: current profiles", "Fossen 2021, section 10.3: currents that vary with depth"),
    needs=("z",),
)
ROWS = ("north", "east", "depth")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The shear and its datum."""
    return {name: p[name] for name in ROWS}


def water(north: Number, east: Number, depth: Number, z: Number, vd: Number) -> tuple[Number, ...]:
    """Velocity of the water and its change along the path."""
    return north * (z - depth), east * (z - depth), 0.0, north * vd, east * vd, 0.0, 0.0, 0.0, 0.0
