"""Thrust grows by another power of the shaft speed than its square."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes, reference_speed

EFFECT = Effect(
    name="thrust_curve",
    title="Curve of the thrust over speed",
    place="input",
    equation="T <- T (1 + power s), s = 2 (|n| - n_1) / (|n| + n_1), which is ln(|n| / n_1) to 4 per cent between half of n_1 and twice n_1: thrust of every "
    "thruster goes as |n|^(2 + power) there, and by a share between 1 - 2 power and 1 + 2 power of its square elsewhere.",
    symbols={
        "T": "thrust of every thruster, along its axis; N",
        "n": "shaft speed; rev/s",
        "n_1": "speed at which all thrusters together hold the vehicle at 1 m/s ahead; rev/s",
        "power": "of the speed, beyond the vehicle file's; 1",
    },
    parameters=(
        Parameter(
            "power", "1", -0.45, 0.45, 0.0, 0.1, "0.02 to 0.11 (Blue Robotics T200: logarithms of thrust over those of speed, 10 to 20 V, both ways)",
            tolerance=Tolerance(1.0, "the calibration tolerance itself: thrust at 2.7 times the speed at which it is as filed is off by as much"),
        ),
    ),
    signature="strong commands do more, or less, than they should, and weak ones the other way round",
    confused_with=("thruster_deadband", "ventilation", "supply_droop", "rpm_scale"),
    separates="steps of one thruster by itself, of several heights, on a stand",
    literature=("Blue Robotics T200: thrust over speed at 10 to 20 V", "Carlton 2018, chapter 6: thrust coefficient by the Reynolds number"),
    competes=False,  # as a cause it stands in for whatever else changes thrust by its size
)
ROWS = ("power", "reference")
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The power, and the speed at which nothing changes, rev/s."""
    return {"power": p["power"], "reference": np.full_like(p["power"], reference_speed(lanes.vehicle))}


def static(power: Number, reference: Number, T: Number, n: Number) -> Number:
    """Thrust by the other power."""
    speed = abs(n)
    return T * (1.0 + power * 2.0 * (speed - reference) / (speed + reference))
