"""What a diagnosis says: degrees for angles, no certainty by rounding, and no "no gap" where most of the gap stays open."""

from __future__ import annotations

from typing import Any

import pytest
from report_cases import make_diagnosis

from rovval.diagnose.result.attribution import Slice, worst
from rovval.report.diagnosis import html as diagnosis_html
from rovval.report.diagnosis import markdown as diagnosis_markdown
from rovval.report.diagnosis import terminal as diagnosis_terminal
from rovval.report.diagnosis import words as diagnosis_words
from rovval.report.diagnosis.nothing import unexplained
from rovval.report.diagnosis.sentence import chance, open_gap, sentence


def null(noise: float, slop: float) -> dict[str, Any]:
    d = make_diagnosis() | {"verdict": "no_gap", "causes": [], "left": None, "next_experiment": None}
    return d | {"detection": {"noise": noise, "slop": slop}}


@pytest.mark.parametrize(("noise", "slop", "still_open"), [(0.9, 0.0, False), (0.1, 0.75, False), (0.04, 0.26, True)])
def test_a_gap_that_nothing_accounts_for_is_not_called_none(noise, slop, still_open):
    d = null(noise, slop)
    assert open_gap(d) is still_open
    assert ("account for only 30 % of the squared gap" in sentence(d)) is still_open
    assert ("No gap beyond noise" in sentence(d)) is not still_open
    assert diagnosis_words.facts(d)["verdict"] == ("no cause named" if still_open else "no gap beyond noise and slop")
    page = diagnosis_html.text(d)
    assert ("is neither noise nor slop" in page) is still_open and "</i>with the effects found" not in page


@pytest.mark.parametrize(("strain", "still_open"), [(4.9, False), (6.6, True)])
def test_slop_accounts_for_a_gap_only_at_its_stated_size(strain, still_open):
    d = null(0.04, 0.64)
    d["detection"]["strain"] = strain
    assert open_gap(d) is still_open
    text = "account for only 4 % of the squared gap (for 64 % if a coefficient were 6.6 times its tolerance off): no effect"
    assert (text in sentence(d)) is still_open
    d |= weighed(0.6, 1600.0)
    assert ("slop of the stated size explains 64 %" in sentence(d)) is not still_open


def test_an_open_gap_may_be_what_pushed_unlogged():
    """The largest force and the largest moment; a document that knows of none says only that it may be."""
    d = null(0.04, 0.26)
    assert "a disturbance that nobody logged (the fit allows for some, largest: sway 4 N and yaw 0.012 N m rms), an effect" in sentence(d)
    d["disturbance"] = {"surge": {"rms": 1234.5, "unit": "N", "memory_s": 1.0}, "yaw": {"rms": 0.0, "unit": "N m", "memory_s": 0.0}}
    assert "largest: surge 1234 N rms)" in sentence(d)
    for old in (d | {"disturbance": {}}, {k: v for k, v in d.items() if k != "disturbance"}):
        assert "It may be a disturbance, an effect in events" in sentence(old)
    assert "nobody logged" not in sentence(null(0.9, 0.0))


def weighed(gain: float, evidence: float) -> dict[str, Any]:
    return {"finalists": [[{"effect": "inflow_loss", "gain": gain, "evidence": evidence}, {"effect": "waves", "gain": 0.1, "evidence": 9.0}]]}


@pytest.mark.parametrize(
    ("gain", "evidence", "slop", "said", "seen"),
    [
        (0.4, 4.44, 0.45, "but its evidence of 4.4 is short of the 6 asked for, and calibration slop of the stated size explains 45 %.", False),
        (0.6, 30.0, 0.55, "but it does not pass all the checks that a cause must pass.", True),
        (0.2, 8.0, 0.7, "", False),
        (0.5, 1.0, 0.7, "", False),
    ],
)  # fmt: skip
def test_what_came_near_is_told_and_called_no_cause(gain, evidence, slop, said, seen):
    d = null(0.1, slop) | weighed(gain, evidence) | {"parity": []}
    near = f"Nearest to a cause, and not shown to be one, is inflow_loss: by itself it would close {100 * gain:.0f} % of the squared gap, {said}"
    assert (near in sentence(d)) is bool(said) and ("Nearest" in sentence(d)) is bool(said)
    assert ("explains anything" in sentence(d)) is not bool(said) and "No gap beyond noise" in sentence(d)
    for text in (diagnosis_html.text(d), diagnosis_markdown.text(d), diagnosis_terminal.text(d)):
        assert ("no cause named" in text) is seen and ("Nearest to a cause" in " ".join(text.split())) is bool(said)


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.397, ", but # 0.397 [0.393, 0.401] deg/s, 3.5 times its tolerance."), (0.05, "; # 0.05 [0.046, 0.054] deg/s, within its tolerance.")],
)
def test_a_fault_that_the_sensors_show_does_not_hide_under_no_gap(value, said):
    row = make_diagnosis()["parity"][0] | {"fault": "gyro_bias.r", "share": 0.8, "significant": True}
    d = null(0.2, 0.7) | {"parity": [row | {k: (value + off) * 3.14159265 / 180 for k, off in (("value", 0.0), ("low", -0.004), ("high", 0.004))}]}
    assert said.replace("#", "the sensors' own check, without any dynamics, shows gyro_bias.r =") in sentence(d)
    beyond = value > 0.2
    assert (diagnosis_words.facts(d)["verdict"] == "no cause named") is beyond and ("Nothing to blame" in diagnosis_html.text(d)) is not beyond
    d["detection"] = {"noise": 0.1, "slop": 0.1}
    assert "too little of. The sensors' own check" in sentence(d)
    d["parity"][0]["significant"] = False
    assert "own check" not in sentence(d)


def test_a_cause_that_leaves_the_simulated_motion_is_said_to():
    d = make_diagnosis()
    kinematic = "seen by the kinematic checks alone; it does not change the simulated motion"
    for effect, said in (("attitude_bias", kinematic), ("waves", "it leaves the squared gap")):
        d["causes"][0] |= {"effect": effect, "shrinkage": {"total": -0.0006, "low": -0.004, "high": 0.003, "axes": {}}}
        for text in (sentence(d), diagnosis_html.text(d), diagnosis_markdown.text(d), diagnosis_terminal.text(d)):
            assert said in text and "-0 " not in text and "-0," not in text and "-0]" not in text
    d["causes"][0]["shrinkage"] |= {"total": 0.3}
    assert "by itself it shrinks the squared gap by 30 % [0, 0] on held-out windows" in sentence(d)


def test_a_parameter_that_nothing_moved_is_not_told():
    """Of a tether without a log of its length, the drag per length."""
    d = make_diagnosis()
    rest = {"unit": "N s2/m3", "null": 0.0, "low": 0.0}
    d["causes"][0]["parameters"] = {"coefficient": rest | {"value": 300.0, "high": 400.0}, "per_length": rest | {"value": 0.0, "high": 14.2}}
    for text in (sentence(d), diagnosis_html.text(d), diagnosis_markdown.text(d), diagnosis_terminal.text(d)):
        assert "coefficient" in text and "per_length" not in text
    d["causes"][0]["parameters"]["per_length"]["value"] = 1.5
    assert "per_length" in sentence(d)


def test_shrinkage_is_said_to_be_of_squares_with_the_rms_beside_it():
    d = make_diagnosis()
    d["causes"][0]["shrinkage"]["axes"] = {"surge": 0.75}
    d["gap"]["axes"]["surge"]["rms"] = 0.08
    for text in (diagnosis_html.text(d), diagnosis_markdown.text(d)):
        assert "0.080 to 0.040 m/s" in text and "squared gap less by" in text
    for text in (sentence(d), diagnosis_terminal.text(d)):
        assert "squared gap" in text and "the gap shrinks" not in text


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
    for text in (diagnosis_html.text(d), diagnosis_markdown.text(d), diagnosis_terminal.text(d)):
        assert "eside inflow_loss: none was named" in text and "30 %" in text
    assert "cannot be told from inflow_loss" in diagnosis_html.text(d)


def test_slices_of_one_quantity_are_named_once_an_axis():
    def slice_(axis: str, regime: str, share: float) -> Slice:
        return Slice(axis, regime, share, 0.2, share / 0.2, 1.5, 4.0, 9)

    found = [slice_("yaw", "u < -0.3 m/s", 0.6), slice_("yaw", "|u| > 0.3 m/s", 0.7), slice_("sway", "|u| > 0.3 m/s", 0.5), slice_("yaw", "depth > 3 m", 0.4)]
    named = [(s.axis, s.regime) for s in worst(found, {"yaw": 1.0, "sway": 0.5})]
    assert named == [("yaw", "|u| > 0.3 m/s"), ("yaw", "depth > 3 m"), ("sway", "|u| > 0.3 m/s")]


def test_an_open_gap_is_an_unknown_effect_in_the_document():
    left: dict[str, Any] = {"axes": ["surge"], "depends_on": [], "share": 0.0, "departed": None, "inconstant": [], "accounted": 0.3}
    d = null(0.04, 0.26) | {"verdict": "unknown", "left": left}
    left["text"] = unexplained(d)
    assert left["text"].startswith("noise and a calibration slop of 5 % account for only 30 % of the squared gap")
    assert "Unknown effect: noise and a calibration slop" in sentence(d) and not open_gap(d)


@pytest.mark.parametrize(("low", "said"), [(0.1, False), (-0.3, True)])
def test_what_is_closed_beside_slop_is_said_where_the_gap_stays_open_without_it(low, said):
    document = make_diagnosis()
    filed = document["shrinkage"] | {"total": (low + 0.1) / 2, "low": low, "high": 0.1 + low}
    document |= {"shrinkage": filed, "beside_slop": {"total": 0.93, "low": 0.9, "high": 0.95}}
    assert ("93 % [90, 95] of what those leave" in sentence(document)) is said
    assert ("93 % [90, 95] of what those leave" in diagnosis_markdown.text(document)) is said


def test_windows_in_which_the_simulation_stops_are_told():
    d = make_diagnosis() | {"log": [], "windows": 30}
    assert "of 30 windows" not in sentence(d | {"windows_stopped": 0}) + sentence(d)
    assert "Of the log: 3 of 30 windows, in which the simulation of the vehicle as it is filed stops, were left out." in sentence(d | {"windows_stopped": 3})
