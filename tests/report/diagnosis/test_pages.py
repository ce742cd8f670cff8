"""The reports of a diagnosis, whole and with parts missing."""

import json
from pathlib import Path
from typing import Any

import pytest
from page_case import check_html
from report_cases import make_diagnosis, make_run, make_sim

from rovval import report, vehicle
from rovval.comparison import compare
from rovval.report.diagnosis import html as diagnosis_html
from rovval.report.diagnosis import markdown as diagnosis_markdown
from rovval.report.diagnosis import terminal as diagnosis_terminal
from rovval.report.diagnosis import words as diagnosis_words
from rovval.report.diagnosis.untestable import not_testable

REQUIRED = ("schema", "run", "vehicle", "model", "window_s", "calibration_slop", "verdict", "gap", "causes", "ranking")


def formats(d: dict[str, Any]) -> tuple[str, str, str]:
    page = diagnosis_html.text(d)
    check_html(page)
    return page, diagnosis_markdown.text(d), diagnosis_terminal.text(d)


def test_a_full_diagnosis_is_written(tmp_path: Path) -> None:
    d = make_diagnosis()
    run = make_run(200)
    comparison = compare(run, make_sim(run))
    files = report.write_diagnosis(d, tmp_path, comparison, vehicle.load("merlin"), make_sim(run, gap=(0.0,) * 6))
    assert set(files) == {"diagnosis.json", "diagnosis.md", "diagnosis.html", "run.rrd"}
    assert json.loads(files["diagnosis.json"].read_text()) == d
    assert set(report.write_diagnosis(d, tmp_path / "b")) == {"diagnosis.json", "diagnosis.md", "diagnosis.html"}


def test_every_format_gives_the_answer() -> None:
    for text in formats(make_diagnosis()):
        for fact in ("inflow_loss", "quadratic_drag[surge]", "66 % (58 % to 72 %)", "surge staircase", "ground_effect", "0.310", "gyro_bias"):
            assert fact in text
        assert diagnosis_words.SCOPE in text and diagnosis_words.SQUARED in text


def test_what_pushed_unlogged_is_one_line_and_silent_where_nothing_was_fitted() -> None:
    d = make_diagnosis()
    surge, yaw = "the fit allows for, rms: surge 0.18 N (forgotten in 1.5 s), sway 4.0 N", "yaw 0.012 N m (forgotten in 2.0 s)."
    for text in formats(d):
        said = " ".join(text.split())
        assert surge in said and yaw in said and "heave 0 N" not in said
    for row in d["disturbance"].values():
        row |= {"rms": 0.0, "memory_s": 0.0}
    for old in (d, {k: v for k, v in d.items() if k != "disturbance"}):
        assert not any("Unlogged" in text for text in formats(old))


def test_the_sentence_of_the_engine_comes_first() -> None:
    d = make_diagnosis() | {"sentence": "Surge is 0.07 m/s too fast because of inflow loss."}
    assert diagnosis_words.sentences(d)[0] == d["sentence"]
    page, text, _ = formats(d)
    assert f'<p class="verdict">{d["sentence"]}</p>' in page and f"**{d['sentence']}**" in text


def test_no_gap_blames_nothing() -> None:
    d = {k: v for k, v in make_diagnosis().items() if k in REQUIRED} | {"verdict": "no_gap", "causes": []}
    for text in formats(d):
        assert "No gap beyond noise and a calibration slop of 5 %" in text and "Cause" not in text


def test_unknown_names_no_culprit() -> None:
    d = make_diagnosis() | {"verdict": "unknown", "causes": []}
    for text in formats(d):
        assert "the cause is unknown" in text and "What is left: 0.9 deg/s" in text and "shrinks by" not in text
    assert "The least bad one is not a cause" in formats(d)[0]


@pytest.mark.parametrize("missing", [k for k in make_diagnosis() if k not in ("schema", "run")])
def test_any_part_may_be_missing(missing: str) -> None:
    for text in formats({k: v for k, v in make_diagnosis().items() if k != missing}):
        assert "dive-0007" in text


def test_the_least_document_is_enough() -> None:
    for text in formats({"schema": "rovval.diagnosis/1", "run": "r", "verdict": "unknown"}):
        assert "unknown" in text


def test_several_runs_several_causes_an_onset_and_holes_in_a_trace() -> None:
    d = make_diagnosis()
    d["run"] = ["dive-1", "dive-2"]
    d["causes"] = [*d["causes"], {"effect": "thruster_fault_onset[HFP]", "group": [], "onset_s": 412.3, "parameters": {}}]
    d["traces"][0]["measured"][5] = None
    page, text, plain = formats(d)
    assert "dive-1, dive-2" in page and "thruster_fault_onset[HFP] from 412 s on" in plain and "begins at 412 s" in text


def test_what_a_log_cannot_show_is_one_row_a_family_and_reason() -> None:
    silent = "not excited: a typical size would show with {} standard errors, 3 are needed"
    rows = [("linear_drag[roll]", "1.8"), ("linear_drag[yaw]", "2.75"), ("linear_drag[surge]", "0.4"), ("waves", "2.0")]
    d = make_diagnosis() | {"not_testable": [{"effect": e, "why": silent.format(s)} for e, s in rows]}
    d["not_testable"] += [{"effect": "linear_drag[heave]", "why": "needs w"}, {"effect": "wall_suction", "why": "needs wall_distance"}]
    assert not_testable(d) == [
        ("linear_drag[roll], [yaw], [surge]", silent.format("0.4 to 2.75")),
        ("waves", silent.format("2.0")),
        ("linear_drag[heave]", "needs w"),
        ("wall_suction", "needs wall_distance"),
    ]
    for text in formats(d):
        assert "linear_drag[roll], [yaw], [surge]" in text


def test_brackets_join_only_the_members_of_a_group() -> None:
    d = make_diagnosis()
    d["causes"][0]["group"] = ["inflow_loss", "tether_drag"]
    page = diagnosis_html.text(d)
    assert page.count('class="brace in on') == 2 and page.count('class="brace in "') == 2
    d["causes"][0]["group"] = ["inflow_loss"]
    assert 'class="brace' not in diagnosis_html.text(d)


def test_synthetic_comes_with_the_comparison(tmp_path: Path) -> None:
    run = make_run(200, synthetic="a test")
    files = report.write_diagnosis(make_diagnosis(), tmp_path, compare(run, make_sim(run)), vehicle.load("merlin"))
    assert all("SYNTHETIC DATA: a test" in files[f"diagnosis.{k}"].read_text() for k in ("html", "md"))
    assert json.loads(files["diagnosis.json"].read_text())["synthetic"] == "a test"


def test_names_are_escaped() -> None:
    d = make_diagnosis()
    d["ranking"][0]["effect"] = d["causes"][0]["effect"] = "<script>x"
    page, _, _ = formats(d)
    assert "<script>x" not in page
