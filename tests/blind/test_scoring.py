"""The scoring of the blind check: what counts as right, and that chance scores chance."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rovval import vehicle
from rovval.blind.baselines import stlsq
from rovval.blind.cases.flight import fly
from rovval.blind.plant.spec import AXES, Planted
from rovval.blind.planted.catalogue import catalogue, names
from rovval.blind.scoring import ground_truth, intervals, tables
from rovval.blind.scoring import true_values as numbers
from rovval.blind.scoring.rules import score_log
from rovval.blind.scoring.score import score_logs
from rovval.blind.scoring.strata import strata
from rovval.report.blind import html as blind_html
from rovval.report.blind import terminal as blind_terminal

MERLIN = vehicle.LIBRARY / "merlin.toml"
LIBRARY = (
    *(f"thruster_degraded[{t}]" for t in ("HFP", "HFS", "HAP", "HAS")),
    "buoyancy_error",
    "rpm_scale",
    "inflow_loss",
    "waves",
)


def planted(name: str, target: str | None = None, **values: Any) -> dict[str, Any]:
    row = catalogue()[name]
    size = {"wrench_rms": dict.fromkeys(AXES, 0.0) | {"heave": 5.0}}
    return {
        "name": name, "place": row.place, "form": row.form, "target": target, "severity": 1.0, "onset_s": None, "values": values,
        "realised": size,
    }  # fmt: skip


def label(*effects: dict[str, Any], left_out: bool = False) -> dict[str, Any]:
    return {"effects": list(effects), "mission": "rich", "left_out": left_out, "without": []}


def cause(effect: str, probability: float = 0.9, group: tuple[str, ...] = (), **parameters: float) -> dict[str, Any]:
    known = {k: {"value": v, "low": v - 0.1, "high": v + 0.1} for k, v in parameters.items()}
    return {
        "effect": effect,
        "group": [effect, *group],
        "probability": probability,
        "onset_s": known.pop("onset", {}).get("value"),
        "parameters": known,
    }


def answer(*causes: dict[str, Any], verdict: str = "", where: str = "heave", left: list[str] | None = None) -> dict[str, Any]:
    document = {
        "verdict": verdict or ("explained" if causes else "no_gap"),
        "causes": list(causes),
        "ranking": [{"effect": n, "score": 0.1} for n in LIBRARY],
        "shrinkage": {"total": 0.5 if causes else 0.0},
        "gap": {"where": [{"axis": where, "regime": "u > 0.6 m/s"}]},
        "left": {"axes": left, "depends_on": ["thrust of HFP"]} if left else None,
    }
    return {"document": document, "floors": {"ridge": "rpm_scale"}, "cpu_s": 1.0}


def mark(about: dict[str, Any], said: dict[str, Any], oracle: float = 0.8) -> dict[str, Any]:
    return score_log(about, said, {"dynamic": oracle, "seen": oracle}, vehicle.load("merlin"), MERLIN)


def test_a_right_answer():
    m = mark(label(planted("buoyancy_error", lift=0.5)), answer(cause("buoyancy_error", force=0.45)))
    assert m["top_1"] and m["right_when_named"] and m["right_when_one_named"] and m["group_hit"] and m["axis"]
    assert m["errors"] == 0
    assert m["p_truth"] == 0.9
    assert m["of_oracle"] == pytest.approx(0.5 / 0.8)
    [p] = m["parameters"]
    assert p["error"] == pytest.approx(0.1) and p["covered"]


def test_the_wrong_thruster_is_wrong():
    m = mark(label(planted("thruster_degraded", "HFP", loss=0.5)), answer(cause("thruster_degraded[HFS]")))
    assert not m["top_1"] and not m["group_hit"]
    assert m["errors"] == 2
    assert m["p_truth"] == pytest.approx(0.1 / (len(LIBRARY) - 1))


def test_the_truth_in_the_group_is_a_hit_but_not_a_first():
    m = mark(label(planted("rpm_scale", relative=0.1)), answer(cause("inflow_loss", 0.6, ("waves", "rpm_scale"))))
    assert m["group_hit"] and not m["top_1"] and m["right_when_one_named"] is None
    assert m["p_truth"] == pytest.approx(0.4 * 0.8 / 2)


def test_a_fourth_name_of_a_group_does_not_count():
    m = mark(
        label(planted("rpm_scale", relative=0.1)), answer(cause("inflow_loss", 0.6, ("waves", "buoyancy_error", "rpm_scale")))
    )
    assert not m["group_hit"]
    assert m["group_size"] == 3


@pytest.mark.parametrize("said", [(), ("rpm_scale",), ("inflow_loss", "waves"), ("inflow_loss",)])
def test_probability_over_the_library_is_one(said):
    causes = (cause(said[0], 0.7, said[1:]),) if said else ()
    values = {"relative": 0.1, "lift": 1.0, "loss": 0.5}
    total = sum(
        mark(
            label({**planted("waves", None, **values), "name": n.partition("[")[0], "target": n.partition("[")[2].rstrip("]")}),
            answer(*causes),
        )["p_truth"]
        for n in LIBRARY
    )
    assert total == pytest.approx(1.0)


def test_of_several_effects_every_one_counts():
    two = label(planted("rpm_scale", relative=0.1), planted("waves", lift=1.0))
    assert mark(two, answer(cause("waves"), cause("rpm_scale")))["all_found"]
    half = mark(two, answer(cause("waves")))
    assert half["all_found"] is False and half["share_found"] == 0.5
    assert mark(label(planted("waves", lift=1.0)), answer(cause("waves")))["all_found"] is None


@pytest.mark.parametrize(("each", "kinds"), [(0.4, ["two", "two, each distinguishable"]), (0.05, ["two"])])
def test_two_effects_of_which_one_hides_are_a_kind_of_their_own(each, kinds):
    both = label(planted("rpm_scale", relative=0.1), planted("waves", lift=1.0))
    assert strata(both, {"dynamic": 0.8, "seen": 0.8, "each": each}) == kinds


def test_what_begins_in_mid_log_is_a_kind_of_its_own_but_for_events():
    seen = {"dynamic": 0.5, "seen": 0.5}
    begun, event = (label({**planted(name, relative=0.1), "onset_s": 120.0}) for name in ("rpm_scale", "payload_change"))
    assert strata(begun, seen) == ["single, begins in mid-log", "single, begins in mid-log, distinguishable"]
    assert "single, distinguishable" in strata(event, seen)


def test_silence_is_a_miss():
    m = mark(label(planted("thruster_degraded", "HFP", loss=0.5)), answer())
    assert m["truth_named"] is False and m["group_hit"] is None


def test_nothing_named_is_scored_by_its_ranking():
    m = mark(label(planted("thruster_degraded", "HFP", loss=0.5)), answer())
    assert m["top_1"]
    assert m["right_when_named"] is None
    assert m["errors"] == 1


def test_a_false_alarm():
    m = mark(label(), answer(cause("waves")))
    assert m["detected"] and m["blamed"]
    assert m["top_1"] is None
    assert m["errors"] == 1
    assert m["floors"] == {"ridge": True}


def test_a_foreign_effect_is_never_named_right():
    m = mark(label(planted("body_lift")), answer(cause("waves")))
    assert m["blamed"] and m["errors"] == 2 and m["top_1"] is None


@pytest.mark.parametrize(("axes", "right"), [(["heave"], True), (["surge", "heave"], False)])
def test_left_out_is_right_when_unknown_on_its_axis(axes, right):
    m = mark(
        label(planted("thruster_degraded", "HFP", loss=0.5), left_out=True), answer(verdict="unknown", where="yaw", left=axes)
    )
    assert m["said_unknown"] and not m["blamed"]
    assert m["errors"] == 0
    assert m["axis"] is right
    assert m["regime"]


def test_two_effects_are_matched_one_to_one():
    both = label(planted("buoyancy_error", lift=1.0), planted("rpm_scale", relative=0.1))
    m = mark(both, answer(cause("rpm_scale"), cause("waves"), cause("buoyancy_error")))
    assert m["errors"] == 1
    assert m["share_found"] == 1.0
    assert mark(both, answer(cause("rpm_scale"), cause("waves")))["errors"] == 2


def test_an_answer_that_failed_is_wrong_and_counted():
    m = mark(label(planted("rpm_scale", relative=0.1)), {"failed": "ValueError: no", "cpu_s": 1.0})
    assert m["top_1"] is False and m["errors"] == 1


ALIASES = [
    (planted("inertia_error", "surge", relative=0.2), cause("payload_change"), True),
    (planted("inertia_error", "yaw", relative=0.2), cause("added_mass[yaw]"), True),
    (planted("inertia_error", "yaw", relative=0.2), cause("added_mass[roll]"), False),
    (planted("added_mass", "pitch"), cause("inertia_error[pitch]"), True),
    (planted("added_mass", "surge"), cause("inertia_error[surge]"), False),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFP]", onset=4.0), True),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFP]", onset=0.0), True),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFP]", onset=90.0), False),
    (planted("thruster_degraded", "HFP", loss=0.5), cause("thruster_fault_onset[HFS]", onset=4.0), False),
    (planted("thruster_fault_onset", "HFP", loss=0.5), cause("thruster_degraded[HFP]"), False),
    (planted("thruster_degraded", "HFP", loss=1.0), cause("thruster_reversed[HFP]", fraction=0.48), False),
    (planted("thruster_interaction", "HFP", loss=0.6), cause("thruster_interaction[HFP]"), True),
    (planted("thruster_interaction", "HFP", loss=0.6), cause("thruster_interaction[VFP]"), False),
    (planted("thruster_interaction", "HFP", loss=0.6), cause("thruster_degraded[HFP]"), False),
    (planted("time_offset", "velocity", delay_s=0.4), cause("time_offset[velocity]"), True),
    (planted("time_offset", "velocity", delay_s=0.4), cause("time_offset"), False),
    (planted("time_offset", "velocity", delay_s=0.4), cause("velocity_filter_lag"), False),
    (planted("time_offset", "thruster_feedback", delay_s=0.4), cause("time_offset"), True),
    (planted("time_offset", "thruster_feedback", delay_s=0.4), cause("time_offset[velocity]"), False),
    (planted("time_offset", "attitude", delay_s=0.4), cause("time_offset[attitude]"), True),
    (planted("time_offset", "attitude", delay_s=0.4), cause("time_offset"), False),
    (planted("time_offset", "attitude", delay_s=0.4), cause("velocity_filter_lag"), False),
    (planted("time_offset", "depth", delay_s=0.4), cause("time_offset[depth]"), True),
    (planted("velocity_filter_lag", None), cause("time_offset"), False),
    (planted("current_constant", None), cause("current_varying"), False),
]


@pytest.mark.parametrize(("effect", "said", "same"), ALIASES, ids=[f"{e['name']}-{c['effect']}-{s}" for e, c, s in ALIASES])
def test_aliases_are_few(effect, said, same):
    assert ground_truth.accepts(effect, said) is same


def test_every_planted_name_is_a_hypothesis_of_the_library():
    from rovval.plant import Plant

    known = set(Plant(vehicle.load("merlin")).hypotheses)
    for name in names(foreign=False):
        targets = catalogue()[name].targets
        for target in ("HFP",) if targets == ("thruster",) else targets or (None,):
            assert ground_truth.name(planted(name, target)) in known


def test_wilson_and_bootstrap():
    assert intervals.share([])["value"] is None
    none = intervals.share([False] * 20)
    assert none["low"] == 0.0 and none["high"] == pytest.approx(0.119, abs=0.001)
    half = intervals.share([True, False] * 50)
    assert half["low"] == pytest.approx(0.419, abs=0.001)
    m = intervals.mean([1.0, 2.0, 3.0])
    assert m["value"] == 2.0
    assert m["low"] is not None and m["high"] is not None and m["low"] <= 2.0 <= m["high"]


def perfect(rng: np.random.Generator, many: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Labels over the library and an answerer that is always right."""
    labels, answers = {}, {}
    for i in range(many):
        name, _, target = LIBRARY[int(rng.integers(len(LIBRARY)))].partition("[")
        labels[str(i)] = label(planted(name, target.rstrip("]") or None, loss=0.5, relative=0.1, lift=1.0))
        answers[str(i)] = answer(cause(ground_truth.name(labels[str(i)]["effects"][0])))
    return labels, answers


def test_shuffled_labels_score_chance():
    rng = np.random.default_rng(1)
    labels, answers = perfect(rng, 240)
    assert score_logs(labels, answers, {}, str(MERLIN))["strata"]["single"]["top_1"]["value"] == 1.0
    order = rng.permutation(240)
    mixed = {str(i): labels[str(j)] for i, j in enumerate(order)}
    top = score_logs(mixed, answers, {}, str(MERLIN))["strata"]["single"]["top_1"]
    assert top["low"] <= 1 / len(LIBRARY) <= top["high"]
    assert top["high"] < 0.25


def test_page_and_text_hold_every_stratum():
    labels, answers = perfect(np.random.default_rng(2), 10)
    labels["n"], answers["n"] = label(), answer(cause("waves"))
    head = {"vehicle": "merlin", "seed": 1, "size": "10", "engine": "abc", "rovval": "0", "opened": "", "committed": ""}
    result = score_logs(labels, answers, {}, str(MERLIN)) | head
    json.dumps(result, allow_nan=False)
    html, text = blind_html.text(result), blind_terminal.text(result)
    for stratum in result["strata"]:
        assert stratum in html
        assert stratum in text
    assert "false alarm" in html
    assert "The right effect comes first in 100 % [79, 100] of 10 logs" in html
    assert "A gap is claimed in 100 % [27, 100] of 1 healthy logs." in html
    assert [w["kind"] for w in result["wrong"]] == ["false alarm"]


def test_faults_are_told_apart():
    row = {
        "verdict": "no_gap",
        "left_out": False,
        "foreign": [False],
        "truth": ["waves"],
        "named": [],
        "detected": False,
        "blamed": False,
        "errors": 1,
    }
    assert tables.error_kind(row) == "missed"
    assert tables.error_kind(row | {"truth": [], "foreign": []}) == ""
    assert tables.error_kind(row | {"left_out": True, "blamed": True}) == "blamed"
    assert tables.error_kind(row | {"verdict": "unknown", "detected": True}) == "unknown"


def sparse_case() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(3)
    x = rng.standard_normal((400, 12))
    return x, 1.5 * x[:, 2] - 0.7 * x[:, 9] + 0.05 * rng.standard_normal(400)


def test_sparse_regression_finds_the_terms():
    x, y = sparse_case()
    assert np.flatnonzero(stlsq.stlsq(x, y)).tolist() == [2, 9]
    assert not stlsq.stlsq(x, 0.01 * y).any()


def test_sparse_regression_is_pysindy_s():
    pysindy = pytest.importorskip("pysindy", reason="pysindy is not installed (`uv pip install pysindy`)")
    x, y = sparse_case()
    theirs = pysindy.STLSQ(threshold=stlsq.THRESHOLD, alpha=stlsq.RIDGE, unbias=False).fit(x, y).coef_
    np.testing.assert_allclose(stlsq.stlsq(x, y), np.ravel(theirs), atol=1e-9)


@pytest.mark.parametrize(
    ("axis", "term", "expected"),
    [
        ("heave", "constant", "buoyancy_error"),
        ("surge", "u|u|", "quadratic_drag[surge]"),
        ("sway", "HFP", "thruster_degraded[HFP]"),
        ("yaw", "v", "cross_drag"),
    ],
)
def test_terms_have_names(axis, term, expected):
    assert stlsq.effect(axis, term, ("HFP",)) == expected


def test_every_term_stands_for_an_effect():
    grid = {n: np.linspace(-1, 1, 20) for n in (*"uvwpqrzt", "psi")}
    bases = {
        n.partition("[")[0] for n in (stlsq.effect(a, t, ("HFP",)) for a in AXES for t in stlsq.terms(grid, {"HFP": grid["u"]}))
    }
    assert bases <= set(names(foreign=False))


MAPPED = [
    (n, t)
    for n in numbers.TABLE
    for t in (("HFP",) if catalogue()[n].targets == ("thruster",) else catalogue()[n].targets or (None,))
]
MAPPED = [
    (n, t)
    for n, t in MAPPED
    if not (n == "inertia_error" and t == "surge")
]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "target"), MAPPED)
def test_numbers_map_onto_the_library(name, target, tmp_path: Path):
    """On a vehicle without slop, re-simulation with the true effect finds the number that the table says (sign, unit, reference)."""
    from rovval.blind.cases.csv_log import write_csv
    from rovval.blind.scoring.oracle import fitted
    from rovval.storage.archive import open_run

    flight = fly(MERLIN, "rich", [Planted(name, target, 1.5)], 11, 180.0, slop=0.0)
    write_csv(flight, tmp_path / "log.csv")
    [effect] = flight.truth["effects"]
    wanted = numbers.true_values(effect, vehicle.load("merlin"))
    onsets = {ground_truth.name(effect): effect["onset_s"]} if effect["onset_s"] else {}
    found = fitted(open_run(tmp_path / "log.csv", "merlin"), vehicle.load("merlin"), [ground_truth.name(effect)], onsets)
    if not wanted:
        pytest.skip("the planted size lies outside the library's bounds: not scored")
    for key, value in wanted.items():
        assert found[f"{ground_truth.name(effect)}.{key}"] == pytest.approx(value, rel=0.35, abs=1e-3)
