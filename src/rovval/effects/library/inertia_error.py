"""A moment of inertia differs from the vehicle file's."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="inertia_error",
    title="Moment of inertia differs",
    place="vehicle",
    equation="I[i,i] <- (1 + scale) I[i,i] in M_RB and C_RB, products of inertia with the root of both scales.",
    symbols={
        "I": "inertia tensor about the body's origin, body axes; kg m2",
        "M_RB, C_RB": "rigid-body mass matrix and its Coriolis and centripetal matrix",
        "i": "roll, pitch, yaw",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.7, 3.0, 0.0, 0.15, "CAD or box estimates of a moment of inertia (chosen: 15 %)",
            tolerance=Tolerance(1.0, "the declared calibration tolerance itself", loop_gain=1.0),
        ),
    ),
    per="axis",
    axes=("roll", "pitch", "yaw"),
    signature="period of roll and pitch, and how fast a turn starts",
    confused_with=("added_mass", "cg_offset", "thrust_lag", "payload_change"),
    separates="not to be told from added mass about the same axis by motion alone; a weighing and swing in air",
    literature=(
        "thesis, equation 3.11",
        "Fossen 2021, section 3.3: rigid-body kinetics",
        "Soule and Miller 1933: moments of inertia by swinging in air",
    ),
    family="mass",
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the diagonal, keep the tensor positive definite."""
    root = np.sqrt(1.0 + p["scale"][:, 3:])
    return replace(lanes, inertia=root[:, :, None] * lanes.inertia * root[:, None, :])
