"""A thruster in another one's jet loses thrust."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_interaction",
    title="Thruster in another's jet",
    place="input",
    equation="T_i <- T_i - loss w_ij |n_j| k_i n_i, j upstream, w_ij from the geometry with the strongest pair at 1: jet with 10 % spread, "
    "tandem rule 0.75^((x/D)^(2/3)) (ABS DP guide; diagnosis.md A8). At equal speeds loss is the share that the strongest pair loses.",
    parameters=(Parameter("loss", "1", 0.0, 1.0, 0.0, 0.15, "0 to 50 % (diagnosis.md A8)"),),
    signature="a thruster is weak only while its neighbour runs one way",
    confused_with=("thruster_degraded", "hull_interaction", "inflow_loss"),
    separates="drive thrusters in pairs and alone",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant knows the pairs."""
    return replace(lanes, wake=lanes.wake + p["loss"])
