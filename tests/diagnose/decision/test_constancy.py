"""Constancy: a true cause has one size along the log; what varies is something else."""

from __future__ import annotations

from pathlib import Path

import pytest
from diagnose_case import foreign, merlin, posed

from rovval.diagnose import diagnose
from rovval.diagnose.decision.constancy import variation
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.problem.problem import Problem
from rovval.report.diagnosis.json import document as written


def fitted(problem: Problem, library: list[Hypothesis], name: str) -> float:
    """Evidence that the size of a cause, fitted by itself, varies."""
    h = next(h for h in library if h.name == name)
    return variation(problem, map_fit(problem, problem.origin, h.slots), [h])


@pytest.mark.parametrize(("planted", "name"), [("inflow_loss:loss=0.4", "inflow_loss"), ("thruster_degraded[VAC]:loss=0.4", "thruster_degraded[VAC]")])
def test_a_cause_that_is_there_holds_still(planted: str, name: str):
    assert fitted(*posed((planted,)), name) < 0.0


def test_a_loss_that_begins_in_mid_log_varies_as_one_that_was_always_there():
    assert fitted(*posed(("thruster_fault_onset[VAC]:loss=0.9,onset=60",)), "thruster_degraded[VAC]") > 2.0


@pytest.mark.slow
def test_a_thruster_that_drops_out_now_and_then_is_put_down_to_no_other(tmp_path: Path):
    """The library has nothing that comes and goes; its nearest relative is a fault of the same thruster."""
    document = written(diagnose([foreign(tmp_path, (("intermittent_thruster", "VAC", 1.5),), 77)], merlin()))
    assert all(c["effect"].endswith("[VAC]") for c in document["causes"]) and document["verdict"] != "no_gap"
