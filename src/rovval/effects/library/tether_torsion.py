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
    equation="N = steady - stiffness psi_t: the moment of a twisted rod. That a tether wound up far slips or kinks is not modelled.",
    symbols={
        "N": "moment of yaw, body axes; N m",
        "psi_t": "yaw since the log's start, whole turns counted; rad",
        "stiffness": "torsional stiffness of the free tether; N m/rad",
        "steady": "moment of the twist that was there at the log's start; N m",
    },
    parameters=(
        Parameter("stiffness", "N m/rad", 0.0, 20.0, 0.0, 0.3, "a tenth of the largest yaw moment after a turn (chosen)", "weight", vanishes_at="low"),
        Parameter("steady", "N m", -20.0, 20.0, 0.0, 1.0, "some turns of that (chosen)", "weight"),
    ),
    signature="a yaw moment that grows with the turns made to one side, and goes as they are unwound",
    confused_with=("thruster_misaligned", "linear_drag", "compass_deviation"),
    separates="several turns to one side, stops at the same headings, and the same turns back",
    literature=("Buckham 2004: bending and torsion of slack tethers of underwater vehicles",),
    needs=("psi",),
    refines=("steady",),
)
ROWS = ("stiffness", "steady")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Stiffness and first moment."""
    return {name: p[name] for name in ROWS}


def wrench(stiffness: Number, steady: Number, turned: Number) -> tuple[Number, ...]:
    """Moment of yaw."""
    return 0.0, 0.0, 0.0, 0.0, 0.0, steady - stiffness * turned
