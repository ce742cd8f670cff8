"""One thruster gives less thrust than its speed says: fouled, worn, damaged or dead."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thruster_degraded",
    title="Thruster degraded",
    place="input",
    equation="T_i <- (1 - loss) T_i. A negative loss is a thruster that is better than the file says.",
    symbols={"T_i": "thrust of thruster i, along its axis; N", "loss": "share of it that is lost; 1 is a dead thruster"},
    parameters=(
        Parameter(
            "loss", "1", -1.0, 1.0, 0.0, 0.2, "0: sound, 1: dead, -1: twice what the file says", vanishes_at="high",
            tolerance=Tolerance(1.0, "the declared calibration tolerance itself"),
        ),
    ),
    per="thruster",
    signature="a wrench in that thruster's own direction, growing with its thrust",
    confused_with=("thruster_misaligned", "thruster_fault_onset", "reverse_asymmetry", "hull_interaction"),
    separates="drive that thruster apart from the others",
    literature=(
        "Alessandri 1999: actuator faults of underwater vehicles",
        "Omerdic and Roberts 2004: faults of thrusters of open-frame vehicles, partial and total",
    ),
    family="thrust",
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale both gains."""
    left = 1.0 - p["loss"]
    return replace(lanes, k_pos=left * lanes.k_pos, k_neg=left * lanes.k_neg)
