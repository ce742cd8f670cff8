"""Drag that differs ahead and astern, to either side, down and up: a hull that is blunt at one end, a net or a skid hung on one face of the frame."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, reference_drag

SOURCE = "a cup drags 1.4 open side ahead and 0.4 astern (Hoerner 1965); a net or a skid as much as the hull (chosen)"

EFFECT = Effect(
    name="drag_asymmetry",
    title="Drag differs ahead and astern",
    place="wrench",
    equation="tau_i = -(positive if nu_r,i > 0 else negative) q_i |nu_r,i| nu_r,i beside the drag of the file; at a lever, its moment (X_uu beside X_u|u|).",
    symbols={
        "tau_i": "force on axis i of surge, sway and heave, body axes; N",
        "q_i": "quadratic drag of that axis; N s2/m2",
        "nu_r,i": "velocity relative to the water on it; m/s",
        "positive": "drag beyond the file's ahead, to starboard, down; 1",
        "negative": "the same astern, to port, up; 1",
        "lever": "place of that force: of surge below the origin, of sway and heave ahead of it; m",
    },
    parameters=(
        Parameter("positive", "1", -0.95, 9.0, 0.0, 0.3, SOURCE, vanishes_at="low"),
        Parameter("negative", "1", -0.95, 9.0, 0.0, 0.3, SOURCE, vanishes_at="low"),
        Parameter("lever", "m", -2.0, 2.0, 0.0, 0.2, "within the hull", "length", role="lever"),
    ),
    per="axis",
    axes=("surge", "sway", "heave"),
    signature="the vehicle is faster one way than the other at the same thrust",
    confused_with=("reverse_asymmetry", "current_constant", "quadratic_drag", "hull_interaction"),
    separates="coasting ahead and astern with thrusters off; a current turns with the heading",
    literature=("Gertler and Hagen 1967: X_uu beside X_u|u|, standard equations of motion for submarines", "Hoerner 1965: drag of bodies of both ends"),
)
ROWS = ("xuu", "yvv", "zww", "xu", "yv", "zw", "below", "ahead_y", "ahead_z")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Half the difference and the mean of both ways' coefficients, N s2/m2, and levers, m."""
    quadratic = np.asarray(reference_drag(lanes.vehicle)[1])[:3]
    one, other = p["positive"][:, :3] * quadratic, p["negative"][:, :3] * quadratic
    return dict(zip(ROWS, (*(0.5 * (one - other)).T, *(0.5 * (one + other)).T, *p["lever"][:, :3].T), strict=True))


def wrench(
    xuu: Number, yvv: Number, zww: Number, xu: Number, yv: Number, zw: Number, below: Number, ahead_y: Number, ahead_z: Number,
    ur: Number, vr: Number, wr: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Body force and moment."""
    fx, fy, fz = -(xuu * ur + xu * abs(ur)) * ur, -(yvv * vr + yv * abs(vr)) * vr, -(zww * wr + zw * abs(wr)) * wr
    return fx, fy, fz, 0.0, below * fx - ahead_z * fz, ahead_y * fy
