"""One thruster gives less thrust than its speed says: fouled, worn, damaged or dead."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_degraded",
    title="Thruster degraded",
    place="input",
    equation="T_i <- (1 - loss) T_i (diagnosis.md A1). A negative loss is a thruster that is better than the file says.",
    parameters=(Parameter("loss", "1", -0.5, 1.0, 0.0, 0.2, "0 to 1 (diagnosis.md A1)"),),
    per="thruster",
    signature="a wrench in that thruster's own direction, growing with its thrust",
    confused_with=("thruster_misaligned", "thruster_fault_onset", "reverse_asymmetry", "hull_interaction"),
    separates="drive that thruster apart from the others",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale both gains."""
    left = 1.0 - p["loss"]
    return replace(lanes, k_pos=left * lanes.k_pos, k_neg=left * lanes.k_neg)
