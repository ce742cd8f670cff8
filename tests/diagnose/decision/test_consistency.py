"""Angles that contradict their rates: said of the log, and blamed on nothing."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own, with_values

from rovval.diagnose import diagnose
from rovval.diagnose.decision.consistency import inconsistencies
from rovval.diagnose.problem.problem import pose
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.report.diagnosis.json import document as written


@pytest.mark.slow
def test_a_rate_that_contradicts_its_angle_is_said_and_no_coefficient_is_blamed():
    """A gyro that reads too little of fast turns, softly, so that no sample stands at a stop: inertia, drag or thrusters would else take the blame."""
    run = own((), 5, 160.0)
    document = written(diagnose([with_values(run, r=0.3 * np.tanh(run.get("r") / 0.3))], merlin()))
    assert not document["causes"] and document["verdict"] == "unknown"
    assert [(row["channel"], row["finding"]) for row in document["log"]] == [("psi", "contradicted")]
    assert "psi and r contradict each other by" in document["sentence"]


@pytest.mark.slow
def test_a_faulty_sensor_of_the_library_is_no_contradiction():
    document = diagnose([own(("gyro_bias:r=0.02", "thruster_degraded[HFP]:loss=0.5"), 5, 160.0)], merlin()).document()
    assert {c["effect"] for c in document["causes"]} == {"gyro_bias", "thruster_degraded[HFP]"} and not document["log"]


def test_an_instrument_that_lost_its_way_once_contradicts_nothing():
    """A heading that is half a turn off for two seconds is one bad window; one that creeps away from its gyro in all of them contradicts the log."""
    run = own((), 5, 160.0)
    t = np.arange(len(run)) * run.dt
    once, always = run.get("psi") + np.where((t > 70.0) & (t < 72.0), 3.0, 0.0), run.get("psi") + 0.5 * np.sin(t / 2.0)
    for psi, found in ((once, []), (always, ["psi"])):
        windows, _ = cut([with_values(run, psi=psi)], merlin(), "fossen", 10.0)
        problem = pose(windows, Columns((), ()), 0.05)
        assert [one.angle for one in inconsistencies(problem, {"yaw": 1.0})] == found
