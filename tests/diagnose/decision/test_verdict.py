"""The verdict: what the library lacks is unknown and located; causes that are not constant go, and the others stay only if the file fits without them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from diagnose_case import merlin, own

from rovval.diagnose import diagnose
from rovval.diagnose.decision.rejection import Assessment
from rovval.diagnose.decision.verdict import without_inconstant
from rovval.report.diagnosis.json import document as written

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


@pytest.mark.parametrize(("departure", "rejected"), [(1.0, False), (20.0, True)])
def test_causes_left_after_an_inconstant_one_went_need_a_file_within_its_tolerance(departure: float, rejected: bool):
    """Else what went had kept a coefficient within its tolerance, and another cause is there."""
    again: Any = Assessment(400.0, 100.0, 0.0, departure, True, False, False, False, (), None)  # type: ignore[arg-type]
    kept = without_inconstant(again, ("voltage_sag",))
    assert kept.rejected is rejected and kept.remainder and kept.inconstant == ("voltage_sag",)
    assert without_inconstant(replace(again, departure=0.0, inconstant=("waves",)), ("voltage_sag",)).rejected
