"""The tether is caught: beyond a slack radius round a point it pulls like a spring."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes
from rovval.effects._scalar import Number, positive, sqrt

EFFECT = Effect(
    name="tether_snag",
    title="Tether snagged",
    place="wrench",
    equation="F = -stiffness max(d - radius, 0) towards the point (north, east), d the horizontal distance to it, at the origin "
    "(diagnosis.md T3; EA (1 - l0/L) when taut).",
    parameters=(
        Parameter("stiffness", "N/m", 0.0, 200.0, 0.0, 10.0, "chosen: a few metres of stretch stop the vehicle", "weight"),
        Parameter("north", "m", -1000.0, 1000.0, 0.0, 10.0, "where it is caught, in the log's x"),
        Parameter("east", "m", -1000.0, 1000.0, 0.0, 10.0, "where it is caught, in the log's y"),
        Parameter("radius", "m", 0.0, 1000.0, 5.0, 5.0, "slack"),
    ),
    signature="a sudden pull that comes back at the same place and always points the same way there",
    confused_with=("tether_tension", "current_varying"),
    separates="come back to the place from another side",
    needs=("x", "y"),
    grid={"radius": (0.0, 5.0, 20.0), "north": (-10.0, 0.0, 10.0), "east": (-10.0, 0.0, 10.0)},
)
ROWS = ("stiffness", "north", "east", "radius")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The spring."""
    return {name: p[name] for name in ROWS}


def wrench(
    stiffness: Number, north: Number, east: Number, radius: Number, x: Number, y: Number,
    r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """The pull in the body frame."""
    dx, dy = x - north, y - east
    distance = sqrt(dx * dx + dy * dy + 1e-12)
    pull = -stiffness * positive(distance - radius) / distance
    fn, fe = pull * dx, pull * dy
    return r11 * fn + r21 * fe, r12 * fn + r22 * fe, r13 * fn + r23 * fe, 0.0, 0.0, 0.0
