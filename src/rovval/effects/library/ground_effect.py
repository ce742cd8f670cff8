"""Close to the bottom the vehicle's own jets and wake push it off, or hold it down."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, clip, exp
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

FARTHEST = 12000.0  # m: deeper than any sea, so that what is logged of the altitude is all that counts

EFFECT = Effect(
    name="ground_effect",
    title="Ground effect near the bottom",
    place="wrench",
    equation="F = -gain exp(-h / height) down, at the origin; Z = exp(-h / height) (suction (u_r^2 + v_r^2) - drag (d_w w_r + q_w |w_r| w_r)); "
    "h = min(altitude, seabed - z).",
    symbols={
        "F": "force, down in the north-east-down frame; N",
        "gain": "force at the bottom, upwards; N",
        "Z": "force, down in body axes; N",
        "suction": "of the water that runs faster between vehicle and bottom as the vehicle passes over it; N s2/m2",
        "u_r, v_r": "velocity ahead and to starboard relative to the water, body axes; m/s",
        "drag": "share by which the drag in heave is greater at the bottom; 1",
        "d_w, q_w": "linear and quadratic drag coefficient in heave of the vehicle's file; N s/m, N s2/m2",
        "w_r": "velocity down relative to the water, body axes; m/s",
        "h": "height above the bottom; m",
        "altitude": "measured height above the bottom; m",
        "seabed": "depth of a flat seabed, where no altitude is measured; m",
        "z": "the vehicle's depth, down; m",
        "height": "height over which it falls off; m",
    },
    parameters=(
        Parameter("gain", "N", -60.0, 60.0, 0.0, 6.0, "chosen: up to half of the weight of the water that the jets move", "weight"),
        Parameter(
            "height", "m", 0.01, 0.25, 0.085, 0.05, "up to three propeller diameters (Bhattacharyya 2016)", "length", role="extent",
            starts=(0.035, 0.085, 0.25),
        ),
        Parameter(
            "suction", "N s2/m2", -300.0, 300.0, 0.0, 20.0, "as large as drag: a body is drawn to a wall that it passes (Newman 1977; size chosen)", "drag",
        ),
        Parameter("drag", "1", 0.0, 30.0, 0.0, 1.0, "drag of a body that sinks onto a wall, some times that in open water and never less (JMSE 2025)"),
        Parameter(
            "seabed", "m", -10.0, FARTHEST, FARTHEST, 0.25, "of a flat bottom under the deepest point of the log: a metre below it, and as much off (chosen)",
            role="bottom", needs="z", instead_of="altitude",
        ),
    ),
    signature="a vertical force that is there below a metre or two of altitude only, be it at rest or with the speed over the bottom; as large as "
    "what the thrusters push with, within a decimetre or two, it is the bottom itself, which the vehicle touches",
    confused_with=("buoyancy_error", "current_shear", "density_gradient"),
    separates="steps of altitude over the same spot",
    literature=(
        "Newman 1977, chapter 4: a body moving along a wall is drawn to it (method of images)",
        "Bhattacharyya 2016: a small underwater vehicle in hydrodynamic ground effect",
        "JMSE 2025: an underwater vehicle near a wall, force by distance and speed",
    ),
    wanders=True,  # with a bottom that is not flat, which the equation has not
    within={"altitude": 3.0},  # m, chosen: three times the largest reach above, where a twentieth is left
)
ROWS = ("gain", "inverse", "seabed", "suction", "linear", "quadratic")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Force at the bottom, N; inverse height, 1/m; depth of the bottom, m; suction, N s2/m2; drag in heave that it adds, N s/m and N s2/m2."""
    linear, quadratic = (np.asarray(p["drag"] * matrix[:, 2, 2]) for matrix in (lanes.linear_drag, lanes.quadratic_drag))
    return {name: p[name] for name in ("gain", "seabed", "suction")} | {"inverse": 1.0 / p["height"], "linear": linear, "quadratic": quadratic}


def wrench(
    gain: Number, inverse: Number, seabed: Number, suction: Number, linear: Number, quadratic: Number, altitude: Number, z: Number,
    ur: Number, vr: Number, wr: Number, r31: Number, r32: Number, r33: Number,
) -> tuple[Number, ...]:  # fmt: skip
    """Upward force, suction and drag in heave, in the body frame."""
    near = exp(-clip(altitude, -FARTHEST, seabed - z) * inverse)
    up = -gain * near
    along = suction * (ur * ur + vr * vr)
    return up * r31, up * r32, up * r33 + near * (along - (linear + quadratic * abs(wr)) * wr), 0.0, 0.0, 0.0
