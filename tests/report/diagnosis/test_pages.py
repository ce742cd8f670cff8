"""The reports of a diagnosis: every format gives the answer, whatever was found, and a page cannot be broken by a name."""

import json
from pathlib import Path

import pytest
from page_case import check_html, formats
from report_cases import diagnosis, make_diagnosis, make_run, make_sim

from rovval import report, vehicle
from rovval.comparison import compare
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis import html, terminal
from rovval.report.diagnosis.json import document
from rovval.report.diagnosis.sentences import words
from rovval.report.diagnosis.tables import not_testable

CONTRACT = (
    "schema", "run", "vehicle", "model", "window_s", "calibration_slop", "verdict", "gap", "causes", "shrinkage", "ranking", "not_testable", "next_experiment",
)  # fmt: skip


def test_a_full_diagnosis_is_written(tmp_path: Path) -> None:
    d = diagnosis()
    run = make_run(200)
    comparison = compare(run, make_sim(run))
    files = report.write_diagnosis(d, tmp_path, comparison, vehicle.load("merlin"), make_sim(run, gap=(0.0,) * 6))
    assert set(files) == {"diagnosis.json", "diagnosis.md", "diagnosis.html", "run.rrd"}
    written = json.loads(files["diagnosis.json"].read_text())
    assert written == document(d) and written["sentence"] and written["answer"]
    assert set(report.write_diagnosis(d, tmp_path / "b")) == {"diagnosis.json", "diagnosis.md", "diagnosis.html"}


def test_every_format_gives_the_answer() -> None:
    for text in formats(diagnosis()):
        for fact in ("inflow_loss", "quadratic_drag[surge]", "58 % [53, 65]", "surge staircase", "ground_effect", "[0.260, 0.360]", "gyro_bias"):
            assert fact in text
        assert words.SCOPE in text and words.SQUARED in text


def test_what_pushed_unlogged_is_one_line_and_silent_where_nothing_was_fitted() -> None:
    surge, yaw = "in brackets how long one lasts): surge 0.18 N (1.5 s), sway 4.0 N", "yaw 0.012 N m (2.0 s)."
    for text in formats(diagnosis()):
        assert surge in text and yaw in text and "heave 0 N" not in text
    still = {axis: row | {"rms": 0.0, "memory_s": 0.0} for axis, row in make_diagnosis()["disturbance"].items()}
    for silent in (still, {}):
        assert not any("Forces that nobody logged" in text for text in formats(diagnosis(disturbance=silent)))


def test_an_answer_that_a_document_has_already_is_kept() -> None:
    d = diagnosis(sentence="Gap: large. Cause: waves. Left: a little.", answer="Cause: waves.")
    page, markdown, _ = formats(d)
    assert '<p class="verdict">Cause: waves.</p>' in page and "**Cause: waves.**" in markdown and document(d)["sentence"] == d.sentence


def test_no_gap_blames_nothing() -> None:
    for text in formats(diagnosis(verdict="no_gap", causes=[], left=None, next_experiment=None, manoeuvre=None, parity=[])):
        assert "No gap beyond sensor noise and a calibration tolerance of 5 %" in text and "Cause" not in text


def test_unknown_names_no_culprit() -> None:
    d = diagnosis(verdict="unknown", causes=[])
    for text in formats(d):
        assert "no effect of the library explains" in text and "0.9 deg/s rms in yaw" in text and "shrinks by" not in text


@pytest.mark.parametrize("missing", [key for key in make_diagnosis() if key not in CONTRACT])
def test_what_the_contract_does_not_ask_for_may_be_missing(missing: str) -> None:
    """A document of an older rovval lacks what came later."""
    for text in formats(Diagnosis.read({k: v for k, v in make_diagnosis().items() if k != missing})):
        assert "dive-0007" in text


def test_the_contract_alone_is_enough() -> None:
    for text in formats(Diagnosis.read({k: v for k, v in make_diagnosis().items() if k in CONTRACT})):
        assert "inflow_loss" in text


def test_several_causes_an_onset_and_holes_in_a_trace() -> None:
    d = make_diagnosis()
    shrinkage = {"total": 0.1, "low": 0.05, "high": 0.2, "of_explainable": 0.2}
    fault = {"effect": "thruster_fault_onset[HFP]", "group": [], "probability": 0.9, "onset_s": 412.3, "parameters": {}, "shrinkage": shrinkage}
    d["traces"][0]["measured"][5] = None
    page, text, plain = formats(diagnosis(run="dive-1, dive-2", causes=[*d["causes"], fault], traces=d["traces"]))
    assert "dive-1, dive-2" in page and "thruster_fault_onset[HFP] from 412 s on" in plain and "begins at 412 s" in text
    assert "Two effects explain part of the gap: Axial inflow loss and Thruster fails during the log (HFP)." in plain
    assert "The error falls to 58 % [53, 65]" in plain and "by itself, the error falls to 95 % [89, 97]" in plain


def test_what_a_log_cannot_show_is_one_row_a_family_and_reason() -> None:
    silent = "not excited: a typical size would show with {} standard errors, 3 are needed"
    rows = [("linear_drag[roll]", "1.8"), ("linear_drag[yaw]", "2.75"), ("linear_drag[surge]", "0.4"), ("waves", "2.0")]
    unseen = [{"effect": e, "why": silent.format(s)} for e, s in rows]
    unseen += [{"effect": "linear_drag[heave]", "why": "needs w"}, {"effect": "wall_suction", "why": "needs wall_distance"}]
    d = diagnosis(not_testable=unseen)
    assert not_testable(d) == [
        ("linear_drag[roll], [yaw], [surge]", silent.format("0.4 to 2.75")),
        ("waves", silent.format("2.0")),
        ("linear_drag[heave]", "needs w"),
        ("wall_suction", "needs wall_distance"),
    ]
    for text in formats(d):
        assert "linear_drag[roll], [yaw], [surge]" in text


def test_brackets_join_only_the_members_of_a_group() -> None:
    cause = make_diagnosis()["causes"][0]
    page = html.text(diagnosis(causes=[cause | {"group": ["inflow_loss", "tether_drag"]}]))
    assert page.count('class="brace in on') == 2 and page.count('class="brace in') == 4  # tether_drag is the fourth of the ranking
    assert 'class="brace' not in html.text(diagnosis(causes=[cause | {"group": ["inflow_loss"]}]))


def test_synthetic_comes_with_the_comparison(tmp_path: Path) -> None:
    run = make_run(200, synthetic="a test")
    files = report.write_diagnosis(diagnosis(), tmp_path, compare(run, make_sim(run)), vehicle.load("merlin"))
    assert all("SYNTHETIC DATA: a test" in files[f"diagnosis.{k}"].read_text() for k in ("html", "md"))
    assert json.loads(files["diagnosis.json"].read_text())["synthetic"] == "a test"


def test_names_are_escaped() -> None:
    d = make_diagnosis()
    d["ranking"][0]["effect"] = d["causes"][0]["effect"] = "<script>x"
    page = html.text(Diagnosis.read(d | {"run": "</script><img src=x>"}))
    check_html(page)
    assert "<script>x" not in page


def test_steps_of_the_search_say_what_they_asked() -> None:
    def row(name: str) -> dict[str, object]:
        return {"effect": name, "evidence": 50.0, "gain": 0.3}

    d = diagnosis(finalists=[[row("inflow_loss"), row("quadratic_drag[surge]"), row("waves")], [row("waves")], []])
    for text in formats(d):
        assert "eside the best of those" in text and "84 %" in text
    assert "cannot be told from inflow_loss" in html.text(d) and "first look at the library" not in terminal.text(d)


def test_the_largest_axis_stands_with_a_regime_of_its_own() -> None:
    """Once, surge was said to err most at a yaw rate: the regime was that of another axis."""
    d = make_diagnosis()
    slices = d["gap"]["where"]
    other = {**slices[0], "axis": "yaw", "regime": "|r| > 3.6 deg/s"}
    largest = max(d["gap"]["axes"], key=lambda axis: d["gap"]["axes"][axis]["share"])
    own = {**slices[0], "axis": largest, "regime": "u > 0.5 m/s"}
    page = html.text(Diagnosis.read(d | {"gap": d["gap"] | {"where": [other, own]}}))
    assert "most when moving ahead faster than 0.5 m/s" in page and "most when turning" not in page
    assert "most when" not in html.text(Diagnosis.read(d | {"gap": d["gap"] | {"where": [other]}}))


def test_bars_of_errors_that_grew_differ_by_how_much() -> None:
    """At -100 % and beyond they all looked alike."""
    cause = make_diagnosis()["causes"][0]
    shares = {"surge": 0.5, "sway": -1.0, "yaw": -5.0}
    page = html.text(diagnosis(causes=[cause | {"shrinkage": cause["shrinkage"] | {"axes": shares}}]))
    table = page.partition("its square less by")[2]
    widths = [table.partition(f">{axis}</th>")[2].partition("width:")[2].partition("%")[0] for axis in shares]
    assert widths == ["50.0", "50.0", "83.3"] and page.count('class="track wide worse"') >= 2


def test_what_a_calibration_left_stands_beside_the_gap_and_only_where_there_was_one() -> None:
    given = make_diagnosis()["gap"]
    axes = {axis: row | ({"calibrated_rms": 0.0123} if axis == "surge" else {}) for axis, row in given["axes"].items()}
    for known, plain in zip(formats(diagnosis(gap=given | {"axes": axes})), formats(diagnosis()), strict=True):
        assert "0.0123 m/s" in known and "alibration" in known
        assert "0.0123 m/s" not in plain
