"""Vertical thrusters give another share of the thrust than the file says, horizontal ones all of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="vertical_thrust",
    title="Thrust of vertical thrusters differs",
    place="input",
    equation="T_i <- (1 + scale) T_i of every vertical thruster; horizontal ones as they are.",
    symbols={"T_i": "thrust of thruster i, along its axis; N"},
    parameters=(
        Parameter(
            "scale", "1", -0.9, 1.0, 0.0, 0.15, "a BlueROV2's vertical thrusters blow at its frame: 0.59 to 0.74 of the others by calibrations on tank runs",
            vanishes_at="low",
        ),
    ),
    signature="all that vertical thrust does, in heave, roll and pitch, by one factor",
    confused_with=("thruster_degraded", "quadratic_drag", "added_mass", "rpm_scale"),
    separates="heave steps beside surge steps",
    literature=("Fossen and Johansen 2006: thruster configuration matrix", "Carlton 2018, chapter 6: propeller characteristics"),
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale both gains of those that are vertical."""
    factor = np.where([t.vertical for t in lanes.vehicle.thruster], 1.0 + p["scale"][:, None], 1.0)
    return replace(lanes, k_pos=factor * lanes.k_pos, k_neg=factor * lanes.k_neg)
