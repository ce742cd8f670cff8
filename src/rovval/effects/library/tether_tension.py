"""The tether pulls with one tension, in a fixed direction or towards a point."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

PULL = "0 to 30 N on an observation-class vehicle (chosen), up to 2.7 kN on a work-class one (McLain and Rock 1992)"

EFFECT = Effect(
    name="tether_tension",
    title="Steady pull of the tether",
    place="wrench",
    equation="F = |T| d / sqrt(d^2 + slack^2) R^T e + weight R^T (0, 0, 1) at the attachment (x, 0, z), e the unit vector along T - nearness |T| (position "
    "below depth), to the point that is d away; of one far away F = |T| R^T e.",
    symbols={
        "F": "force, body axes; N",
        "T": "tension (north, east, down) at the log's origin, at depth; N",
        "nearness": "one over the distance from there to the point that the tether leads to; 1/m, 0: far away",
        "R": "rotation from body axes to the north-east-down frame",
        "position below depth": "north, east, down from the log's origin, at depth; m",
        "depth": "depth from which that is counted; m",
        "slack": "distance from the point within which the line hangs in a bight rather than pulls; m",
        "weight": "what the vehicle carries of the tether's weight in water, by which the line leaves it more steeply; N",
        "x, z": "attachment ahead of and below the origin, body axes; m",
    },
    parameters=(
        Parameter("north", "N", -100.0, 100.0, 0.0, 6.0, PULL, "weight"),
        Parameter("east", "N", -100.0, 100.0, 0.0, 6.0, PULL, "weight"),
        Parameter("down", "N", -100.0, 100.0, 0.0, 4.0, PULL, "weight"),
        Parameter(
            "nearness", "1/m", 0.0, 1.0, 0.0, 0.05, "one over the distance from the log's origin to where it is held; 0: far away", role="extent",
        ),
        Parameter("depth", "m", -10.0, 12000.0, 0.0, 1.0, "where the pull has these components: the log's mean depth", role="level", needs="z"),
        Parameter("weight", "N", -100.0, 100.0, 0.0, 4.0, "100 m of some 20 g/m in water, or of as much lift (chosen): 10 N at each end", "weight"),
        Parameter("slack", "m", 0.0, 20.0, 0.0, 2.0, "there it pulls by 0.7 of its tension; a few lengths of the vehicle (chosen)", role="extent"),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.3, "attachment, ahead of the origin", role="lever"),
        Parameter("z", "m", -2.0, 2.0, 0.0, 0.2, "attachment, below the origin", role="lever"),
    ),
    signature="a force fixed to north and east, or to a point, also when the vehicle lies still; a moment if it is attached aft",
    confused_with=("current_constant", "buoyancy_error", "cg_offset"),
    separates="a current's force depends on the vehicle's own speed, a pull's does not: two speeds on two headings",
    held=True,
    refines=("weight", "slack"),
    wanders=True,  # what is paid out, hauled and swept by the water changes it along the log (McLain and Rock 1992: from slack to 600 lbf)
    literature=("McLain and Rock 1992: measured tension of an ROV's tether, up to 600 lbf", "Driscoll 2000: dynamics of an ROV's tether"),
)
ROWS = ("north", "east", "down", "nearness", "depth", "weight", "slack", "ax", "az")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Pull, where it leads, weight, slack and attachment."""
    return {name: p[name] for name in ROWS[:-2]} | {"ax": p["x"], "az": p["z"]}


def wrench(
    north: Number, east: Number, down: Number, nearness: Number, depth: Number, weight: Number, slack: Number, ax: Number, az: Number,
    x: Number, y: Number, z: Number,
    r11: Number, r12: Number, r13: Number, r21: Number, r22: Number, r23: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """The pull and the weight in the body frame, and their moment."""
    tension = sqrt(north * north + east * east + down * down)
    bend = nearness * tension
    soft = bend * slack
    fn, fe, fd = north - bend * x, east - bend * y, down - bend * (z - depth)
    scale = tension / sqrt(fn * fn + fe * fe + fd * fd + soft * soft + 1e-12)
    fn, fe, fd = scale * fn, scale * fe, scale * fd
    fd = fd + weight
    fx, fy, fz = r11 * fn + r21 * fe + r31 * fd, r12 * fn + r22 * fe + r32 * fd, r13 * fn + r23 * fe + r33 * fd
    return fx, fy, fz, -az * fy, az * fx - ax * fz, ax * fy
