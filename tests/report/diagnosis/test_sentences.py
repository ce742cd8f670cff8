"""What a diagnosis says: the answer first, degrees for angles, no certainty by rounding, and no "no gap" where something was seen."""

from __future__ import annotations

from typing import Any

import pytest
from page_case import formats
from report_cases import detection, diagnosis, make_diagnosis

from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis import html
from rovval.report.diagnosis.json import document
from rovval.report.diagnosis.sentence import headline, sentence, verdict


def null(noise: float, tolerance: float, departure: float = 0.0, **changes: Any) -> Diagnosis:
    """No cause, with the shares of the gap that noise and tolerances account for."""
    parts: dict[str, Any] = {"verdict": "no_gap", "causes": [], "left": None, "next_experiment": None, "manoeuvre": None, "parity": [], "harm": []}
    return diagnosis(**parts | {"detection": detection(noise, tolerance, departure)} | changes)


def still_open(noise: float, tolerance: float, departure: float = 0.0, accounted: float = 0.3, **changes: Any) -> Diagnosis:
    """A gap that stays open: noise and tolerances account for too little of it."""
    left = {"axes": ["surge"], "depends_on": [], "accounted": accounted}
    return null(noise, tolerance, departure, **{"verdict": "unknown", "left": left} | changes)


def weighed(gain: float, evidence: float) -> list[list[dict[str, Any]]]:
    return [[{"effect": "inflow_loss", "gain": gain, "evidence": evidence}, {"effect": "waves", "gain": 0.1, "evidence": 9.0}]]


def test_no_gap_is_said_to_be_within_noise_and_tolerance():
    d = null(0.9, 0.0)
    assert "No gap beyond noise and a calibration tolerance of 5 %: no effect of the library" in sentence(d)
    assert verdict(d) == "no gap beyond noise and tolerance" and "Nothing to blame" in html.text(d)
    assert "nobody logged" not in sentence(d) and "with the effects found" not in html.text(d)


def test_a_gap_that_nothing_accounts_for_is_unknown_and_says_how_much_is_accounted_for():
    d = still_open(0.04, 0.26)
    assert "Unknown effect: noise and a calibration tolerance of 5 % account for only 30 % of the squared gap: no effect" in sentence(d)
    assert verdict(d) == "unknown effect" and document(d)["left"]["text"].startswith("noise and a calibration tolerance of 5 %")


def test_tolerances_that_were_overdrawn_are_said_not_to_count():
    d = still_open(0.04, 0.64, 6.6, accounted=0.04)
    assert "account for only 4 % of the squared gap (for 64 % if a coefficient were 6.6 times its tolerance off): no effect" in sentence(d)
    assert "take away 64 %" in sentence(null(0.04, 0.64, 4.9, finalists=weighed(0.6, 1600.0)))
    assert "take away" not in sentence(null(0.04, 0.64, 6.6, finalists=weighed(0.6, 1600.0)))


def test_an_open_gap_may_be_what_pushed_unlogged():
    """The largest force and the largest moment; a document that knows of none says only that it may be."""
    said = sentence(still_open(0.04, 0.26))
    assert "a disturbance that nobody logged (the fit allows for some, largest: sway 4.0 N and yaw 0.012 N m rms), an effect" in said
    pushed = {"surge": {"rms": 1234.5, "unit": "N", "memory_s": 1.0}, "yaw": {"rms": 0.0, "unit": "N m", "memory_s": 0.0}}
    assert "largest: surge 1234 N rms)" in sentence(still_open(0.04, 0.26, disturbance=pushed))
    assert "It may be a disturbance, an effect in events" in sentence(still_open(0.04, 0.26, disturbance={}))


@pytest.mark.parametrize(
    ("gain", "evidence", "tolerance", "said", "seen"),
    [
        (0.4, 4.44, 0.45, "but its evidence of 4.4 is short of the 6 asked for, and coefficients within their tolerances take away 45 %.", False),
        (0.6, 30.0, 0.55, "but it does not pass all the checks that a cause must pass.", True),
        (0.2, 8.0, 0.7, "", False),
        (0.5, 1.0, 0.7, "", False),
    ],
)  # fmt: skip
def test_what_came_near_is_told_and_called_no_cause(gain, evidence, tolerance, said, seen):
    d = null(0.1, tolerance, finalists=weighed(gain, evidence))
    near = f"Nearest to a cause, and not shown to be one, is inflow_loss: by itself it would shrink the squared gap by {100 * gain:.0f} %, {said}"
    assert (near in sentence(d)) is bool(said) and ("Nearest" in sentence(d)) is bool(said)
    assert ("explains anything" in sentence(d)) is not bool(said) and "No gap beyond noise" in sentence(d)
    for text in formats(d):
        assert ("no cause named" in text) is seen and ("Nearest to a cause" in text) is bool(said)


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.397, ", but # 0.397 [0.393, 0.401] deg/s, 3.5 times its tolerance."), (0.05, "; # 0.0500 [0.0460, 0.0540] deg/s, within its tolerance.")],
)
def test_a_fault_that_the_sensors_show_does_not_hide_under_no_gap(value, said):
    ends = {k: (value + off) * 3.14159265 / 180 for k, off in (("value", 0.0), ("low", -0.004), ("high", 0.004))}
    row = make_diagnosis()["parity"][0] | {"fault": "gyro_bias.r", "share": 0.8, "significant": True} | ends
    d = null(0.2, 0.7, parity=[row])
    assert said.replace("#", "the sensors' own check, without any dynamics, shows gyro_bias.r =") in sentence(d)
    beyond = value > 0.2
    assert (verdict(d) == "no cause named") is beyond and ("Nothing to blame" in html.text(d)) is not beyond
    assert "too little of. The sensors' own check" in sentence(still_open(0.1, 0.1, parity=[row]))
    assert "own check" not in sentence(null(0.2, 0.7, parity=[row | {"significant": False}]))


def test_a_systematic_force_is_told_with_what_it_varies_with_and_what_comes_near():
    force = {"axes": ["surge", "yaw"], "depends_on": ["u", "depth"], "share": 0.42}
    d = diagnosis(verdict="unknown", causes=[], left=force)
    assert "a systematic force on surge, yaw that varies with u, depth would take away 42 % of it" in sentence(d)
    departed = {"coefficient": "quadratic_drag[surge].scale", "departure": -7.3}
    assert "quadratic_drag[surge].scale, which would have to be 7 times its tolerance off" in sentence(diagnosis(left=force | {"departed": departed}))
    assert "nearest is waves, whose value would have to change" in sentence(diagnosis(left=force | {"inconstant": ["waves"]}))


def test_a_cause_that_leaves_the_simulated_motion_is_said_to():
    cause = make_diagnosis()["causes"][0]
    kinematic = "seen by the kinematic checks alone; it does not change the simulated motion"
    same = {"total": -0.0006, "low": -0.004, "high": 0.003, "of_explainable": 0.0, "axes": {}}
    for effect, said in (("attitude_bias", kinematic), ("waves", "it leaves the squared gap")):
        d = diagnosis(causes=[cause | {"effect": effect, "group": [effect], "shrinkage": same}])
        for text in (sentence(d), *formats(d)):
            assert said in text and "-0 " not in text and "-0," not in text and "-0]" not in text
    d = diagnosis(causes=[cause | {"shrinkage": same | {"total": 0.3}}])
    assert "by itself it shrinks the squared gap by 30 % [0, 0] on held-out windows" in sentence(d)


def test_a_parameter_that_nothing_moved_is_not_told():
    """Of a tether without a log of its length, the drag per length."""
    rest = {"unit": "N s2/m3", "null": 0.0, "low": 0.0}

    def with_drag(per_length: float) -> Diagnosis:
        both = {"coefficient": rest | {"value": 300.0, "high": 400.0}, "per_length": rest | {"value": per_length, "high": 14.2}}
        return diagnosis(causes=[make_diagnosis()["causes"][0] | {"parameters": both}])

    for text in (sentence(with_drag(0.0)), *formats(with_drag(0.0))):
        assert "coefficient" in text and "per_length" not in text
    assert "per_length" in sentence(with_drag(1.5))


def test_shrinkage_is_said_to_be_of_squares_with_the_rms_beside_it():
    d = make_diagnosis()
    d["causes"][0]["shrinkage"]["axes"] = {"surge": 0.75}
    d["gap"]["axes"]["surge"]["rms"] = 0.08
    page, markdown, plain = formats(Diagnosis.read(d))
    for text in (page, markdown):
        assert "0.080 to 0.040 m/s" in text and "squared gap less by" in text
    for text in (sentence(Diagnosis.read(d)), plain):
        assert "it shrinks the squared gap by" in text


def test_angles_are_said_in_degrees():
    d = make_diagnosis()
    d["gap"]["axes"]["yaw"] |= {"share": 0.9, "rms": 0.1}
    d["causes"][0]["parameters"] = {"roll": {"value": 0.01, "low": 0.005, "high": 0.02, "unit": "rad"}}
    said = sentence(Diagnosis.read(d))
    assert "yaw (5.73 deg/s rms" in said and "roll = 0.573 [0.286, 1.15] deg;" in said and "rad" not in said


def test_the_answer_stands_first_on_the_page_and_once():
    d = diagnosis()
    answer, rest = headline(d)
    assert answer.startswith("Cause: inflow_loss (") and rest.startswith("Gap: largest in surge") and "Cause:" not in rest
    assert all(part in sentence(d) for part in (answer, rest[:60]))


@pytest.mark.parametrize(("low", "said"), [(0.1, False), (-0.3, True)])
def test_what_causes_do_beside_tolerances_is_said_where_the_gap_does_not_surely_shrink_without(low, said):
    filed = make_diagnosis()["shrinkage"] | {"total": (low + 0.1) / 2, "low": low, "high": 0.1 + low}
    d = diagnosis(shrinkage=filed, within_tolerance={"total": 0.93, "low": 0.9, "high": 0.95})
    assert ("93 % [90, 95] of what those leave" in sentence(d)) is said
    assert all(("93 % [90, 95] of what those leave" in text) is said for text in formats(d))


def test_windows_in_which_the_simulation_stops_are_told():
    stopped = "Of the log: 3 of 30 windows, in which the simulation of the vehicle as it is filed stops, were left out."
    assert stopped in sentence(diagnosis(windows=30, windows_stopped=3))
    assert "of 30 windows" not in sentence(diagnosis(windows=30))


def test_a_log_searched_from_an_onset_says_so_first():
    assert sentence(diagnosis(since_s=41.2)).startswith("Searched from 41 s on, where the log changes")
