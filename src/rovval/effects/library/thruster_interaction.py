"""A thruster in another one's jet loses thrust."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_interaction",
    title="Thruster in another's jet",
    place="input",
    equation="T_i <- T_i (1 - loss w_ij min(|n_j| / |n_i|, 1)), j upstream of i: whose free jet reaches it, 10 % spread, weights w_ij by the tandem rule "
    "0.75^((x/D)^(2/3)) with the strongest at 1, or else its nearest neighbour. Linear in the jet's speed, as inflow is; loss is the share lost once "
    "n_j reaches n_i.",
    symbols={
        "T_i": "thrust of the thruster that the parameter belongs to, along its axis; N",
        "n_i, n_j": "shaft speeds of it and of the one upstream; rev/s",
        "x": "distance between the two along the jet; m",
        "D": "propeller diameter; m",
        "w_ij": "weight of thruster j's jet on thruster i; 1",
    },
    parameters=(
        Parameter(
            "loss", "1", 0.0, 1.0, 0.0, 0.15, "0 to 50 % (chosen; a tandem pair loses up to 100 % at no distance, Dang and Laheij 2004)",
            vanishes_at="high",
        ),
    ),
    per="thruster",
    signature="a thruster is weak only while its neighbour runs",
    confused_with=("thruster_degraded", "hull_interaction", "inflow_loss"),
    separates="drive the thruster with its neighbour and alone",
    literature=(
        "Dang and Laheij 2004: thrust of thrusters in tandem",
        "ABS 2013: the tandem rule in a class guide",
        "Lehn 1980: thrusters in one another's jets",
    ),
)
FULL_KERNEL = True


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant knows the pairs."""
    return replace(lanes, wake=lanes.wake + p["loss"])
