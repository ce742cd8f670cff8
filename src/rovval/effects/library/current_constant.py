"""A steady current, the same everywhere."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SOURCE = "0 to 1 m/s (chosen): a work-class ROV's own top speed is about twice that"

EFFECT = Effect(
    name="current_constant",
    title="Constant current",
    place="water",
    equation="nu_r = nu - [R^T v_c; 0], dnu_c/dt = [-S(omega) R^T v_c; 0] (irrotational).",
    symbols={
        "nu": "velocity over ground, body axes; m/s, rad/s",
        "v_c": "velocity of the water (north, east, down); m/s",
        "R": "rotation from body axes to the north-east-down frame",
        "omega": "angular velocity p q r, body axes; rad/s; S(omega) its cross-product matrix",
        "nu_c": "velocity of the water in body axes; m/s",
    },
    parameters=(
        Parameter("north", "m/s", -2.0, 2.0, 0.0, 0.15, SOURCE),
        Parameter("east", "m/s", -2.0, 2.0, 0.0, 0.15, SOURCE),
        Parameter("down", "m/s", -0.5, 0.5, 0.0, 0.03, "upwelling and stratification: an order below the horizontal (chosen)"),
    ),
    signature="a body force that turns with the heading, as its cosine and sine; needs velocity over ground",
    confused_with=("tether_tension", "tether_drag", "current_shear", "compass_deviation", "cg_offset"),
    separates="two headings 90 degrees apart, or a full turn",
    literature=("Fossen 2021, equations 10.140 to 10.144: constant irrotational current", "DNV 2010, section 4.1: current velocities"),
)
ROWS = ("north", "east", "down")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The current itself."""
    return {name: p[name] for name in ROWS}


def water(north: Number, east: Number, down: Number) -> tuple[Number, ...]:
    """Velocity of the water; it changes neither along the path nor in time."""
    return north, east, down, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
