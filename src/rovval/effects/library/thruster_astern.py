"""One thruster's gain astern is off by itself: a tolerance of every thruster, no diagnosis of its own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_astern",
    title="One thruster's thrust astern",
    place="input",
    equation="k_neg,i <- (1 + scale) k_neg,i; k_pos,i as it is.",
    symbols={
        "k_pos, k_neg": "thrust over the square of the shaft speed, turning ahead and astern; N s2",
        "i": "the thruster that the parameter belongs to",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.9, 2.0, 0.0, 0.15, "as reverse_asymmetry", vanishes_at="low",
            tolerance=Tolerance(1.4, "ahead and astern are two numbers of the file, each off by the tolerance, so apart by the root of two times it"),
        ),
    ),
    per="thruster",
    signature="a small steady wrench whenever that thruster runs astern",
    confused_with=("reverse_asymmetry", "thruster_degraded"),
    separates="equal steps both ways of that thruster alone",
    literature=("Bachmayer 2000: thrust in all four quadrants", "Blue Robotics T200: thrust ahead and astern"),
    competes=False,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the gain astern."""
    return replace(lanes, k_neg=(1.0 + p["scale"]) * lanes.k_neg)
