"""Indications: an effect that came near a cause, and a fault that the sensors show, where no cause is named."""

from __future__ import annotations

from typing import Any

import pytest
from report_cases import detection, make_diagnosis

from rovval.diagnose import Diagnosis
from rovval.diagnose.decision.indications import indications
from rovval.diagnose.decision.unexplained import Accounted
from rovval.diagnose.residuals.sensor_faults import FittedFault

KNOWN = Accounted(noise=0.1, tolerance=0.5, departure=1.0)


def fault(name: str, value: float, share: float = 0.8, significant: bool = True) -> FittedFault:
    return FittedFault(name, value, value - 0.001, value + 0.001, 0.0, "", share, significant)


def test_an_effect_that_takes_more_than_tolerances_do_is_beyond_them():
    found = indications([("waves", 9.0, 0.05), ("inflow_loss", 40.0, 0.8)], KNOWN, ())
    assert found.nearest and found.nearest.effect == "inflow_loss" and found.nearest.lacks == () and found.beyond_tolerance
    assert found.within_tolerance == pytest.approx(0.5)


def test_an_effect_that_tolerances_may_be_is_near_but_not_beyond_them():
    found = indications([("inflow_loss", 8.0, 0.4)], KNOWN, ())
    assert found.nearest and found.nearest.lacks == ("reduction",) and not found.beyond_tolerance


def test_tolerances_that_the_fit_leaves_far_behind_bring_nothing():
    assert indications([("inflow_loss", 40.0, 0.4)], Accounted(0.1, 0.5, 20.0), ()).beyond_tolerance


@pytest.mark.parametrize("candidates", [[], [("waves", 0.1, 0.9)], [("waves", 500.0, -0.01)]])
def test_reduction_without_evidence_and_evidence_without_reduction_are_not_near(candidates: list[tuple[str, float, float]]):
    found = indications(candidates, KNOWN, ())
    assert found.nearest is None and found.fault is None and not found.beyond_tolerance


def test_of_several_faults_that_account_for_as_much_the_one_furthest_beyond_its_tolerance_is_told():
    small, large = fault("gyro_bias.p", 1e-5), fault("gyro_bias.r", 0.1)
    found = indications((), KNOWN, [small, fault("dvl_scale.scale", 0.5, share=0.2), large, fault("gyro_bias.q", 9.0, significant=False)])
    assert found.fault == large and found.fault_departure > 1.0 and found.beyond_tolerance
    assert not indications((), KNOWN, [small]).beyond_tolerance


def test_of_a_document_from_before_they_were_written_they_follow_from_what_it_holds():
    candidates = [[{"effect": "inflow_loss", "evidence": 40.0, "gain": 0.8}]]
    older: dict[str, Any] = make_diagnosis() | {"verdict": "no_gap", "causes": [], "parity": [], "detection": detection(0.1, 0.5), "finalists": candidates}
    read = Diagnosis.read(older)
    assert read.indications and read.indications.nearest and read.indications.nearest.effect == "inflow_loss" and read.indications.beyond_tolerance
    assert Diagnosis.read(read.document()) == read
    assert Diagnosis.read(make_diagnosis()).indications is None, "causes are named"
