"""A current that grows with depth, on and on or through a layer beyond which it hardly changes."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SHEAR = "0 to 0.1 1/s (chosen); across a salt wedge up to 1"
SPEED = "as `current_constant`, which it is without the shear"
AT_DEPTH = ("north_at_depth", "east_at_depth", "down_at_depth")

EFFECT = Effect(
    name="current_shear",
    title="Current sheared with depth",
    place="water",
    equation="v_c = (north_at_depth, east_at_depth, down_at_depth) + (north, east, 0) h, h = x / sqrt(1 + curvature x^2), x = z - depth: a straight profile, "
    "or one that levels off above and below; its change along the path (north, east, 0) dh/dx dz/dt, of which the share pressing presses on the displaced "
    "water rho V: none where the flow is steady, all where it is taken as uniform on the scale of the vehicle.",
    symbols={
        "v_c": "velocity of the water (north, east, down); m/s",
        "pressing": "share of the water's change along the path that is taken as its acceleration; 1",
        "rho V": "mass of the displaced water; kg",
        "z": "the vehicle's depth, down; m",
        "depth": "depth from which that is counted; m",
        "curvature": "how soon it levels off, one over the square of half the layer's height; 1/m2",
        "north, east": "change of the velocity with depth at that depth; 1/s",
        "north_at_depth, east_at_depth, down_at_depth": "velocity of the water at that depth; m/s",
    },
    parameters=(
        Parameter("north", "1/s", -1.0, 1.0, 0.0, 0.02, SHEAR),
        Parameter("east", "1/s", -1.0, 1.0, 0.0, 0.02, SHEAR),
        Parameter("north_at_depth", "m/s", -2.0, 2.0, 0.0, 0.15, SPEED),
        Parameter("east_at_depth", "m/s", -2.0, 2.0, 0.0, 0.15, SPEED),
        Parameter("down_at_depth", "m/s", -0.5, 0.5, 0.0, 0.03, SPEED),
        Parameter("depth", "m", -1000.0, 12000.0, 0.0, 1.0, "where the water has that velocity: the log's mean depth", role="level"),
        Parameter("curvature", "1/m2", 0.0, 25.0, 0.0, 0.1, "a straight profile; a layer of some metres (chosen)", role="extent"),
        Parameter("pressing", "1", 0.0, 1.0, 0.0, 0.5, "0: Auton 1988; 1: a flow taken as uniform on the vehicle's scale", role="extent"),
    ),
    signature="a body force that grows with depth and turns with the heading",
    confused_with=("current_constant", "density_gradient", "tether_drag"),
    separates="a dive up and down, at two headings",
    literature=(
        "DNV 2010, section 4.1: current profiles",
        "Fossen 2021, section 10.3: currents that vary with depth",
        "Auton 1988: the force on a body in a flow that is not uniform",
    ),
    refines=(*AT_DEPTH, "curvature", "pressing"),
    needs=("z",),
)
ROWS = ("north", "east", *AT_DEPTH, "depth", "curvature", "pressing")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The shear, its profile and the velocity at a depth."""
    return {name: p[name] for name in ROWS}


def water(
    north: Number, east: Number, north_at_depth: Number, east_at_depth: Number, down_at_depth: Number, depth: Number, curvature: Number, pressing: Number,
    z: Number, vd: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Velocity of the water and its change along the path."""
    x = z - depth
    steep = 1.0 / sqrt(1.0 + curvature * x * x)
    h, slope = x * steep, steep * steep * steep * vd
    n, e = north * slope, east * slope
    return north_at_depth + north * h, east_at_depth + east * h, down_at_depth, n, e, 0.0, pressing * n, pressing * e, 0.0
