"""What a diagnosis says: the answer first, in few words, errors as rms, degrees for angles, no certainty by rounding, and no "no gap" where
something was seen."""

from __future__ import annotations

import re
from typing import Any

import pytest
from page_case import formats
from report_cases import detection, diagnosis, make_diagnosis

from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis import html
from rovval.report.diagnosis.json import document
from rovval.report.diagnosis.sentences.first_screen import first_screen
from rovval.report.diagnosis.sentences.plain import falls, of_what, regime, titled, when
from rovval.report.diagnosis.sentences.sentence import answer, sentence, verdict

SURE = {"healthy": 0.02, "causes": 0.03, "miscalibrated_file": 0.05, "something_else": 0.9}


def null(noise: float, tolerance: float, departure: float = 0.0, **changes: Any) -> Diagnosis:
    """No cause, with the shares of the gap that noise and tolerances account for."""
    parts: dict[str, Any] = {"verdict": "no_gap", "causes": [], "left": None, "next_experiment": None, "manoeuvre": None, "parity": [], "harm": []}
    return diagnosis(**parts | {"detection": detection(noise, tolerance, departure)} | changes)


def still_open(noise: float, tolerance: float, departure: float = 0.0, accounted: float = 0.3, **changes: Any) -> Diagnosis:
    """A gap that stays open: noise and tolerances account for too little of it."""
    left = {"axes": ["surge"], "depends_on": [], "accounted": accounted}
    return null(noise, tolerance, departure, **{"verdict": "unknown", "left": left} | changes)


def weighed(gain: float, evidence: float) -> list[list[dict[str, Any]]]:
    return [[{"effect": "inflow_loss", "gain": gain, "evidence": evidence}, {"effect": "waves", "gain": 0.1, "evidence": 5.0}]]


def number_of_words(d: Diagnosis) -> int:
    return sum(any(c.isalnum() for c in word) for part in first_screen(d) for word in part.split())


def test_the_first_screen_is_sixty_words_for_one_cause_and_ninety_for_two() -> None:
    d = make_diagnosis()
    second = d["causes"][0] | {"effect": "thruster_degraded[HFP]", "group": ["thruster_degraded[HFP]", "thruster_misaligned[HFP]"], "onset_s": 412.3}
    for verdict_ in ("explained", "partly_explained"):
        one = Diagnosis.read(d | {"verdict": verdict_})
        two = Diagnosis.read(d | {"verdict": verdict_, "causes": [d["causes"][0], second]})
        assert number_of_words(one) <= 60 and number_of_words(two) <= 90
        assert all(first_screen(one)) and all(first_screen(two))


@pytest.mark.parametrize(
    ("kinds", "said"),
    [
        (("file",), "Correct this number in the vehicle's file: `--write-vehicle FILE.toml` writes it."),
        (("file", "file"), "Correct these numbers in the vehicle's file: `--write-vehicle FILE.toml` writes them."),
        (("file", "effect"), "Write the mended vehicle with `--write-vehicle FILE.toml` and compare again."),
    ],
)
def test_what_to_do_next_fits_all_of_the_causes(kinds: tuple[str, ...], said: str) -> None:
    causes = [make_diagnosis()["causes"][0] | {"kind": kind} for kind in kinds]
    assert first_screen(diagnosis(causes=causes, next_experiment=None)).next == said


def test_the_first_screen_says_what_where_which_how_far_and_what_to_do_next() -> None:
    said = first_screen(diagnosis(verdict="explained"))
    assert said.what == "One effect explains the gap: Axial inflow loss."
    assert said.where == "Surge: 78 % of the gap, most when moving ahead faster than 0.6 m/s."
    assert said.which == "inflow_loss: loss = 0.310, lag = 0.120 s, probability 0.71, or quadratic_drag[surge]."
    assert said.how_far == "The error falls to 58 % [53, 65], checked on unused data."
    assert said.next == "Fly surge staircase with a coast-down: it tells them apart."


@pytest.mark.parametrize("verdict_", ["explained", "partly_explained"])
def test_causes_explain_no_gap_that_does_not_shrink_with_them(verdict_: str) -> None:
    """A bias of attitude that the kinematics of a calibrated vehicle's log showed, and with which its gap grew to 102 %."""
    no_less = {"total": -0.04, "low": -0.14, "high": 0.04}
    found = diagnosis(verdict=verdict_, shrinkage=make_diagnosis()["shrinkage"] | no_less)
    assert first_screen(found).what == "One effect is found, but the gap is not shown to shrink with it: Axial inflow loss."


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("u > 0.33 m/s", "moving ahead faster than 0.33 m/s"), ("u < -0.33 m/s", "moving astern faster than 0.33 m/s"),
        ("|v| < 0.04 m/s", "moving sideways slower than 0.04 m/s"), ("|r| > 3.6 deg/s", "turning faster than 3.6 deg/s"),
        ("time 20 to 80 s", "from 20 to 80 s"), ("depth > 28.6 m", "depth > 28.6 m"), ("HFP turning forward", "HFP turning forward"),
    ],
)  # fmt: skip
def test_a_regime_is_what_the_vehicle_does(name: str, said: str) -> None:
    assert regime(name) == said


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("|r| > 3.6 deg/s", "when turning faster than 3.6 deg/s"), ("time 20 to 80 s", "from 20 to 80 s"), ("HFP turning forward", "when HFP turns forward"),
        ("depth > 28.6 m", "when depth > 28.6 m"),
    ],
)  # fmt: skip
def test_a_regime_is_told_in_a_sentence(name: str, said: str) -> None:
    assert when(name) == said


def test_an_error_is_told_as_rms() -> None:
    """Three quarters of the squares are half of the rms."""
    assert falls(0.75) == "falls to 50 %" and falls(0.75, 0.51, 0.84) == "falls to 50 % [40, 70]"
    assert falls(-0.44) == "grows to 120 %" and falls(1.0) == "falls to 0 %"


def test_an_effect_is_told_by_its_title_with_the_name_that_commands_take() -> None:
    assert of_what("linear_drag[yaw]") == "Linear drag differs (yaw)" and of_what("inflow_loss") == "Axial inflow loss"
    assert titled("linear_drag[yaw]") == "Linear drag differs (linear_drag[yaw])" and titled("of_another_library") == "of_another_library"
    for text in formats(diagnosis()):
        assert "Axial inflow loss" in text and "inflow_loss" in text


def test_no_gap_is_said_to_be_within_noise_and_tolerance() -> None:
    d = null(0.9, 0.0)
    assert answer(d) == "No gap beyond sensor noise and a calibration tolerance of 5 %: no cause is needed."
    assert verdict(d) == "no gap beyond noise and tolerance" and first_screen(d).next == ""
    assert "nobody logged" not in sentence(d) and "with the effects found" not in html.text(d)
    sure = null(0.9, 0.0, probabilities={"healthy": 0.93, "causes": 0.05, "miscalibrated_file": 0.0, "something_else": 0.02})
    assert "tolerance of 5 % (probability 0.93): no cause is needed." in answer(sure)
    assert "times the sensor's noise: coefficients that are off by their tolerance of 5 % make as much." in sentence(d), "22 times the noise is no riddle"


def test_a_formula_that_helps_little_is_not_offered() -> None:
    """"A formula for it would bring the error to 100 %"."""
    left = {"axes": ["pitch"], "depends_on": ["pitch angle"], "share": 0.006}
    said = sentence(diagnosis(left=left))
    assert "a force in pitch that nothing in the library explains; it varies with pitch angle." in said and "formula" not in said


def test_what_is_steady_and_what_comes_and_goes_are_told_as_such() -> None:
    """"It varies with constant", and of a seaway not a word, in a log of an outside plant."""
    left = {"axes": ["heave"], "depends_on": ["constant", "u"], "oscillation": {"period_s": 5.38, "share": 0.71}}
    said = sentence(diagnosis(left=left))
    assert "explains; part of it is steady; it varies with u; 71 % of its square comes and goes in a narrow band about 5.4 s, as in a seaway" in said
    open_gap = null(0.1, 0.1, verdict="unknown", left={**left, "accounted": 0.1})
    assert "is shown to be the rest; 71 % of its square comes and goes in a narrow band about 5.4 s, as in a seaway." in sentence(open_gap)


@pytest.mark.parametrize(
    ("likely", "said", "then"),
    [
        ("something_else", "no effect of the library explains: something else is at work (probability 0.90), most in surge and yaw.", "worst stretches"),
        ("miscalibrated_file", "No single cause: many numbers of the vehicle's file seem to be off at once (probability 0.90).", "rovval fit"),
        ("causes", "Undecided: an effect of the library is the likeliest answer (probability 0.90), less than the 0.6 from which", "further logs"),
        ("healthy", "Undecided: a vehicle that is as its file has it, within tolerance, is the likeliest answer (probability 0.90)", "further logs"),
    ],
)
def test_an_unknown_gap_says_which_kind_of_answer_is_the_most_probable(likely: str, said: str, then: str) -> None:
    left = {"axes": ["yaw", "surge"], "depends_on": ["u"], "share": 0.42}  # told in the order of the gap
    p = dict.fromkeys(SURE, 0.1 / 3) | {likely: 0.9}
    d = null(0.1, 0.1, verdict="unknown", left=left, probabilities=p)
    assert said in answer(d) and then in first_screen(d).next
    assert verdict(d) == ("no cause named" if likely in ("causes", "healthy") else "unknown effect")
    assert "a force in surge and yaw that nothing in the library explains; it varies with u, and with a formula for it the error falls to 76 %" in sentence(d)


@pytest.mark.parametrize(
    ("likely", "what"), [("something_else", "something that the library lacks"), ("miscalibrated_file", "a file that is off in many numbers")]
)
def test_what_is_likelier_than_any_other_answer_and_not_likely_is_undecided(likely: str, what: str) -> None:
    """Of a side force on a thruster at 0.46 it was said that no effect of the library explains the gap."""
    others = {"healthy": 0.0, "causes": 0.46, "miscalibrated_file": 0.0, "something_else": 0.0}
    d = null(0.1, 0.1, verdict="unknown", left={"axes": ["yaw"], "depends_on": []}, probabilities=others | {likely: 0.54})
    assert f"Undecided: {what}" in answer(d) and "(probability 0.54), less than the 0.6" in answer(d)
    assert verdict(d) == "no cause named" and "further logs" in first_screen(d).next


def test_an_effect_that_was_not_found_is_told_beside_something_else() -> None:
    p = {"healthy": 0.0, "causes": 0.0, "miscalibrated_file": 0.0, "something_else": 0.62, "not_found": 0.38}
    d = null(0.1, 0.1, verdict="unknown", left={"axes": ["yaw"], "depends_on": []}, probabilities=p)
    assert "something else is at work (probability 0.62), or one in another form (0.38), most in yaw." in answer(d)


def test_a_log_that_contradicts_itself_is_said_to_be_why_no_cause_is_named() -> None:
    opposed = [{"run": "a", "channel": "psi", "finding": "contradicted", "detail": "and r contradict each other by 3 degrees within a window"}]
    p = {"healthy": 0.0, "causes": 1.0, "miscalibrated_file": 0.0, "something_else": 0.0}
    d = null(0.1, 0.1, verdict="unknown", left={"axes": ["yaw"], "depends_on": []}, log=opposed, probabilities=p)
    assert answer(d).startswith("No cause is named, because the log contradicts itself: psi and r contradict") and "Check that sensor" in first_screen(d).next


def test_a_gap_that_nothing_accounts_for_is_unknown_and_says_how_much_is_accounted_for() -> None:
    d = still_open(0.04, 0.26)
    assert "sensor noise and a calibration tolerance of 5 % account for only 30 % of it, and no effect" in answer(d)
    assert verdict(d) == "unknown effect" and document(d)["left"]["text"].startswith("sensor noise and a calibration tolerance of 5 %")


def test_tolerances_that_were_overdrawn_are_said_not_to_count() -> None:
    d = still_open(0.04, 0.64, 6.6, accounted=0.04)
    assert "account for only 4 % of the squared gap (for 64 % if a coefficient were 6.6 times its tolerance off); no effect" in sentence(d)


def test_an_open_gap_may_be_what_pushed_unlogged() -> None:
    """The largest force and the largest moment; a document that knows of none says only that it may be."""
    said = sentence(still_open(0.04, 0.26))
    assert "a disturbance that nobody logged (the fit allows for some, largest: sway 4.0 N and yaw 0.012 N m rms), an effect" in said
    pushed = {"surge": {"rms": 1234.5, "unit": "N", "memory_s": 1.0}, "yaw": {"rms": 0.0, "unit": "N m", "memory_s": 0.0}}
    assert "largest: surge 1234 N rms)" in sentence(still_open(0.04, 0.26, disturbance=pushed))
    assert "It may be a disturbance, an effect that comes and goes" in sentence(still_open(0.04, 0.26, disturbance={}))


def test_a_force_that_nobody_logged_where_thrusters_hardly_push_is_told_in_times_theirs() -> None:
    """On a real log "4232 % of the thrusters' own" stood there."""
    force = {"unlogged_force": {"size": 42.32, "expected": 0.02, "alike": 0.1, "evidence": 4.0}}
    said = sentence(diagnosis(detection=detection(0.1, 0.1) | force))
    assert "nobody logged, 42 times as large as the thrusters' own there; the median is 2 % beside" in said


@pytest.mark.parametrize(("evidence", "said"), [(4.0, True), (-2.0, False)])
def test_a_force_that_nobody_logged_is_told_where_it_speaks_against_the_causes(evidence: float, said: bool) -> None:
    force = {"unlogged_force": {"size": 0.2, "expected": 0.02, "alike": 0.1, "evidence": evidence}}
    text = "Where the cause acts, a force is left that nobody logged, 20 % of the thrusters' own; the median is 2 % beside right causes, and 10 % beside what"
    assert (text in sentence(diagnosis(detection=detection(0.1, 0.1) | force))) is said
    assert ("what comes nearest acts" in sentence(null(0.1, 0.1, verdict="unknown", detection=detection(0.1, 0.1) | force))) is said
    assert "nobody logged" not in sentence(diagnosis(detection=detection(0.1, 0.1)))


@pytest.mark.parametrize(
    ("gain", "evidence", "tolerance", "near", "seen"),
    [(0.4, 6.44, 0.45, True, False), (0.6, 30.0, 0.55, True, True), (0.2, 8.0, 0.7, True, False), (0.5, 1.0, 0.7, False, False)],
)
def test_what_came_near_is_told_with_how_probable_causes_are(gain: float, evidence: float, tolerance: float, near: bool, seen: bool) -> None:
    p = {"healthy": 0.85, "causes": 0.12, "miscalibrated_file": 0.0, "something_else": 0.03}
    d = null(0.1, tolerance, finalists=weighed(gain, evidence), probabilities=p)
    told = f"Nearest to a cause is Axial inflow loss (inflow_loss): with it the error {falls(gain)}, but all causes together have a probability of only 0.12."
    assert (told in sentence(d)) is near and "short of" not in sentence(d) and "checks that a cause must pass" not in sentence(d)
    for text in formats(d):
        assert ("no cause named" in text) is seen and ("Nearest to a cause" in text) is near


@pytest.mark.parametrize(
    ("value", "said"),
    [(0.397, "# 0.397 [0.393, 0.401] deg/s, 3.5 times its tolerance."), (0.05, "# 0.0500 [0.0460, 0.0540] deg/s, within its tolerance.")],
)
def test_a_fault_that_the_sensors_show_does_not_hide_under_no_gap(value: float, said: str) -> None:
    ends = {k: (value + off) * 3.14159265 / 180 for k, off in (("value", 0.0), ("low", -0.004), ("high", 0.004))}
    row = make_diagnosis()["parity"][0] | {"fault": "gyro_bias.r", "share": 0.8, "significant": True} | ends
    d = null(0.2, 0.7, parity=[row])
    assert said.replace("#", "The sensors disagree among themselves: gyro_bias.r =") in sentence(d)
    beyond = value > 0.2
    assert (verdict(d) == "no cause named") is beyond and ("no cause is needed" in answer(d)) is not beyond
    assert ("Check the sensor" in first_screen(d).next) is beyond
    assert "disagree among themselves" in sentence(still_open(0.1, 0.1, parity=[row]))
    assert "disagree" not in sentence(null(0.2, 0.7, parity=[row | {"significant": False}]))


def test_what_comes_near_an_unknown_force_is_told_with_why_it_is_not_it() -> None:
    force = {"axes": ["surge", "yaw"], "depends_on": ["u", "depth"], "share": 0.42}
    departed = {"coefficient": "quadratic_drag[surge].scale", "departure": -7.3}
    d = diagnosis(verdict="unknown", causes=[], left=force | {"departed": departed})
    assert "Nearest: quadratic_drag[surge].scale, which would have to be 7 times its tolerance off." in sentence(d)
    d = diagnosis(verdict="unknown", causes=[], left=force | {"inconstant": ["waves"]})
    assert "Nearest: Waves at the surface (waves), but the size would have to change along the log." in sentence(d)
    d = diagnosis(verdict="unknown", causes=[], left=force | {"inconstant": ["waves"], "goes_with": {"effect": "waves", "covariate": "depth"}})
    assert "Nearest: Waves at the surface (waves), but the size would have to change with depth." in sentence(d)
    assert "something else is at work, which looks like waves and is not." in sentence(d) and "a force in surge and yaw" in sentence(d)
    d = diagnosis(verdict="unknown", causes=[], left=force | {"inconstant": ["dvl_scale"], "goes_with": {"effect": "dvl_scale", "covariate": "|u|"}})
    assert "would have to change with |u|" in sentence(d) and "a force in" not in sentence(d)


def test_a_cause_that_leaves_the_simulated_motion_is_said_to() -> None:
    cause = make_diagnosis()["causes"][0]
    kinematic = "it is seen by the sensors' own check and does not change the simulated motion"
    same = {"total": -0.0006, "low": -0.004, "high": 0.003, "of_explainable": 0.0, "axes": {}}
    for effect, said in (("attitude_bias", kinematic), ("waves", "it changes the simulated motion too little to see")):
        d = diagnosis(causes=[cause | {"effect": effect, "group": [effect], "shrinkage": same}], shrinkage=same)
        for text in (sentence(d), *formats(d)):
            assert said.replace("'", "&#39;") in text or said in text
            assert "-0 " not in text and "-0," not in text and "-0]" not in text


def test_a_parameter_that_nothing_moved_is_not_told() -> None:
    """Of a tether without a log of its length, the drag per length."""
    rest = {"unit": "N s2/m3", "null": 0.0, "low": 0.0}

    def with_drag(per_length: float) -> Diagnosis:
        both = {"coefficient": rest | {"value": 300.0, "high": 400.0}, "per_length": rest | {"value": per_length, "high": 14.2}}
        return diagnosis(causes=[make_diagnosis()["causes"][0] | {"parameters": both}])

    for text in (sentence(with_drag(0.0)), *formats(with_drag(0.0))):
        assert "coefficient" in text and "per_length" not in text
    assert "per_length" in sentence(with_drag(1.5))


def test_tables_tell_rms_first_with_the_squares_beside_it() -> None:
    d = make_diagnosis()
    d["causes"][0]["shrinkage"]["axes"] = {"surge": 0.75}
    d["gap"]["axes"]["surge"]["rms"] = 0.08
    page, markdown, plain = formats(Diagnosis.read(d))
    for text in (re.sub(r"</?a\b[^>]*>", "", page), markdown):  # terms link to their meaning
        assert "0.080 to 0.040 m/s" in text and text.index("error, rms") < text.index("its square less by")
    assert "what is left of the error by axis: surge 50 %" in plain


def test_angles_are_said_in_degrees() -> None:
    d = make_diagnosis()
    d["gap"]["axes"]["yaw"] |= {"share": 0.9, "rms": 0.1}
    d["causes"][0]["parameters"] = {"roll": {"value": 0.01, "low": 0.005, "high": 0.02, "unit": "rad"}}
    said = sentence(Diagnosis.read(d))
    assert "In yaw the simulator is 5.73 deg/s rms off" in said and "roll = 0.573 [0.286, 1.15] deg," in said and "rad" not in said


def test_no_wording_that_readers_could_not_follow_is_left() -> None:
    private = ("lift ", "forgotten in", "weighted squared gap", "signatures once", "told from 230", "held-out windows", "short of the 6")
    for text in formats(diagnosis(since_s=230.0)):
        body = text.partition('<script type="application/json"')[0].partition("<style>")[0] + text.partition("</style>")[2].partition("<script")[0]
        assert not [word for word in private if word in (body or text)]


@pytest.mark.parametrize(("low", "said"), [(0.1, False), (-0.3, True)])
def test_what_causes_do_beside_tolerances_is_said_where_the_gap_does_not_surely_shrink_without(low: float, said: bool) -> None:
    filed = make_diagnosis()["shrinkage"] | {"total": (low + 0.1) / 2, "low": low, "high": 0.1 + low}
    d = diagnosis(shrinkage=filed, within_tolerance={"total": 0.91, "low": 0.84, "high": 0.96})
    assert ("of the error that those leave, it falls to 30 % [20, 40]" in sentence(d)) is said


def test_windows_in_which_the_simulation_stops_are_told() -> None:
    stopped = "Of the log: 3 of 30 windows, in which the simulation of the vehicle as it is filed stops, were left out."
    assert stopped in sentence(diagnosis(windows=30, windows_stopped=3))
    assert "of 30 windows" not in sentence(diagnosis(windows=30))


def test_a_log_searched_from_an_onset_says_so() -> None:
    assert "Something begins at 41 s: causes were searched from there on." in sentence(diagnosis(since_s=41.2))


def test_probabilities_of_the_kinds_of_answers_stand_in_every_format() -> None:
    page, markdown, plain = formats(diagnosis(probabilities=SURE))
    for text in (page, markdown, plain):
        assert "How probable" in text or "how probable" in text
        assert text.index("something that the library does not hold") < text.index("many numbers at once") < text.index("each number within its tolerance")
    assert "| something that the library does not hold | 0.90 |" in markdown and "0.90 something" in plain and 'style="width:90.0%"' in page
    never = SURE | {"something_else": 1.0, "healthy": 0.0}
    assert "> 0.99 something" in formats(diagnosis(probabilities=never))[2] and "< 0.01 nothing" in formats(diagnosis(probabilities=never))[2]


def test_parameters_that_are_seen_together_only_are_said_to_be_in_every_format() -> None:
    """Those that the fit moved; of one that rests where it changes nothing nothing is said."""
    made = make_diagnosis()
    cause = made["causes"][0] | {"together": [{"of": ["loss", "lag"], "value": -0.987}]}
    for text in formats(Diagnosis.read(made | {"causes": [cause]})):
        assert "seen together only (correlation): loss and lag (-0.99)" in text
    rests = cause["parameters"] | {"lag": {"value": 0.0, "low": -0.1, "high": 0.1, "unit": "s", "null": 0.0}}
    for text in formats(Diagnosis.read(made | {"causes": [cause | {"parameters": rests}]})):
        assert "seen together" not in text
