"""Thrusters give nothing below some speed."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, positive
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_deadband",
    title="Dead band of the thrusters",
    place="input",
    equation="n <- sgn(n) min((1 + catch) max(|n| - width, 0), |n|) on the acting speed of every thruster (diagnosis.md A3; Bessa 2006); with catch, what "
    "is missing at the edge of the band is made up beyond it.",
    parameters=(
        Parameter("width", "rev/s", 0.0, 60.0, 0.0, 2.5, "0 to 12 % of full command; T200: 300 rpm (diagnosis.md A3); searched to full speed", "speed"),
        Parameter("catch", "1", 0.0, 30.0, 0.0, 1.0, "0: a dead band of the drive, all along; else one of low flow, caught up with at 1 + 1 / catch widths"),
    ),
    signature="small commands do nothing: hunting about a hover, weak answers to small steps",
    confused_with=("rpm_scale", "linear_drag", "reverse_asymmetry"),
    separates="steps of small amplitude beside large ones",
    grid={"width": (1.0, 4.0)},
    refines=("catch",),
)
ROWS = ("width", "catch")
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The width, and how soon it is made up for."""
    return {"width": p["width"], "catch": p["catch"]}


def acting(width: Number, catch: Number, n: Number) -> Number:
    """Speed that acts: what is beyond the band, and no more than there is."""
    ahead, astern = (1.0 + catch) * positive(n - width), (1.0 + catch) * positive(-n - width)
    return ahead - positive(ahead - positive(n)) - astern + positive(astern - positive(-n))
