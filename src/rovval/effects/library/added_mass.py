"""Added mass differs from the vehicle file's: M_A' = S M_A S with S = diag(sqrt(1 + scale)), which keeps it symmetric."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.channels import AXES
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, reference_added_mass

EFFECT = Effect(
    name="added_mass",
    title="Added mass differs",
    place="vehicle",
    equation="M_A[i,i] <- (1 + scale) M_A[i,i], cross terms with the root of both scales; enters M_A dnu_r/dt and C_A(nu_r) nu_r "
    "(thesis 3.12; Fossen 2021, 6.3). Where the file has none, scale refers to half of the rigid body's value.",
    parameters=(
        Parameter("scale", "1", -0.9, 3.0, 0.0, 0.3, "0.3 to 2.5 times strip-theory and DNV estimates (diagnosis.md H4; Eidsvik 2015)"),
    ),
    per="axis",
    axes=AXES,
    signature="transients only: the answer to a step of thrust comes too fast or too slow; yaw moment in oblique motion (Munk)",
    confused_with=("thrust_lag", "time_offset", "velocity_filter_lag", "payload_change", "inertia_error"),
    separates="steps at two or more frequencies: amplitude and phase together; an accelerometer beside the velocity sensor",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the diagonal, keep the matrix positive definite."""
    diagonal = np.diagonal(lanes.added_mass, axis1=1, axis2=2)
    own = diagonal > 0
    root = np.where(own, np.sqrt(1.0 + p["scale"]), 1.0)
    missing = np.where(own, 0.0, p["scale"] * reference_added_mass(lanes.vehicle))
    scaled = root[:, :, None] * lanes.added_mass * root[:, None, :]
    return replace(lanes, added_mass=scaled + missing[:, :, None] * np.eye(6))
