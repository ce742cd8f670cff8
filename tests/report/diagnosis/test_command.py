"""The commands that write a recalibrated vehicle, by names and as they were typed."""

from __future__ import annotations

import shlex

import pytest
from report_cases import make_diagnosis

from rovval.diagnose import Diagnosis
from rovval.report.diagnosis.command import Typed, recalibrate

SHRUNK = {"total": 0.7, "low": 0.6, "high": 0.8, "of_explainable": 0.7}
NAMES = ("quadratic_drag[surge].scale", "buoyancy_error.force")


def found(diagnosed: tuple[str, ...] = (), model: str = "fossen") -> Diagnosis:
    """A diagnosis of two runs with a recalibration."""
    tuned = {
        "parameters": {}, "beyond": [], "shrinkage": SHRUNK, "held_out": "runs", "harm": [], "fitted": list(NAMES), "diagnosed": list(diagnosed),
    }  # fmt: skip
    return Diagnosis.read(make_diagnosis() | {"runs": ["dive-1", "a dive"], "model": model, "calibration": tuned})


def test_fit_is_asked_for_the_parameters_by_run_and_vehicle():
    assert shlex.split(recalibrate(found())) == [
        "rovval", "fit", "dive-1", "a dive", "--vehicle", "merlin", "--parameters", ",".join(NAMES), "--out", "calibrated.toml",
    ]  # fmt: skip


def test_what_only_a_diagnosis_finds_is_written_first():
    first, then = recalibrate(found(("tether_snag",), "uuv")).split(" && ")
    assert shlex.split(first)[1:] == [
        "diagnose", "dive-1", "a dive", "--vehicle", "merlin", "--model", "uuv", "--write-vehicle", "mended.toml",
    ]  # fmt: skip
    assert "--vehicle mended.toml --model uuv" in then


def test_it_is_told_as_it_was_typed():
    typed = Typed({"dive-1": "my dives/one.csv", "a dive": "two.csv"}, "my rov.toml", ("--window", "5"))
    assert shlex.split(recalibrate(found(), typed))[:8] == [
        "rovval", "fit", "my dives/one.csv", "two.csv", "--window", "5", "--vehicle", "my rov.toml",
    ]  # fmt: skip


@pytest.mark.parametrize("typed", [None, Typed(vehicle="my rov.toml")])
def test_without_a_recalibration_there_is_no_command(typed: Typed | None):
    assert recalibrate(Diagnosis.read(make_diagnosis()), typed) == ""
