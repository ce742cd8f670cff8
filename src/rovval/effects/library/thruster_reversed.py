"""One thruster turns the wrong way: swapped wires, a sign in a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_reversed",
    title="Thruster reversed",
    place="input",
    equation="T_i(n) <- (1 - fraction) T_i(n) + fraction T_i(-n) at rest in the water: 1 is a shaft that turns the other way (not -T_i: the gains "
    "differ), and nothing between 0 and 1 is physical (diagnosis.md A10).",
    parameters=(Parameter("fraction", "1", 0.0, 1.0, 0.0, 1.0, "discrete: 0 or 1"),),
    per="thruster",
    signature="twice that thruster's wrench, the wrong way",
    confused_with=("thruster_degraded", "thruster_misaligned"),
    separates="one step of that thruster alone",
    grid={"fraction": (1.0,)},
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Mix the gains with their opposites: T(-n) has the gain -k_neg ahead and -k_pos astern."""
    f = p["fraction"]
    ahead, astern = lanes.k_pos, lanes.k_neg
    return replace(lanes, k_pos=(1.0 - f) * ahead - f * astern, k_neg=(1.0 - f) * astern - f * ahead)
