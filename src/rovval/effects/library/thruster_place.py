"""The thrusters act at another height, or further ahead, than the vehicle file says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes
from rovval.vehicle.model import Vehicle

SOURCE = "a BlueROV2 for which 85 mm is printed (von Benzon 2022); three tank runs say 72 to 86 mm less"
MEASURED = 0.1  # of the longest thruster arm per unit of calibration tolerance: 5 % goes with places known to 0.5 % of it, as centres are (chosen)


def _place(parameter: Parameter, vehicle: Vehicle, target: str) -> float:
    """M, either way."""
    return MEASURED * vehicle.longest_arm


PLACED = Tolerance(_place, "places of thrusters to a share of the vehicle's size (chosen)")

EFFECT = Effect(
    name="thruster_place",
    title="Place of thrusters differs",
    place="vehicle",
    equation="r_i <- r_i + (ahead, 0, down) in the moment r_i x T_i, down for horizontal thrusters only; the water flows past them as at the file's place.",
    symbols={
        "r_i": "where thruster i acts, from the body's origin, body axes forward-starboard-down; m",
        "T_i": "its thrust, body axes; N",
        "ahead, down": "how far the thrusters act ahead of and below their places in the file; m",
    },
    parameters=(
        Parameter("down", "m", -1.0, 1.0, 0.0, 0.05, SOURCE, tolerance=PLACED),
        Parameter("ahead", "m", -1.0, 1.0, 0.0, 0.05, SOURCE, tolerance=PLACED),
    ),
    signature="pitch follows thrust in surge and heave, roll thrust in sway, yaw thrust in sway",
    confused_with=("cg_offset", "thruster_misaligned", "quadratic_drag"),
    separates="steps in surge and sway from rest: thrust tilts the vehicle before drag does",
    literature=("thesis, equation 3.15", "von Benzon 2022: BlueROV2 Heavy", "Fossen and Johansen 2006: thruster configuration matrix"),
    separable=True,
    family="allocation",
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Move the places; zero leaves them to the last bit."""
    down = np.where([t.vertical for t in lanes.vehicle.thruster], 0.0, p["down"][:, None])
    ahead = np.broadcast_to(p["ahead"][:, None], down.shape)
    return replace(lanes, position=lanes.position + np.stack([ahead, np.zeros_like(down), down], axis=-1))
