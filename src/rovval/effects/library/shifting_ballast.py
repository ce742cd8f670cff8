"""Ballast or a liquid that shifts to the lower side as the vehicle tilts."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

MOMENT = "0.5 kg that slides by 0.1 m (chosen)"

EFFECT = Effect(
    name="shifting_ballast",
    title="Ballast or liquid that shifts",
    place="wrench",
    equation="a weight moves along the body's deck to the lower side: M = r x W e, with W r = (ahead e_x / sqrt(e_x^2 + slope^2), "
    "across e_y / sqrt(e_y^2 + slope^2), 0). It is where the tilt of the moment has it: neither its mass nor the time that it takes is modelled.",
    symbols={
        "M": "moment about the origin, body axes; N m",
        "r": "how far the weight has moved, body axes; m",
        "W": "the weight; N",
        "e": "unit vector down, body axes",
        "ahead, across": "weight times half of its way from stern to bow, and from port to starboard; N m",
        "slope": "sine of the tilt at which it has gone 0.7 of that: small for what slides from end to end, large for a liquid in a wide tank",
    },
    parameters=(
        Parameter("ahead", "N m", 0.0, 20.0, 0.0, 0.5, MOMENT, "weight", vanishes_at="low"),
        Parameter("across", "N m", 0.0, 20.0, 0.0, 0.5, MOMENT, "weight", vanishes_at="low"),
        Parameter("slope", "1", 0.01, 1.0, 0.2, 0.2, "1 to 90 degrees (chosen)", role="extent", starts=(0.03, 0.3)),
    ),
    signature="tilts are larger than the righting moment allows, and slow to come back: it stands low on one side, then on the other",
    confused_with=("cg_offset", "inertia_error", "attitude_bias"),
    separates="tilt to both sides, a little and a lot: a displaced centre of gravity stays on its side, and its height acts alike at all tilts",
    separable=True,
    literature=("Biran 2003, chapter 6: free surfaces of liquids, shifting loads", "Fossen 2021, section 4.1: restoring forces of submerged vehicles"),
)
ROWS = ("ahead", "across", "square")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Moments, and the square of the slope."""
    return {"ahead": p["ahead"], "across": p["across"], "square": p["slope"] ** 2}


def wrench(ahead: Number, across: Number, square: Number, r31: Number, r32: Number, r33: Number) -> tuple[Number, ...]:
    """Moment of the weight that has moved."""
    dx, dy = ahead * r31 / sqrt(r31 * r31 + square), across * r32 / sqrt(r32 * r32 + square)
    return 0.0, 0.0, 0.0, dy * r33, -dx * r33, dx * r32 - dy * r31
