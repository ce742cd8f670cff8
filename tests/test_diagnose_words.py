"""What a diagnosis says: degrees for angles, no certainty by rounding, and no "no gap" where most of the gap stays open."""

from __future__ import annotations

from typing import Any

import pytest

from report_cases import make_diagnosis
from rovval.diagnose.localise import Slice, worst
from rovval.diagnose.words import chance, open_gap, sentence
from rovval.report import diagnosis_html, diagnosis_markdown, diagnosis_words, table


def null(noise: float, slop: float) -> dict[str, Any]:
    d = make_diagnosis() | {"verdict": "no_gap", "causes": [], "left": None, "next_experiment": None}
    return d | {"detection": {"noise": noise, "slop": slop}}


@pytest.mark.parametrize(("noise", "slop", "still_open"), [(0.9, 0.0, False), (0.1, 0.75, False), (0.04, 0.26, True)])
def test_a_gap_that_nothing_accounts_for_is_not_called_none(noise, slop, still_open):
    d = null(noise, slop)
    assert open_gap(d) is still_open
    assert ("account for only 30 % of the gap" in sentence(d)) is still_open
    assert ("No gap beyond noise" in sentence(d)) is not still_open
    assert diagnosis_words.facts(d)["verdict"] == ("no cause named" if still_open else "no gap beyond noise and slop")
    page = diagnosis_html.text(d)
    assert ("is neither noise nor slop" in page) is still_open and "</i>with the effects found" not in page


def test_angles_are_said_in_degrees():
    d = make_diagnosis()
    d["gap"]["axes"]["yaw"] |= {"share": 0.9, "rms": 0.1}
    d["causes"][0]["parameters"] = {"roll": {"value": 0.01, "low": 0.005, "high": 0.02, "unit": "rad"}}
    said = sentence(d)
    assert "yaw (5.73 deg/s rms" in said and "roll = 0.573 [0.286, 1.15] deg;" in said and "rad" not in said


def test_no_probability_is_rounded_to_certainty():
    assert [chance(p) for p in (0.5, 0.99, 0.9951, 1.0)] == ["0.50", "0.99", "> 0.99", "> 0.99"]


def test_the_answer_stands_first_on_the_page_and_once():
    d = make_diagnosis() | {"sentence": "Gap: large. Cause: waves. Left: a little.", "answer": "Cause: waves."}
    assert diagnosis_words.headline(d) == ["Cause: waves.", "Gap: large. Left: a little."]
    assert diagnosis_words.sentences(d) == [d["sentence"]]


def test_rounds_say_what_they_asked_and_whether_they_named():
    def row(name: str) -> dict[str, Any]:
        return {"effect": name, "evidence": 50.0, "gain": 0.3}

    d = make_diagnosis() | {"finalists": [[row("inflow_loss"), row("quadratic_drag[surge]"), row("waves")], [row("waves")], []]}
    for text in (diagnosis_html.text(d), diagnosis_markdown.text(d), table.diagnosis_text(d)):
        assert "eside inflow_loss: none was named" in text and "30 %" in text
    assert "cannot be told from inflow_loss" in diagnosis_html.text(d)


def test_slices_of_one_quantity_are_named_once_an_axis():
    def slice_(axis: str, regime: str, share: float) -> Slice:
        return Slice(axis, regime, share, 0.2, share / 0.2, 1.5, 4.0, 9)

    found = [slice_("yaw", "u < -0.3 m/s", 0.6), slice_("yaw", "|u| > 0.3 m/s", 0.7), slice_("sway", "|u| > 0.3 m/s", 0.5), slice_("yaw", "depth > 3 m", 0.4)]
    named = [(s.axis, s.regime) for s in worst(found, {"yaw": 1.0, "sway": 0.5})]
    assert named == [("yaw", "|u| > 0.3 m/s"), ("yaw", "depth > 3 m"), ("sway", "|u| > 0.3 m/s")]
