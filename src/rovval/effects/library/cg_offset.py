"""The centre of gravity is not where the vehicle file says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, with_centre_of_gravity

SOURCE = "+-2 cm (diagnosis.md B2, B3); the metacentric height of small ROVs is 0.5 to 5 cm"

EFFECT = Effect(
    name="cg_offset",
    title="Centre of gravity displaced",
    place="vehicle",
    equation="r_G <- r_G + (x, y, z) in M_RB, C_RB and g (thesis 3.11, 3.14); inertia about the centre of gravity unchanged (Huygens-Steiner).",
    parameters=(
        Parameter("x", "m", -0.2, 0.2, 0.0, 0.01, SOURCE),
        Parameter("y", "m", -0.2, 0.2, 0.0, 0.01, SOURCE),
        Parameter("z", "m", -0.2, 0.2, 0.0, 0.01, SOURCE),
    ),
    signature="a standing pitch or roll angle; a moment when accelerating; z changes the righting moment and its period",
    confused_with=("attitude_bias", "propeller_torque", "inertia_error", "payload_change"),
    separates="lie still: an attitude bias has no dynamics; a free roll gives the period",
    apart=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Move the centre of gravity."""
    moved = lanes.centre_of_gravity + np.stack([p["x"], p["y"], p["z"]], axis=1)
    centre, inertia = with_centre_of_gravity(lanes, moved)
    return replace(lanes, centre_of_gravity=centre, inertia=inertia)
