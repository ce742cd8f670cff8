"""Angles that contradict their rates: said of the log, and blamed on nothing."""

from __future__ import annotations

import numpy as np
from diagnose_case import merlin, own, with_values

from rovval.diagnose import diagnose
from rovval.report.diagnosis.json import document as written


def test_a_rate_that_contradicts_its_angle_is_said_and_no_coefficient_is_blamed():
    """A gyro that reads too little of fast turns, softly, so that no sample stands at a stop: inertia, drag or thrusters would else take the blame."""
    run = own((), 5, 160.0)
    document = written(diagnose([with_values(run, r=0.3 * np.tanh(run.get("r") / 0.3))], merlin()))
    assert not document["causes"] and document["verdict"] == "unknown"
    assert [(row["channel"], row["finding"]) for row in document["log"]] == [("psi", "contradicted")]
    assert "psi and r contradict each other by" in document["sentence"]


def test_a_faulty_sensor_of_the_library_is_no_contradiction():
    document = diagnose([own(("gyro_bias:r=0.02", "thruster_degraded[HFP]:loss=0.5"), 5, 160.0)], merlin()).document()
    assert {c["effect"] for c in document["causes"]} == {"gyro_bias", "thruster_degraded[HFP]"} and not document["log"]
