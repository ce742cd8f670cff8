"""The true value of a library parameter, where the plant's number maps onto it; everything else is not scored.

Where the plant's form differs from the library's, a row stands only if one number means the same in both (a total delay, a mean); a slow
test fits each on a vehicle without slop. Left out for failing it: ``thrust_lag`` (three stages: 0.73 s in all fits best as one of
0.46 s), ``velocity_filter_lag`` (two poles against a time constant and a dead time, of which only the sum means the same),
``thruster_interaction`` (a neighbour's share of the thrust against its share of the speed: 0.9 fits best as 0.66), and a
``thruster_reversed`` that turns back slower than its log says (a share of the speed against one of the thrust).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, radians, sin
from typing import Any

from rovval import effects
from rovval.blind.plant.spec import AXES
from rovval.effects.lanes import reference_added_mass, reference_drag
from rovval.vehicle.model import Vehicle

Values = Mapping[str, Any]
ANGLE = {"yaw": "yaw", "pitch": "pitch", "roll": "roll"}
RATE = {"roll": "p", "pitch": "q", "yaw": "r"}
TILT = {"roll": "phi", "pitch": "theta"}


def _drag(v: Values, target: str, vehicle: Vehicle) -> dict[str, float]:
    return {"scale": float(v["coefficient"]) / float(reference_drag(vehicle)[0][AXES.index(target)])}


def _mass(v: Values, target: str, vehicle: Vehicle) -> dict[str, float]:
    nominal = float(v["nominal"]) or float(reference_added_mass(vehicle)[AXES.index(target)])
    return {"scale": float(v["extra"]) / nominal}


def _late(v: Values, target: str, vehicle: Vehicle) -> dict[str, float]:
    return {"tau": -v["delay_s"]} if target == "thruster_feedback" else {"delay": v["delay_s"]}


def _compass(v: Values, target: str, vehicle: Vehicle) -> dict[str, float]:
    size, phase = radians(v["first_deg"]), float(v["phases"][0])
    return {"sine": size * cos(phase), "cosine": size * sin(phase)}


TABLE: Mapping[str, Callable[[Values, str, Vehicle], dict[str, float]]] = {
    "linear_drag": _drag,
    "added_mass": _mass,
    "inertia_error": lambda v, t, _: {"scale": v["relative"]} if t in RATE else {},
    "buoyancy_error": lambda v, t, _: {"force": v["lift"]},
    "cg_offset": lambda v, t, _: {"x" if t == "surge" else "y": v["offset"]},
    "payload_change": lambda v, t, _: {"mass": v["mass"], "weight": v["wet_weight"]},
    "thruster_degraded": lambda v, t, _: {"loss": v["loss"]},
    "thruster_fault_onset": lambda v, t, _: {"loss": v["loss"]},
    "thruster_reversed": lambda v, t, _: {"fraction": 1.0} if v.get("turn") == -1.0 else {},
    "reverse_asymmetry": lambda v, t, _: {"scale": -v["loss"]},
    "rpm_scale": lambda v, t, _: {"scale": 1.0 / (1.0 + v["relative"]) - 1.0},
    "time_offset": _late,
    "dvl_scale": lambda v, t, _: {"scale": v["relative"]},
    "dvl_misalignment": lambda v, t, _: {ANGLE[t]: v["angle_rad"]},
    "dvl_lever_arm": lambda v, t, _: dict(zip("xyz", v["arm"], strict=True)),
    "gyro_bias": lambda v, t, _: {RATE[t]: radians(v["bias_deg_s"])},
    "attitude_bias": lambda v, t, _: {TILT[t]: radians(v["tilt_deg"])},
    "compass_deviation": _compass,
    "current_constant": lambda v, t, _: {"north": v["north"], "east": v["east"]},
}


def true_values(effect: Mapping[str, Any], vehicle: Vehicle) -> dict[str, float]:
    """Library parameter -> true value, for the rows of the table; a value that the library's bounds shut out is not scored."""
    row = TABLE.get(effect["name"])
    if row is None:
        return {}
    bounds = {p.name: (p.low, p.high) for p in effects.load(effect["name"]).parameters if not p.sized}
    try:
        found = {k: float(x) for k, x in row(effect["values"], str(effect["target"]), vehicle).items()}
    except KeyError:  # a plant whose form has no such number does not state it
        return {}
    return {k: x for k, x in found.items() if bounds.get(k, (x, x))[0] <= x <= bounds.get(k, (x, x))[1]}
