"""Linear drag differs from the vehicle file's on one axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.channels import AXES
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, reference_drag

EFFECT = Effect(
    name="linear_drag",
    title="Linear drag differs",
    place="vehicle",
    equation="tau_i = -(1 + scale) d_i nu_r,i (thesis 3.13; Fossen 2021, 6.4); "
    "where the file has none, scale refers to the quadratic force at 0.1 m/s (rad/s).",
    parameters=(Parameter("scale", "1", -0.95, 9.0, 0.0, 0.3, "published BlueROV2 surge values run from 4 to 14 N s/m (diagnosis.md H1)"),),
    per="axis",
    axes=AXES,
    signature="acts at low speed; changes the exponential tail of a coast-down",
    confused_with=("quadratic_drag", "current_constant", "tether_drag", "rpm_scale"),
    separates="coast-down with thrust off, from several speeds",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Add the departure to the diagonal."""
    departure = p["scale"] * reference_drag(lanes.vehicle)[0]
    return replace(lanes, linear_drag=lanes.linear_drag + departure[:, :, None] * np.eye(6))
