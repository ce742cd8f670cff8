"""The tether that the vehicle drags along: a force against its velocity through the water, more of it across the line than along it."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

PULL = "as of `tether_tension`"
SLACK = 1.0  # N: a pull of less tells no direction (chosen; some per cent of what such lines pull)

EFFECT = Effect(
    name="tether_drag",
    title="Drag of the tether",
    place="wrench",
    equation="F = -(coefficient + per_length L) |v'| v' + T + weight R^T (0, 0, 1) at the attachment (x, 0, z), v' = v - (v . T) T / (|T|^2 + s^2): next to "
    "nothing drags along the line, whose direction its pull has (Morison); coefficient ~ 1/2 rho C_n d L, of which the vehicle carries a quarter where the "
    "other end of the line is still, about half where it is not; T = |T| R^T e as of `tether_tension`, e the unit vector along (north, east, down) - nearness "
    "|T| (position below depth).",
    symbols={
        "F": "force, body axes; N",
        "v": "velocity of the attachment relative to the water, the vehicle's turning included, body axes; m/s",
        "L": "logged length of tether paid out; m",
        "rho": "density of the water; kg/m3",
        "C_n, d": "coefficient of normal drag (1) and diameter (m) of the tether",
        "T": "pull along the same tether, body axes; N",
        "s": "1 N: a pull of less tells no direction",
        "R": "rotation from body axes to the north-east-down frame",
        "north, east, down": "the same pull at the log's origin, at depth; N",
        "nearness": "one over the distance from there to the point that the tether leads to; 1/m, 0: far away",
        "position below depth": "north, east, down from the log's origin, at depth; m",
        "depth": "depth from which that is counted; m",
        "weight": "what the vehicle carries of the tether's weight in water, down; N",
        "x, z": "attachment ahead of and below the origin, body axes; m",
    },
    parameters=(
        Parameter(
            "coefficient", "N s2/m2", 0.0, 1500.0, 0.0, 40.0, "0.5 m/s with 100 m of 7.6 mm: 115 N at C_n 1.2 (Hoerner 1965) to 190 N at 2.0 (in use)", "drag",
        ),
        Parameter("per_length", "N s2/m3", 0.0, 20.0, 0.0, 2.0, "1/2 rho C_n d with half carried by the vehicle: 7.6 mm, C_n 1.2: 2.3; needs tether_length"),
        Parameter("north", "N", -100.0, 100.0, 0.0, 6.0, PULL, "weight"),
        Parameter("east", "N", -100.0, 100.0, 0.0, 6.0, PULL, "weight"),
        Parameter("down", "N", -100.0, 100.0, 0.0, 4.0, PULL, "weight"),
        Parameter(
            "nearness", "1/m", 0.0, 1.0, 0.0, 0.05, "one over the distance from the log's origin to where it is held; 0: far away", role="extent",
        ),
        Parameter("depth", "m", -10.0, 12000.0, 0.0, 1.0, "where the pull has these components: the log's mean depth", role="level", needs="z"),
        Parameter("weight", "N", -100.0, 100.0, 0.0, 4.0, PULL, "weight"),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.3, "attachment, ahead of the origin", role="lever"),
        Parameter("z", "m", -2.0, 2.0, 0.0, 0.2, "attachment, below the origin", role="lever"),
    ),
    signature="opposes the velocity through the water, of all body directions alike, but for those along the line, and so pushes aside as well; grows with "
    "tether paid out",
    confused_with=("quadratic_drag", "linear_drag", "current_constant", "inflow_loss"),
    separates="the same speed ahead and sideways: a hull's drag differs, a tether's does not; the log of tether length",
    literature=(
        "Hoerner 1965: normal drag of a cylinder, C_n 1.2",
        "Driscoll 2000: lumped-mass model of a tether, its drag along and across",
        "Feng and Allen 2004: a cable's drag on an underwater vehicle",
    ),
    includes="tether_tension",
    towed=True,
    needs_one_of=("u", "v", "x", "y"),  # of a vehicle that only turns, as far as the log shows, it is drag in yaw
    refines=("north", "east", "down", "weight"),
)
ROWS = ("coefficient", "per_length", "north", "east", "down", "nearness", "depth", "weight", "ax", "az")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Coefficients, pull, where it leads, weight and attachment."""
    return {name: p[name] for name in ROWS[:8]} | {"ax": p["x"], "az": p["z"]}


def wrench(
    coefficient: Number, per_length: Number, north: Number, east: Number, down: Number, nearness: Number, depth: Number, weight: Number,
    ax: Number, az: Number, tether_length: Number, x: Number, y: Number, z: Number, ur: Number, vr: Number, wr: Number, p: Number, q: Number, r: Number,
    r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Force against the part of the attachment's velocity relative to the water that is across the line, the pull along it and its weight in the body frame,
    and their moment."""
    ua, va, wa = ur + q * az, vr + r * ax - p * az, wr - q * ax
    tension = sqrt(north * north + east * east + down * down)
    bend = nearness * tension
    fn, fe, fd = north - bend * x, east - bend * y, down - bend * (z - depth)
    scale = tension / sqrt(fn * fn + fe * fe + fd * fd + 1e-12)
    fn, fe, fd = scale * fn, scale * fe, scale * fd
    tx, ty, tz = r11 * fn + r21 * fe + r31 * fd, r12 * fn + r22 * fe + r32 * fd, r13 * fn + r23 * fe + r33 * fd
    along = (ua * tx + va * ty + wa * tz) / (tension * tension + SLACK * SLACK)
    un, vn, wn = ua - along * tx, va - along * ty, wa - along * tz
    pull = -(coefficient + per_length * tether_length) * sqrt(un * un + vn * vn + wn * wn)
    fx = pull * un + tx + r31 * weight
    fy = pull * vn + ty + r32 * weight
    fz = pull * wn + tz + r33 * weight
    return fx, fy, fz, -az * fy, az * fx - ax * fz, ax * fy
