"""Vehicles of the independent plant, and labels and answers made up for its scoring."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from rovval.blind.cases.visibility import RecordedSpeeds
from rovval.blind.plant.dynamics import Plant
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.parameters import nominal_parameters
from rovval.blind.plant.scales import scales
from rovval.blind.plant.spec import AXES
from rovval.blind.planted.catalogue import catalogue
from rovval.blind.scoring import ground_truth

ROOT = Path(__file__).parents[2]
LIBRARY = ROOT / "src/rovval/vehicle/library"
CONTRACT = tuple(
    """added_mass linear_drag quadratic_drag cross_drag current_constant current_shear current_varying waves
density_gradient ground_effect wall_suction tether_drag tether_tension tether_snag buoyancy_error cg_offset payload_change
inertia_error thruster_degraded thruster_fault_onset thruster_deadband thruster_reversed reverse_asymmetry thrust_lag
inflow_loss crossflow_loss hull_interaction thruster_interaction thruster_misaligned propeller_torque rpm_scale voltage_sag
time_offset clock_drift dvl_scale dvl_misalignment dvl_lever_arm gyro_bias compass_deviation attitude_bias
velocity_filter_lag""".split()
)
HYPOTHESES = (  # that an answer made up here chooses from
    *(f"thruster_degraded[{t}]" for t in ("HFP", "HFS", "HAP", "HAS")),
    "buoyancy_error",
    "rpm_scale",
    "inflow_loss",
    "waves",
)


def vehicle_file(name: str) -> Path:
    """A vehicle of rovval's library, as the independent plant reads it."""
    return LIBRARY / f"{name}.toml"


def bare(path: Path, *, neutral: bool, drag: float = 1.0) -> Plant:
    """The nominal vehicle with its shafts as given (at zero)."""
    nominal = read_vehicle(path)
    p = nominal_parameters(nominal)
    p.lin, p.quad = drag * p.lin, drag * p.quad
    if neutral:
        p.volume = p.mass / p.density
    return Plant(p, [], scales(nominal), RecordedSpeeds(np.zeros(len(nominal.thrusters))), bottom=1e6)


def planted(name: str, target: str | None = None, **values: Any) -> dict[str, Any]:
    """What the plant's label says of an effect with these values."""
    row = catalogue()[name]
    size = {"wrench_rms": dict.fromkeys(AXES, 0.0) | {"heave": 5.0}}
    return {
        "name": name, "place": row.place, "form": row.form, "target": target, "severity": 1.0, "onset_s": None, "values": values,
        "realised": size,
    }  # fmt: skip


def label(*effects: dict[str, Any], left_out: bool = False) -> dict[str, Any]:
    """A label of these effects."""
    return {"effects": list(effects), "mission": "rich", "left_out": left_out, "without": []}


def cause(effect: str, probability: float = 0.9, group: tuple[str, ...] = (), **parameters: float) -> dict[str, Any]:
    """A cause as an answer names it, with intervals of 0.1 to both sides."""
    known = {k: {"value": v, "low": v - 0.1, "high": v + 0.1, "unit": "1"} for k, v in parameters.items()}
    return {
        "effect": effect,
        "group": [effect, *group],
        "probability": probability,
        "onset_s": known.pop("onset", {}).get("value"),
        "parameters": known,
        "shrinkage": {"total": 0.5, "low": 0.4, "high": 0.6, "of_explainable": 0.5},
    }


def answer(*causes: dict[str, Any], verdict: str = "", where: str = "heave", left: list[str] | None = None) -> dict[str, Any]:
    """An answer that names these causes."""
    document = {
        "run": "made-up", "vehicle": "merlin", "model": "fossen", "window_s": 10.0, "calibration_slop": 0.05,
        "verdict": verdict or ("explained" if causes else "no_gap"),
        "causes": list(causes),
        "ranking": [{"effect": n, "score": 0.1} for n in HYPOTHESES],
        "shrinkage": {"total": 0.5 if causes else 0.0, "low": 0.0, "high": 0.6, "of_explainable": 0.5},
        "gap": {
            "axes": {}, "change_points_s": [],
            "where": [{"axis": where, "regime": "u > 0.6 m/s", "share": 0.6, "time_share": 0.2, "lift": 3.0}],
        },
        "not_testable": [], "next_experiment": None,
        "left": {"axes": left, "depends_on": ["thrust of HFP"]} if left else None,
    }  # fmt: skip
    return {"document": document, "floors": {"ridge": "rpm_scale"}, "cpu_s": 1.0}


def answered_right(rng: np.random.Generator, many: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Labels over the library and an answerer that is always right."""
    labels, answers = {}, {}
    for i in range(many):
        name, _, target = HYPOTHESES[int(rng.integers(len(HYPOTHESES)))].partition("[")
        labels[str(i)] = label(planted(name, target.rstrip("]") or None, loss=0.5, relative=0.1, lift=1.0))
        answers[str(i)] = answer(cause(ground_truth.name(labels[str(i)]["effects"][0])))
    return labels, answers
