"""Thrusters turning astern give more or less than the vehicle file says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="reverse_asymmetry",
    title="Thrust astern differs",
    place="input",
    equation="k_neg <- (1 + scale) k_neg of every thruster; k_pos as it is.",
    symbols={"k_pos, k_neg": "thrust over the square of the shaft speed, turning ahead and astern; N s2"},
    parameters=(
        Parameter(
            "scale", "1", -0.9, 2.0, 0.0, 0.15, "k_neg / k_pos from 0.5 to 1 (chosen); T200: 0.79 (Blue Robotics T200)", vanishes_at="low",
            tolerance=Tolerance(1.0, "the declared calibration tolerance itself"),
        ),
    ),
    signature="the answer depends on the sign of the command; a mean force while hovering or turning",
    confused_with=("rpm_scale", "buoyancy_error", "current_constant", "hull_interaction"),
    separates="equal steps both ways",
    literature=("Bachmayer 2000: thrust in all four quadrants", "Blue Robotics T200: thrust ahead and astern"),
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Scale the gain astern."""
    return replace(lanes, k_neg=(1.0 + p["scale"])[:, None] * lanes.k_neg)
