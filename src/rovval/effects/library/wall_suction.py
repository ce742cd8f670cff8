"""Moving along a wall the vehicle is drawn towards it."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="wall_suction",
    title="Suction of a wall alongside",
    place="wrench",
    equation="Y = gain u_r^2 / (1 + (d / reach)^2), with the sign of the side on which the wall lies in gain.",
    symbols={
        "Y": "force to starboard, body axes; N",
        "u_r": "velocity ahead relative to the water, body axes; m/s",
        "d": "measured distance of the wall; m",
        "reach": "distance at which half of it is left; m",
    },
    parameters=(
        Parameter("gain", "N s2/m2", -300.0, 300.0, 0.0, 20.0, "chosen: some tenths of the drag ahead; + for a wall to starboard", "drag"),
        Parameter("reach", "m", 0.01, 0.85, 0.085, 0.05, "chosen: up to twice the hull's length", "length", role="extent", starts=(0.05, 0.17)),
    ),
    signature="a sideways force that grows with speed ahead, near a wall only",
    confused_with=("current_constant", "cross_drag", "dvl_misalignment"),
    separates="the same leg nearer to and farther from the wall, and in the other direction",
    literature=(
        "Newman 1977, chapter 4: a body moving along a wall is drawn to it (method of images)",
        "JMSE 2025: an underwater vehicle near a wall, force by distance and speed",
    ),
    needs=("wall_distance",),
)
ROWS = ("gain", "inverse")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Force per square of speed, N s2/m2, and inverse reach, 1/m."""
    return {"gain": p["gain"], "inverse": 1.0 / p["reach"]}


def wrench(gain: Number, inverse: Number, wall_distance: Number, ur: Number) -> tuple[Number, ...]:
    """Sideways force."""
    near = wall_distance * inverse
    return 0.0, gain * ur * ur / (1.0 + near * near), 0.0, 0.0, 0.0, 0.0
