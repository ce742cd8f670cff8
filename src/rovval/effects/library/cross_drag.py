"""Drag that couples sway and yaw, heave and pitch: the hull's ends drag when it turns, and its middle when it slips."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, reference_drag

SOURCE = "0 to 30 % of the diagonal (chosen); either sign, since it depends on which end drags more"

EFFECT = Effect(
    name="cross_drag",
    title="Cross drag is missing",
    place="wrench",
    equation="Y = -yaw_to_sway q l^2 |r| r, N = -sway_to_yaw q l |v_r| v_r; Z = -pitch_to_heave q l^2 |q| q, M = -heave_to_pitch q l |w_r| w_r "
    "(Y_|r|r, N_|v|v, Z_|q|q, M_|w|w).",
    symbols={
        "Y, Z": "forces to starboard and down, body axes; N",
        "M, N": "moments of pitch and yaw, body axes; N m",
        "v_r, w_r": "velocities relative to the water, to starboard and down, body axes; m/s",
        "q, r": "rates of pitch and yaw; rad/s (beside l: the quadratic drag of sway or heave; N s2/m2)",
        "l": "length of the hull; m",
    },
    parameters=(
        Parameter("yaw_to_sway", "1", -0.5, 0.5, 0.0, 0.05, SOURCE),
        Parameter("sway_to_yaw", "1", -0.5, 0.5, 0.0, 0.05, SOURCE),
        Parameter("pitch_to_heave", "1", -0.5, 0.5, 0.0, 0.05, SOURCE),
        Parameter("heave_to_pitch", "1", -0.5, 0.5, 0.0, 0.05, SOURCE),
    ),
    signature="a force on an axis that was not driven, growing with the square of the one that was",
    confused_with=("cg_offset", "dvl_misalignment", "thruster_misaligned", "dvl_lever_arm"),
    separates="sway and yaw together, with both signs of each",
    option="cross_drag",
    literature=(
        "Fossen 2021, section 6.5: cross-flow drag, Y_|r|r and N_|v|v",
        "Martin and Whitcomb 2014: coupled six-degree-of-freedom models identified for an underwater vehicle",
    ),
)
ROWS = ("yr", "nv", "zq", "mw")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Coefficients N s2 (Y, Z of a rate) and N s2 / m (K, M of a velocity)."""
    quadratic, length = np.asarray(reference_drag(lanes.vehicle)[1]), max(lanes.vehicle.body.size[:2])
    return {
        "yr": p["yaw_to_sway"] * quadratic[1] * length**2,
        "nv": p["sway_to_yaw"] * quadratic[1] * length,
        "zq": p["pitch_to_heave"] * quadratic[2] * length**2,
        "mw": p["heave_to_pitch"] * quadratic[2] * length,
    }


def wrench(yr: Number, nv: Number, zq: Number, mw: Number, vr: Number, wr: Number, q: Number, r: Number) -> tuple[Number, ...]:
    """Body force and moment."""
    return 0.0, -yr * abs(r) * r, -zq * abs(q) * q, 0.0, -mw * abs(wr) * wr, -nv * abs(vr) * vr
