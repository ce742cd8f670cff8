"""What keeps a diagnosis honest: slop that settles by re-simulation, strain, generic forces, axes that an autopilot steadies."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from diagnose_case import bare, merlin, own

from rovval import vehicle
from rovval.core.data import Run
from rovval.diagnose import diagnose
from rovval.diagnose.decision.rejection import Assessment
from rovval.diagnose.decision.verdict import without_inconstant
from rovval.report.diagnosis.json import document as written
from rovval.vehicle.model import allocation

RELATIVES = {  # withheld with the effect: the same law, or one that is it at some value of its parameters
    "current_constant:north=0.15": ("current_constant", "current_varying", "current_shear", "tether_tension", "tether_snag"),
    "thruster_degraded[HFP]:loss=0.5": (
        "thruster_degraded",
        "thruster_fault_onset",
        "thruster_reversed",
        "thruster_interaction",
    ),
}


@pytest.mark.parametrize(
    ("planted", "axes"), [("current_constant:north=0.15", {"surge", "sway"}), ("thruster_degraded[HFP]:loss=0.5", {"yaw"})]
)
def test_a_withheld_effect_is_unknown_and_said_where(planted: str, axes: set[str]):
    document = written(diagnose([own((planted,), 5, 160.0)], merlin(), without=RELATIVES[planted]))
    assert document["verdict"] == "unknown" and document["causes"] == []
    assert document["left"]["axes"][0] in axes and "no effect of the library" in document["left"]["text"]


def steadied(gain: float) -> Run:
    """A BlueROV2 that rolls in the swell while its thrusters give ``gain`` times the righting moment against it."""
    v = vehicle.load("bluerov2_heavy")
    n = 1200
    t = 0.1 * np.arange(n)
    roll = 0.1 * np.sin(0.9 * t) * np.cos(0.13 * t)
    righting = v.weight * 0.01
    unit = np.linalg.pinv(allocation(v)) @ np.array([0.0, 0.0, 0.0, -righting, 0.0, 0.0])
    thrust = gain * roll[:, None] * unit
    speed = np.sign(thrust) * np.sqrt(
        np.abs(thrust) / np.where(thrust >= 0, [x.k_pos for x in v.thruster], [x.k_neg for x in v.thruster])
    )
    values = {c: np.zeros(n) for c in ("u", "v", "w", "q", "r", "x", "y", "z", "theta", "psi")}
    values |= {"phi": roll, "p": np.gradient(roll, 0.1)} | {f"n:{x.name}": speed[:, i] / 60.0 for i, x in enumerate(v.thruster)}
    return bare(values, v, f"steadied {gain}")


@pytest.mark.parametrize(("strain", "stands"), [(4.1, True), (5.7, False)])
def test_what_stands_without_an_unsteady_cause_leaves_the_file_within_its_tolerance(strain: float, stands: bool):
    """Else what went had kept a coefficient within its tolerance, and another cause is there."""
    again: Any = Assessment(400.0, 100.0, 0.0, strain, True, False, False, False, (), None)  # type: ignore[arg-type]
    kept = without_inconstant(again, ("voltage_sag",))
    assert kept.rejected is not stands and kept.remainder and kept.inconstant == ("voltage_sag",)
    assert without_inconstant(replace(again, departure=0.0, inconstant=("waves",)), ("voltage_sag",)).rejected


