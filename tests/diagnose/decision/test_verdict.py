"""The verdict: what the library lacks is unknown and located."""

from __future__ import annotations

import pytest
from diagnose_case import merlin, own

from rovval.diagnose import diagnose
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
    ("planted", "axes"), [pytest.param("current_constant:north=0.15", {"surge", "sway"}, marks=pytest.mark.slow), ("thruster_degraded[HFP]:loss=0.5", {"yaw"})]
)
def test_a_withheld_effect_is_unknown_and_said_where(planted: str, axes: set[str]):
    document = written(diagnose([own((planted,), 5, 160.0)], merlin(), without=RELATIVES[planted]))
    assert document["verdict"] == "unknown" and document["causes"] == []
    assert document["left"]["axes"][0] in axes and "nothing in the library" in document["left"]["text"]
