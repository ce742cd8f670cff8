"""The tether pulls in a fixed direction."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes
from rovval.effects._scalar import Number

PULL = "0 to 30 N on an observation-class vehicle, up to 2.7 kN on a work-class one (diagnosis.md T2)"

EFFECT = Effect(
    name="tether_tension",
    title="Steady pull of the tether",
    place="wrench",
    equation="F = R^T (north, east, down) at the attachment (x, 0, z): tension of a tether that leads far away (diagnosis.md T2).",
    parameters=(
        Parameter("north", "N", -100.0, 100.0, 0.0, 6.0, PULL, "weight"),
        Parameter("east", "N", -100.0, 100.0, 0.0, 6.0, PULL, "weight"),
        Parameter("down", "N", -100.0, 100.0, 0.0, 4.0, PULL, "weight"),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.3, "attachment, ahead of the origin"),
        Parameter("z", "m", -2.0, 2.0, 0.0, 0.2, "attachment, below the origin"),
    ),
    signature="a force fixed to north and east, also when the vehicle lies still; a moment if it is attached aft",
    confused_with=("current_constant", "buoyancy_error", "cg_offset"),
    separates="a current's force depends on the vehicle's own speed, a pull's does not: two speeds on two headings",
    levers=("x", "z"),
)
ROWS = ("north", "east", "down", "ax", "az")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Pull and attachment."""
    return {"north": p["north"], "east": p["east"], "down": p["down"], "ax": p["x"], "az": p["z"]}


def wrench(
    north: Number, east: Number, down: Number, ax: Number, az: Number,
    r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """The pull in the body frame and its moment."""
    fx = r11 * north + r21 * east + r31 * down
    fy = r12 * north + r22 * east + r32 * down
    fz = r13 * north + r23 * east + r33 * down
    return fx, fy, fz, -az * fy, az * fx - ax * fz, ax * fy
