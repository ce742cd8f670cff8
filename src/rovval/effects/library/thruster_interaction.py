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
    equation="T_i <- T_i (1 - loss w_ij min(|n_j| / |n_i|, 1)), j upstream of the thruster i that the parameter belongs to: whose free jet "
    "reaches it, 10 % spread, weights w_ij by the tandem rule 0.75^((x/D)^(2/3)) (ABS DP guide; diagnosis.md A8) with the strongest at 1, or "
    "else its nearest neighbour. Linear in the jet's speed as inflow is (diagnosis.md A6); loss is the share lost once n_j reaches n_i.",
    parameters=(Parameter("loss", "1", 0.0, 1.0, 0.0, 0.15, "0 to 50 % (diagnosis.md A8)"),),
    per="thruster",
    signature="a thruster is weak only while its neighbour runs",
    confused_with=("thruster_degraded", "hull_interaction", "inflow_loss"),
    separates="drive the thruster with its neighbour and alone",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant knows the pairs."""
    return replace(lanes, wake=lanes.wake + p["loss"])
