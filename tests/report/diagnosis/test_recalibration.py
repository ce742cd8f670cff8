"""A vehicle's file that is off in many coefficients at once: every format tells it, with the command that mends it, and calls it no cause."""

from __future__ import annotations

from typing import Any

import pytest
from page_case import formats
from report_cases import diagnosis

from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis.sentences.sentence import sentence

ROW = {"low": -0.95, "high": -0.7, "unit": "1", "was": 0.0, "tolerance": 0.05, "beyond": True, "at_bound": False, "of_cause": False}


def off(causes: bool) -> Diagnosis:
    """A diagnosis with many coefficients off, beside a cause or none."""
    rows = {f"quadratic_drag[{axis}].scale": ROW | {"value": -0.845, "departure": -16.9} for axis in ("surge", "sway", "heave", "yaw")}
    axes = {"axes": {"surge": 0.7, "sway": -0.41}, "axes_interval": {"surge": {"low": 0.6, "high": 0.8}}}
    shrunk = {"total": 0.68, "low": 0.61, "high": 0.72, "of_explainable": 0.7, **axes}
    found: dict[str, Any] = {
        "parameters": rows, "beyond": list(rows), "shrinkage": shrunk, "held_out": "runs", "harm": [{"axis": "sway", "change": 0.41}],
        "command": "rovval fit dive <a> --parameters 'x'",
    }  # fmt: skip
    return diagnosis(calibration=found) if causes else diagnosis(calibration=found, verdict="unknown", causes=[])


@pytest.mark.parametrize("causes", [True, False])
def test_every_format_tells_it_and_says_that_it_is_no_cause(causes: bool) -> None:
    d = off(causes)
    said = sentence(d)
    assert ("No one effect is shown to explain the rest: 4 coefficients" in said) is causes
    assert ("inflow_loss among them" in said) is causes
    assert "quadratic_drag[surge].scale = -0.845 [-0.950, -0.700] (17 times its tolerance)" in said
    assert "the error falls to 57 % [53, 62] on runs left out of the fit (worse: in sway it grows to 119 %)" in said
    page, markdown, plain = formats(d)
    for text in (page, markdown, plain):
        assert "any coefficients off at once" in text and "17 times its tolerance" in text and "68 % [61, 72]" in text
    assert "rovval fit dive &lt;a&gt;" in page and "rovval fit dive <a>" in markdown


def test_without_it_nothing_is_said() -> None:
    for d in (diagnosis(), diagnosis(calibration=None)):
        for text in (sentence(d), *formats(d)):
            assert "off at once" not in text
