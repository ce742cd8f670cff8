"""What counts as right: marks of one answer beside its label."""

from __future__ import annotations

from typing import Any

import pytest
from blind_case import HYPOTHESES, answer, cause, label, planted

from rovval import vehicle
from rovval.blind.scoring.rules import score_log

MERLIN = vehicle.LIBRARY / "merlin.toml"


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
    assert m["p_truth"] == pytest.approx(0.1 / (len(HYPOTHESES) - 1))


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
        for n in HYPOTHESES
    )
    assert total == pytest.approx(1.0)


def test_of_several_effects_every_one_counts():
    two = label(planted("rpm_scale", relative=0.1), planted("waves", lift=1.0))
    assert mark(two, answer(cause("waves"), cause("rpm_scale")))["all_found"]
    half = mark(two, answer(cause("waves")))
    assert half["all_found"] is False and half["share_found"] == 0.5
    assert mark(label(planted("waves", lift=1.0)), answer(cause("waves")))["all_found"] is None


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
    m = mark(label(planted("memory_drag")), answer(cause("waves")))
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
