"""Something is dragged over the bottom: a clump, a chain, slack tether that lies there."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

SLOW = 0.03  # m/s: below it friction falls with the speed, as that of a load on a line that gives a little does (chosen)

EFFECT = Effect(
    name="dragged_load",
    title="Load dragged over the bottom",
    place="wrench",
    equation="F = -force R^T V / sqrt(|V|^2 + (0.03 m/s)^2) at the attachment (x, 0, z), V the horizontal velocity over ground: dry friction, of one size "
    "whatever the speed.",
    symbols={
        "F": "force, body axes; N",
        "force": "friction of what is dragged; N",
        "V": "velocity over ground, north and east; m/s",
        "R": "rotation from body axes to the north-east-down frame",
        "x, z": "attachment ahead of and below the origin, body axes; m",
    },
    parameters=(
        Parameter("force", "N", 0.0, 100.0, 0.0, 4.0, "as a tether's pull: up to 30 N on an observation-class vehicle (chosen)", "weight", vanishes_at="low"),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.3, "attachment, ahead of the origin", role="lever"),
        Parameter("z", "m", -2.0, 2.0, 0.0, 0.2, "attachment, below the origin", role="lever"),
    ),
    signature="a force against the way over ground that is as large at low speed as at high speed; none that holds the vehicle where it stands",
    confused_with=("linear_drag", "quadratic_drag", "tether_drag"),
    separates="drag falls with the speed, friction does not: creep and cruise along one line",
    wanders=True,  # what lies on the bottom changes with the way (chosen)
    literature=("Armstrong-Helouvry 1994: Coulomb friction and its smooth models",),
)
ROWS = ("force", "ax", "az")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Friction and attachment."""
    return {"force": p["force"], "ax": p["x"], "az": p["z"]}


def wrench(
    force: Number, ax: Number, az: Number, vn: Number, ve: Number, r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number
) -> tuple[Number, ...]:
    """Friction in the body frame and its moment."""
    scale = -force / sqrt(vn * vn + ve * ve + SLOW * SLOW)
    fn, fe = scale * vn, scale * ve
    fx, fy, fz = r11 * fn + r21 * fe, r12 * fn + r22 * fe, r13 * fn + r23 * fe
    return fx, fy, fz, -az * fy, az * fx - ax * fz, ax * fy
