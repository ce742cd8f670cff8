"""A current that grows with depth."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SHEAR = "0 to 0.1 1/s (chosen); across a salt wedge up to 1"
SPEED = "as `current_constant`, which it is without the shear"
AT_DEPTH = ("north_at_depth", "east_at_depth", "down_at_depth")

EFFECT = Effect(
    name="current_shear",
    title="Current sheared with depth",
    place="water",
    equation="v_c = (north_at_depth, east_at_depth, down_at_depth) + (north, east, 0) (z - depth), its change along the path (north, east, 0) dz/dt.",
    symbols={
        "v_c": "velocity of the water (north, east, down); m/s",
        "z": "the vehicle's depth, down; m",
        "depth": "depth from which that is counted; m",
        "north, east": "change of the velocity with depth; 1/s",
        "north_at_depth, east_at_depth, down_at_depth": "velocity of the water at that depth; m/s",
    },
    parameters=(
        Parameter("north", "1/s", -1.0, 1.0, 0.0, 0.02, SHEAR),
        Parameter("east", "1/s", -1.0, 1.0, 0.0, 0.02, SHEAR),
        Parameter("north_at_depth", "m/s", -2.0, 2.0, 0.0, 0.15, SPEED),
        Parameter("east_at_depth", "m/s", -2.0, 2.0, 0.0, 0.15, SPEED),
        Parameter("down_at_depth", "m/s", -0.5, 0.5, 0.0, 0.03, SPEED),
        Parameter("depth", "m", -1000.0, 12000.0, 0.0, 1.0, "where the water has that velocity: the log's mean depth", role="level"),
    ),
    signature="a body force that grows with depth and turns with the heading",
    confused_with=("current_constant", "density_gradient", "tether_drag"),
    separates="a dive up and down, at two headings",
    literature=("DNV 2010, section 4.1: current profiles", "Fossen 2021, section 10.3: currents that vary with depth"),
    refines=AT_DEPTH,
    needs=("z",),
)
ROWS = ("north", "east", *AT_DEPTH, "depth")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The shear, and the velocity at a depth."""
    return {name: p[name] for name in ROWS}


def water(
    north: Number, east: Number, north_at_depth: Number, east_at_depth: Number, down_at_depth: Number, depth: Number, z: Number, vd: Number
) -> tuple[Number, ...]:
    """Velocity of the water and its change along the path."""
    return north_at_depth + north * (z - depth), east_at_depth + east * (z - depth), down_at_depth, north * vd, east * vd, 0.0, 0.0, 0.0, 0.0
