"""Thrusters give nothing below some speed."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes
from rovval.effects._scalar import Number, positive

EFFECT = Effect(
    name="thruster_deadband",
    title="Dead band of the thrusters",
    place="input",
    equation="n <- sgn(n) max(|n| - width, 0) on the acting speed of every thruster (diagnosis.md A3; Bessa 2006).",
    parameters=(
        Parameter("width", "rev/s", 0.0, 60.0, 0.0, 2.5, "0 to 12 % of full command; T200: 300 rpm (diagnosis.md A3); searched to full speed", "speed"),
    ),
    signature="small commands do nothing: hunting about a hover, weak answers to small steps",
    confused_with=("rpm_scale", "linear_drag", "reverse_asymmetry"),
    separates="steps of small amplitude beside large ones",
    grid={"width": (1.0, 4.0)},
)
ROWS = ("width",)
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The width."""
    return {"width": p["width"]}


def acting(width: Number, n: Number) -> Number:
    """Speed that acts."""
    return positive(n - width) - positive(-n - width)
