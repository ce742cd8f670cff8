"""The tether is caught: from then on, beyond a slack radius round a point, it pulls like a spring."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, clip, positive, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

RAMP = 0.1  # s over which the pull comes on: a sample of the common grid, so that the onset has a gradient

EFFECT = Effect(
    name="tether_snag",
    title="Tether snagged",
    place="wrench",
    equation="F = stiffness max(d - radius, 0) at the attachment (x, 0, z) towards the point (north, east, down) from onset on; stiffness = E A / l_0 of the "
    "taut length.",
    symbols={
        "F": "force; N",
        "d": "distance of the attachment to the point; m",
        "radius": "slack: distance up to which nothing pulls; m",
        "north, east, down": "the point in the log's frame; m",
        "x, z": "attachment ahead of and below the origin, body axes; m",
        "E A, l_0": "axial stiffness (N) and unstretched length (m) of what is taut",
        "onset": "time since the run's start; s",
    },
    parameters=(
        Parameter("stiffness", "N/m", 0.0, 200.0, 0.0, 10.0, "chosen: a few metres of stretch stop the vehicle", "drag"),
        Parameter(
            "north", "m", -1000.0, 1000.0, 0.0, 3.0, "where it is caught, in the log's x: the search begins where the missing force leads",
            role="anchor", channel="x",
        ),
        Parameter("east", "m", -1000.0, 1000.0, 0.0, 3.0, "where it is caught, in the log's y", role="anchor", channel="y"),
        Parameter("down", "m", -1000.0, 1000.0, 0.0, 3.0, "where it is caught, depth", role="anchor", channel="z"),
        Parameter("radius", "m", 0.0, 1000.0, 0.0, 2.0, "slack", role="extent"),
        Parameter("onset", "s", 0.0, 1e6, 0.0, 60.0, "any time of the log", role="onset"),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.3, "attachment, ahead of the origin"),  # a size, no lever: at its bound the spring is none
        Parameter("z", "m", -2.0, 2.0, 0.0, 0.2, "attachment, below the origin"),  # that the library knows
    ),
    signature="a sudden pull that comes back at the same place and always points the same way there",
    confused_with=("tether_tension", "current_varying"),
    separates="come back to the place from another side",
    literature=("Driscoll 2000: axial stiffness of an ROV's tether, slack and taut", "McLain and Rock 1992: measured tension of an ROV's tether"),
    needs=("x", "y", "z", "psi"),
)
ROWS = ("stiffness", "north", "east", "down", "radius", "onset", "ax", "az")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The spring and its attachment."""
    return {name: p[name] for name in ROWS[:6]} | {"ax": p["x"], "az": p["z"]}


def wrench(
    stiffness: Number, north: Number, east: Number, down: Number, radius: Number, onset: Number, ax: Number, az: Number,
    x: Number, y: Number, z: Number, t: Number,
    r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """The pull in the body frame and its moment."""
    dn, de, dd = north - x - r11 * ax - r13 * az, east - y - r21 * ax - r23 * az, down - z - r31 * ax - r33 * az
    distance = sqrt(dn * dn + de * de + dd * dd + 1e-12)
    pull = stiffness * clip((t - onset) * (1.0 / RAMP), 0.0, 1.0) * positive(distance - radius) / distance
    fn, fe, fd = pull * dn, pull * de, pull * dd
    fx, fy, fz = r11 * fn + r21 * fe + r31 * fd, r12 * fn + r22 * fe + r32 * fd, r13 * fn + r23 * fe + r33 * fd
    return fx, fy, fz, -az * fy, az * fx - ax * fz, ax * fy
