"""A steady current, the same everywhere."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SOURCE = "0 to 1 m/s: a work-class ROV's own top speed is about twice that (diagnosis.md E1)"

EFFECT = Effect(
    name="current_constant",
    title="Constant current",
    place="water",
    equation="nu_r = nu - [R^T v_c; 0], dnu_c/dt = [-S(omega) R^T v_c; 0] (Fossen 2021, 10.140 to 10.144: irrotational).",
    parameters=(
        Parameter("north", "m/s", -2.0, 2.0, 0.0, 0.15, SOURCE),
        Parameter("east", "m/s", -2.0, 2.0, 0.0, 0.15, SOURCE),
        Parameter("down", "m/s", -0.5, 0.5, 0.0, 0.03, "upwelling and stratification: an order below the horizontal"),
    ),
    signature="a body force that turns with the heading, as its cosine and sine; needs velocity over ground",
    confused_with=("tether_tension", "tether_drag", "current_shear", "compass_deviation", "cg_offset"),
    separates="two headings 90 degrees apart, or a full turn",
)
ROWS = ("north", "east", "down")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The current itself."""
    return {name: p[name] for name in ROWS}


def water(north: Number, east: Number, down: Number) -> tuple[Number, ...]:
    """Velocity of the water; it changes neither along the path nor in time."""
    return north, east, down, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
