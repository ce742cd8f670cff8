"""A tether that is wound up as the vehicle turns: a moment that turns it back."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="tether_torsion",
    title="Tether twisted",
    place="wrench",
    equation="N = -stiffness psi_t: the moment of a twisted rod. Twist from before the log, and that a tether wound up far slips or kinks, is not modelled.",
    symbols={
        "N": "moment of yaw, body axes; N m",
        "psi_t": "yaw since the log's start, whole turns counted; rad",
        "stiffness": "torsional stiffness of the free tether; N m/rad",
    },
    parameters=(
        Parameter("stiffness", "N m/rad", 0.0, 20.0, 0.0, 0.3, "a tenth of the largest yaw moment after a turn (chosen)", "weight", vanishes_at="low",
            needs="psi",
        ),
    ),
    signature="a yaw moment that grows with the turns made to one side, and goes as they are unwound",
    confused_with=("thruster_misaligned", "linear_drag", "compass_deviation"),
    separates="several turns to one side, stops at the same headings, and the same turns back",
    literature=("Buckham 2004: bending and torsion of slack tethers of underwater vehicles",),
    needs=("psi",),
)
ROWS = ("stiffness",)


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Stiffness."""
    return {"stiffness": p["stiffness"]}


def wrench(stiffness: Number, turned: Number) -> tuple[Number, ...]:
    """Moment of yaw."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, -stiffness * turned
