"""Added mass differs from the vehicle file's: M_A' = S M_A S with S = diag(sqrt(1 + scale)), which keeps it symmetric."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.channels import AXES
from rovval.effects.effect import TOGETHER, Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes, reference_added_mass

CALIBRATION = Tolerance(1.0, "the declared calibration tolerance itself", loop_gain=1.0)

EFFECT = Effect(
    name="added_mass",
    title="Added mass differs",
    place="vehicle",
    equation="M_A[i,i] <- (1 + scale) M_A[i,i], M_A[i,j] <- sqrt((1 + scale_i) (1 + scale_j)) M_A[i,j]; it enters M_A dnu_r/dt and C_A(nu_r) nu_r. "
    "Where the file has none, scale refers to half of the rigid body's value.",
    symbols={
        "M_A": "added mass matrix, 6 x 6, body axes; kg, kg m, kg m2",
        "C_A": "its Coriolis and centripetal matrix",
        "nu_r": "velocity relative to the water, body axes; m/s, rad/s",
        "i, j": "surge, sway, heave, roll, pitch, yaw",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.9, 3.0, 0.0, 0.3, "0.3 to 2.5 times estimates by strip theory and DNV-RP-H103 (Eidsvik 2015)",
            vanishes_at="low", tolerance=CALIBRATION,
        ),
    ),
    per="axis",
    axes=AXES,
    groups=TOGETHER,
    signature="transients only: the answer to a step of thrust comes too fast or too slow; yaw moment in oblique motion (Munk)",
    confused_with=("thrust_lag", "time_offset", "velocity_filter_lag", "payload_change", "inertia_error"),
    separates="steps at two or more frequencies: amplitude and phase together; an accelerometer beside the velocity sensor",
    literature=(
        "thesis, equation 3.12",
        "Fossen 2021, section 6.3: added mass and its Coriolis matrix",
        "Newman 1977, chapter 4: added mass and the Munk moment",
        "DNV 2011, appendix A: added mass of simple bodies",
        "Eidsvik 2015: estimates for ROVs beside identified values",
    ),
    family="mass",
    absent_in=("freefloating",),
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the diagonal, keep the matrix positive definite."""
    diagonal = np.diagonal(lanes.added_mass, axis1=1, axis2=2)
    own = diagonal > 0
    root = np.where(own, np.sqrt(1.0 + p["scale"]), 1.0)
    missing = np.where(own, 0.0, p["scale"] * reference_added_mass(lanes.vehicle))
    scaled = root[:, :, None] * lanes.added_mass * root[:, None, :]
    return replace(lanes, added_mass=scaled + missing[:, :, None] * np.eye(6))
