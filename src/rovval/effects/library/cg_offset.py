"""The centre of gravity is not where the vehicle file says."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes, with_centre_of_gravity
from rovval.vehicle.model import Vehicle

SOURCE = "+-2 cm (chosen); the metacentric height of small ROVs is 0.5 to 5 cm (von Benzon 2022: 1 cm)"
LEVEL = 0.25  # of the metacentric height per unit of calibration tolerance: 5 % goes with a vehicle as level as its AHRS shows, 0.7 degrees,
CENTRE, CENTRE_LEVEL = 0.1, 0.025  # or of the longest thruster arm, for height and level: centres are known to 0.5 % of it (chosen)
LEAST_LEVEL = 0.01  # m per unit of the same, for level: 0.2 kg of ballast moved by 3 cm moves the centre of an 11.5 kg vehicle by half a millimetre
LIST = 0.5  # power of (1 + loop gain) for a list, which is as steady as the moment that an autopilot gives against it (opened sets: with 1 no list
# under an autopilot is found, with 0.5 four of four)


def _height(vehicle: Vehicle) -> tuple[float, float]:
    """Metacentric height and the longest thruster arm, m."""
    body = vehicle.body
    height = abs(body.centre_of_gravity[2] - body.centre_of_buoyancy[2])
    return height, vehicle.longest_arm


def _level(parameter: Parameter, vehicle: Vehicle, target: str) -> float:
    """M, ahead and to starboard."""
    height, arm = _height(vehicle)
    return max(LEVEL * height, CENTRE_LEVEL * arm, LEAST_LEVEL)


def _upright(parameter: Parameter, vehicle: Vehicle, target: str) -> float:
    """M, down."""
    height, arm = _height(vehicle)
    return max(height, CENTRE * arm)


TRIMMED = Tolerance(_level, "how level a vehicle floats as its AHRS shows, or to a share of its size (chosen)", loop_gain=LIST)
RIGHTED = Tolerance(_upright, "metacentric height to the calibration tolerance, or to a share of the vehicle's size (chosen)", loop_gain=1.0)

EFFECT = Effect(
    name="cg_offset",
    title="Centre of gravity displaced",
    place="vehicle",
    equation="r_G <- r_G + (x, y, z) in M_RB, C_RB and g; inertia about the centre of gravity unchanged (Huygens-Steiner).",
    symbols={
        "r_G": "centre of gravity from the body's origin, body axes forward-starboard-down; m",
        "M_RB, C_RB": "rigid-body mass matrix and its Coriolis and centripetal matrix",
        "g": "restoring force and moment, body axes; N, N m",
    },
    parameters=(
        Parameter("x", "m", -0.2, 0.2, 0.0, 0.01, SOURCE, tolerance=TRIMMED),
        Parameter("y", "m", -0.2, 0.2, 0.0, 0.01, SOURCE, tolerance=TRIMMED),
        Parameter("z", "m", -0.2, 0.2, 0.0, 0.01, SOURCE, tolerance=RIGHTED),
    ),
    signature="a standing pitch or roll angle; a moment when accelerating; z changes the righting moment and its period",
    confused_with=("attitude_bias", "propeller_torque", "inertia_error", "payload_change"),
    separates="lie still: an attitude bias has no dynamics; a free roll gives the period",
    literature=("thesis, equations 3.11 and 3.14", "Fossen 2021, sections 3.3 and 4.1: kinetics about the origin, restoring forces"),
    separable=True,
    far=(-5.0, -2.0, 2.0, 5.0),  # a vehicle that tumbles in simulation shows no useful slope of its trim at the null value (chosen)
    family="trim",
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Move the centre of gravity."""
    moved = lanes.centre_of_gravity + np.stack([p["x"], p["y"], p["z"]], axis=1)
    centre, inertia = with_centre_of_gravity(lanes, moved)
    return replace(lanes, centre_of_gravity=centre, inertia=inertia)
