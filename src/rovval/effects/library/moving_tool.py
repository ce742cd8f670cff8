"""A manipulator or tool skid that swings to and fro: its weight where it is, its drag, and what its mass asks of the hull (thesis 2.4.9)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, sin, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

LEVER = "reach of a work-class manipulator: up to 2 m (chosen)"

EFFECT = Effect(
    name="moving_tool",
    title="Manipulator or tool skid that moves",
    place="wrench",
    equation="At r_T = (x + s, y, z), s = swing sin(2 pi t / period) along the hull: its weight down; drag -1/2 rho area |v_T| v_T with v_T = v_r + "
    "omega x r_T + ds/dt; of its own motion the reaction -mass (d2s/dt2 + 2 omega x ds/dt). That it is carried along at rest, mass in M_RB, is the vehicle "
    "file's or `payload_change`.",
    symbols={
        "r_T": "where the tool is, from the body's origin, body axes; m",
        "s": "how far it has swung ahead, body axes; m",
        "t": "time since the run's start; s",
        "weight": "its weight less its buoyancy, down in the north-east-down frame; N",
        "rho": "density of the water; kg/m3",
        "area": "drag coefficient times area; m2",
        "v_r, omega": "velocity of the body through the water, and its rate of turn, body axes; m/s, rad/s",
        "v_T": "velocity of the tool through the water, body axes; m/s",
        "mass": "what moves, with its added mass; kg",
        "swing, period": "how far it moves ahead and back, and in which time; m, s",
        "M_RB": "rigid-body mass matrix",
    },
    parameters=(
        Parameter("weight", "N", -60.0, 60.0, 0.0, 3.0, "weight less buoyancy of the tool (thesis 2.4.9)", "weight"),
        Parameter("area", "m2", 0.0, 5.0, 0.0, 0.1, "a manipulator's 0.1 to a skid's 2 m2 (chosen)"),
        Parameter("mass", "kg", 0.0, 10.0, 0.0, 0.5, "a tenth of the vehicle and less (chosen)", "weight"),
        Parameter("x", "m", -3.0, 3.0, 0.0, 0.5, LEVER, role="lever"),
        Parameter("y", "m", -3.0, 3.0, 0.0, 0.5, LEVER, role="lever"),
        Parameter("z", "m", -3.0, 3.0, 0.0, 0.5, LEVER, role="lever"),
        Parameter("swing", "m", -2.0, 2.0, 0.0, 0.3, LEVER),
        Parameter("period", "s", 2.0, 600.0, 20.0, 10.0, "a slow arm (chosen)", role="period"),
    ),
    signature="pitch and heave that follow the arm, and drag on a lever",
    confused_with=("payload_change", "cg_offset", "quadratic_drag"),
    separates="keep the arm still",
    literature=("thesis, section 2.4.9", "Fossen 2021, section 6.4: quadratic drag"),
    competes=False,
)
ROWS = ("weight", "drag", "mass", "px", "py", "pz", "swing", "rate")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Weight, half of rho times the drag area, moving mass, and where and how fast (rad/s) the tool swings."""
    half = 0.5 * lanes.vehicle.water.density * p["area"]
    return {
        "weight": p["weight"], "drag": half, "mass": p["mass"], "px": p["x"], "py": p["y"], "pz": p["z"],
        "swing": p["swing"], "rate": 2.0 * np.pi / p["period"],
    }  # fmt: skip


def wrench(
    weight: Number, drag: Number, mass: Number, px: Number, py: Number, pz: Number, swing: Number, rate: Number, t: Number,
    ur: Number, vr: Number, wr: Number, p: Number, q: Number, r: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Weight, drag and reaction at the tool, in body axes, and their moment about the origin."""
    swung = swing * sin(rate * t)
    x, speed = px + swung, swing * rate * cos(rate * t)
    tu, tv, tw = ur + speed + q * pz - r * py, vr + r * x - p * pz, wr + p * py - q * x
    slow = drag * sqrt(tu * tu + tv * tv + tw * tw)
    fx = weight * r31 - slow * tu + mass * rate * rate * swung
    fy = weight * r32 - slow * tv - 2.0 * mass * speed * r
    fz = weight * r33 - slow * tw + 2.0 * mass * speed * q
    return fx, fy, fz, py * fz - pz * fy, pz * fx - x * fz, x * fy - py * fx
