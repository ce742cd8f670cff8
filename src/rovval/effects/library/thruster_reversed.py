"""One thruster turns the wrong way: swapped wires, a sign in a table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

REVERSED_FROM = 0.625  # half-way by the speed of the shaft, whose square thrust goes by, from a dead thruster (0.5; `thruster_degraded`) to a reversed one (1)

EFFECT = Effect(
    name="thruster_reversed",
    title="Thruster reversed",
    place="input",
    equation="T_i(n) <- (1 - fraction) T_i(n) + fraction T_i(-n) at rest in the water: 1 is a shaft that turns the other way (not -T_i: the gains "
    "differ), and nothing between 0 and 1 is physical.",
    symbols={"T_i(n)": "thrust of thruster i at the shaft speed n, along its axis; N", "n": "shaft speed; rev/s", "fraction": "0: sound, 1: reversed"},
    parameters=(Parameter("fraction", "1", 0.0, 1.0, 0.0, 1.0, "discrete: 0 or 1", starts=(1.0,), genuine_from=REVERSED_FROM),),
    per="thruster",
    signature="twice that thruster's wrench, the wrong way",
    confused_with=("thruster_degraded", "thruster_misaligned"),
    separates="one step of that thruster alone",
    literature=("Fossen and Johansen 2006: thruster configuration matrix, whose sign it turns", "Bachmayer 2000: thrust in all four quadrants"),
    continues="thruster_degraded",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Mix the gains with their opposites: T(-n) has the gain -k_neg ahead and -k_pos astern."""
    f = p["fraction"]
    ahead, astern = lanes.k_pos, lanes.k_neg
    return replace(lanes, k_pos=(1.0 - f) * ahead - f * astern, k_neg=(1.0 - f) * astern - f * ahead)
