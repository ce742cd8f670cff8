"""Linear drag differs from the vehicle file's on one axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.channels import AXES
from rovval.effects.effect import TOGETHER, Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes, drag_departure, drag_tolerances
from rovval.vehicle.model import Vehicle

STEADIED = 2.0  # power of (1 + loop gain): under an autopilot the thrusters damp what a disturbance moves, and the hull's own damping shows as little
# as the variance of the replay is large (healthy BlueROV2s of an outside plant: by 0.3 N m s/rad off, 2 to 3 standard deviations with 1, and one with 2)


def _tolerance(parameter: Parameter, vehicle: Vehicle, axis: str) -> float:
    """Relative, of the linear drag that ``scale`` refers to."""
    return float(drag_tolerances(vehicle)[0][AXES.index(axis)])


EFFECT = Effect(
    name="linear_drag",
    title="Linear drag differs",
    place="vehicle",
    equation="tau_i = -(1 + scale) d_i nu_r,i; where the file has none, scale refers to the quadratic force at 0.1 m/s (rad/s); "
    "where it has less than a third of the median of its kind of axes, more of it refers to that third.",
    symbols={
        "tau_i": "drag on axis i, body axes; N, N m",
        "d_i": "linear drag coefficient of the vehicle's file; N s/m, N m s/rad",
        "nu_r,i": "velocity relative to the water on axis i, body axes; m/s, rad/s",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.95, 9.0, 0.0, 0.3, "published BlueROV2 surge values run from 4 (Wu 2018) to 14 N s/m (von Benzon 2022)",
            vanishes_at="low",
            tolerance=Tolerance(_tolerance, "the calibration tolerance, and how much of a drag known as a whole is linear (chosen)", loop_gain=STEADIED),
        ),
    ),
    per="axis",
    axes=AXES,
    groups=TOGETHER,
    signature="acts at low speed; changes the exponential tail of a coast-down",
    confused_with=("quadratic_drag", "current_constant", "tether_drag", "rpm_scale"),
    separates="coast-down with thrust off, from several speeds",
    literature=(
        "thesis, equation 3.13",
        "Fossen 2021, section 6.4: linear viscous damping",
        "Caccia 2000: identification of linear and quadratic drag of open-frame vehicles",
    ),
    family="drag",
    absent_in=("freefloating",),
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Add the departure to the diagonal."""
    departure = drag_departure(lanes.vehicle, "linear_drag", p["scale"])
    return replace(lanes, linear_drag=lanes.linear_drag + departure[:, :, None] * np.eye(6))
