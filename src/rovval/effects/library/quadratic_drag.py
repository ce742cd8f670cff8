"""Quadratic drag differs from the vehicle file's on one axis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from rovval.core.channels import AXES
from rovval.effects.effect import TOGETHER, Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes, drag_departure, drag_tolerances
from rovval.vehicle.model import Vehicle


def _tolerance(parameter: Parameter, vehicle: Vehicle, axis: str) -> float:
    """Relative, of the quadratic drag that ``scale`` refers to."""
    return float(drag_tolerances(vehicle)[1][AXES.index(axis)])


EFFECT = Effect(
    name="quadratic_drag",
    title="Quadratic drag differs",
    place="vehicle",
    equation="tau_i = -(1 + scale) q_i |nu_r,i| nu_r,i; where the file has none, scale refers to the linear force at 1 m/s (rad/s); "
    "where it has less than a third of the median of its kind of axes, more of it refers to that third.",
    symbols={
        "tau_i": "drag on axis i, body axes; N, N m",
        "q_i": "quadratic drag coefficient of the vehicle's file; N s2/m2, N m s2/rad2",
        "nu_r,i": "velocity relative to the water on axis i, body axes; m/s, rad/s",
    },
    parameters=(
        Parameter(
            "scale", "1", -0.95, 9.0, 0.0, 0.3, "published BlueROV2 surge values run from 18 (Wu 2018) to 141 N s2/m2 (von Benzon 2022)",
            vanishes_at="low",
            tolerance=Tolerance(_tolerance, "the calibration tolerance, and how much of a drag that is known as a whole is quadratic (chosen)", loop_gain=1.0),
        ),
    ),
    per="axis",
    axes=AXES,
    groups=TOGETHER,
    signature="acts at top speed; changes the steady speed of long legs",
    confused_with=("linear_drag", "inflow_loss", "rpm_scale", "tether_drag"),
    separates="three speeds or more, both directions; the same speed at two thrusts (accelerating and steady)",
    literature=(
        "thesis, equation 3.13",
        "Fossen 2021, section 6.4: nonlinear damping",
        "Hoerner 1965: drag coefficients of bodies",
        "Caccia 2000: identification of linear and quadratic drag of open-frame vehicles",
    ),
    family="drag",
    in_file=True,
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Add the departure to the diagonal."""
    departure = drag_departure(lanes.vehicle, "quadratic_drag", p["scale"])
    return replace(lanes, quadratic_drag=lanes.quadratic_drag + departure[:, :, None] * np.eye(6))
