"""Lift of the hull at an angle of attack: a force across the motion, as of a body or fin that meets the water askew."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, reference_drag

SOURCE = "a plate that meets the water at 45 degrees has 0.4 of the drag of its face beyond that of the slip alone; either sign (chosen)"

EFFECT = Effect(
    name="hull_lift",
    title="Lift of the hull is missing",
    place="wrench",
    equation="Y = -sway q_v s v_r, Z = -heave q_w s w_r, s = u_r while going ahead and -astern u_r while going astern; M = x heave q_w u_r w_r, "
    "N = -x sway q_v u_r v_r: the place of the force is by x towards the end that meets the water first (Y_uv, Z_uw, M_uw, N_uv).",
    symbols={
        "Y, Z": "forces to starboard and down, body axes; N",
        "u_r, v_r, w_r": "velocities relative to the water, ahead, to starboard and down, body axes; m/s",
        "q_v, q_w": "quadratic drag of sway and heave; N s2/m2",
        "sway, heave": "lift, as a share of these",
        "M, N": "moments of pitch and yaw, body axes; N m",
        "x": "place of the lift, ahead of the origin while going ahead; m",
        "astern": "lift while going astern over that while going ahead; 1",
    },
    parameters=(
        Parameter("sway", "1", -3.0, 3.0, 0.0, 0.3, SOURCE),
        Parameter("heave", "1", -3.0, 3.0, 0.0, 0.3, SOURCE),
        Parameter("x", "m", -2.0, 2.0, 0.0, 0.2, "within the hull", "length", role="lever"),
        Parameter("astern", "1", -1.0, 1.0, 1.0, 0.5, "hulls alike at both ends 1; the equations of Gertler and Hagen, made for ahead, -1", role="extent",
            starts=(1.0, -1.0),
        ),
    ),
    signature="slip costs more with way on than without: a force across that grows with the speed ahead, at the end that meets the water first",
    confused_with=("cross_drag", "added_mass", "dvl_misalignment", "current_constant"),
    separates="slip with way on and without, to both sides",
    literature=(
        "Gertler and Hagen 1967: Y_uv, Z_uw, M_uw and N_uv, standard equations of motion for submarines",
        "Hoerner and Borst 1975: lift of bodies and of wings of small aspect ratio",
    ),
)
ROWS = ("yuv", "zuw", "ahead", "same", "other")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Coefficients, N s2/m2, place of the lift, m, and its parts that go with |u| and with u."""
    quadratic = np.asarray(reference_drag(lanes.vehicle)[1])
    both = {"same": 0.5 * (1.0 + p["astern"]), "other": 0.5 * (1.0 - p["astern"])}
    return {"yuv": p["sway"] * quadratic[1], "zuw": p["heave"] * quadratic[2], "ahead": p["x"]} | both


def wrench(yuv: Number, zuw: Number, ahead: Number, same: Number, other: Number, ur: Number, vr: Number, wr: Number) -> tuple[Number, ...]:
    """Force across the motion and its moment."""
    fy, fz, way = -yuv * vr, -zuw * wr, same * abs(ur) + other * ur
    return 0.0, fy * way, fz * way, 0.0, -ahead * fz * ur, ahead * fy * ur
