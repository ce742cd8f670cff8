"""The diagnosis from log to document: verdicts, the contract's schema, the mended vehicle, repeatability."""

from __future__ import annotations

import functools
import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from diagnose_case import bare, diagnosed, foreign, merlin, own
from diagnosis_schema import check_document
from tumbling import bluerov2, tumbling

from rovval import demo
from rovval.comparison import compare
from rovval.core.channels import AXES
from rovval.diagnose import Diagnosis, diagnose
from rovval.report.diagnosis.json import document as written
from rovval.report.diagnosis.sentences.sentence import sentence
from rovval.simulation import simulate
from rovval.vehicle import parse

PLANTED = "inflow_loss:loss=0.3"


def explained() -> Diagnosis:
    return diagnosed((PLANTED,))


@functools.cache
def strange() -> Diagnosis:
    """A gap of no effect: the surge speed jumps to and fro every second, and only while the vehicle moves sideways."""
    run = own((), 6, 100.0)
    n = len(run)
    wave = np.sign(np.sin(2 * np.pi * run.t / 2.0))
    values = {c: np.array(x) for c, x in run.values.items()}
    values["u"] = values["u"] + 0.15 * np.convolve(wave * (np.abs(values["v"]) > 0.02), np.ones(5) / 5, mode="same")[:n]
    return diagnose([bare(values, merlin(), "strange")], merlin())


def check_schema(d: dict[str, Any]) -> None:
    """Keys and types of the contract in design.md."""
    assert json.loads(json.dumps(d, allow_nan=False)) == json.loads(json.dumps(d))
    assert d["schema"] == "rovval.diagnosis/1"
    assert d["verdict"] in ("no_gap", "explained", "partly_explained", "unknown")
    kinds = {"run": str, "vehicle": str, "model": str, "window_s": float, "calibration_slop": float, "causes": list, "ranking": list}
    for key, kind in (kinds | {"not_testable": list}).items():
        assert isinstance(d[key], kind), key
    assert set(d["gap"]["axes"]) <= set(AXES)
    for row in d["gap"]["axes"].values():
        assert row["unit"] in ("m/s", "rad/s", "m", "rad")
        assert all(isinstance(row[k], float) for k in ("rms", "iae", "floor_rms", "share"))
    assert sum(row["share"] for row in d["gap"]["axes"].values()) == pytest.approx(1.0)
    for row in d["gap"]["where"]:
        assert row["axis"] in AXES
        assert all(isinstance(row[k], float) for k in ("share", "time_share", "lift"))
    assert all(isinstance(t, float) for t in d["gap"]["change_points_s"])
    for cause in d["causes"]:
        assert cause["group"][0] == cause["effect"]
        assert 0.0 <= cause["probability"] <= 1.0
        assert cause["onset_s"] is None or isinstance(cause["onset_s"], float)
        assert all(p["low"] <= p["value"] <= p["high"] and isinstance(p["unit"], str) for p in cause["parameters"].values())
        check_shrinkage(cause["shrinkage"])
    check_shrinkage(d["shrinkage"])
    assert d["shrinkage"]["held_out"] is True
    assert all(isinstance(r["effect"], str) and isinstance(r["score"], float) for r in d["ranking"])
    assert [r["score"] for r in d["ranking"]] == sorted((r["score"] for r in d["ranking"]), reverse=True)
    assert all(isinstance(r["effect"], str) and isinstance(r["why"], str) for r in d["not_testable"])
    plan = d["next_experiment"]
    assert plan is None or (isinstance(plan["manoeuvre"], str) and len(plan["separates"]) > 1)
    assert bool(d["causes"]) == (d["verdict"] in ("explained", "partly_explained"))


def check_shrinkage(s: dict[str, Any]) -> None:
    assert all(isinstance(s[k], float) for k in ("total", "low", "high", "of_explainable"))
    assert s["low"] <= s["total"] <= s["high"] or s["total"] == 0.0
    assert set(s["axes"]) <= set(AXES)


@pytest.mark.parametrize("case", [explained, diagnosed, strange], ids=["explained", "no_gap", "strange"])
def test_documents_keep_the_contract(case):
    document = written(case())
    check_document(document)
    check_schema(document)
    assert document["sentence"] == sentence(case())


def test_a_planted_effect_is_named_with_its_size():
    found = explained()
    cause = found.document()["causes"][0]
    assert found.document()["verdict"] == "explained"
    assert cause["effect"] == "inflow_loss"
    assert cause["parameters"]["loss"]["low"] <= 0.3 <= cause["parameters"]["loss"]["high"]
    assert cause["shrinkage"]["total"] > 0.9
    assert "inflow_loss" in written(found)["sentence"] and "unused data" in written(found)["sentence"]


def test_a_healthy_log_has_no_gap_and_nothing_to_mend():
    found = diagnosed()
    assert found.document()["verdict"] == "no_gap"
    assert found.document()["causes"] == [] and found.settings == () and found.vehicle_fixed == ""
    assert "No gap beyond sensor noise" in written(found)["sentence"]


def test_a_gap_of_no_known_effect_is_unknown_and_blamed_on_nothing():
    document = written(strange())
    assert document["verdict"] == "unknown" and document["causes"] == []
    assert document["gap"]["axes"]["surge"]["share"] > 0.8 and "There is a gap" in document["sentence"]


def test_the_mended_vehicle_closes_the_gap_that_compare_sees():
    """In `compare`'s own terms, squared window errors per axis, which keep the errors of the start states."""
    run, found = own((PLANTED,), 5, 100.0), explained()
    mended = parse(found.vehicle_fixed, "mended")
    assert mended.effects["inflow_loss"]["loss"] == pytest.approx(0.3, abs=0.05)
    before, after = (compare(run, simulate(run, v)).windowed for v in (merlin(), mended))
    for axis in ("surge", "yaw"):
        said = found.document()["causes"][0]["shrinkage"]["axes"][axis]
        assert 1 - (after[axis].rmse / before[axis].rmse) ** 2 == pytest.approx(said, abs=0.1)


def test_diagnosing_the_mended_vehicle_finds_nothing_left():
    run, found = own((PLANTED,), 5, 100.0), explained()
    assert diagnose([run], parse(found.vehicle_fixed, "mended")).document()["verdict"] == "no_gap"


def test_the_same_log_and_seed_give_the_same_document():
    again = diagnose([own((), 5, 100.0)], merlin())
    assert json.dumps(again.document()) == json.dumps(diagnosed().document())


def test_logged_accelerations_change_nothing():
    """Nothing is differentiated, so that no diagnosis misses them where they are not logged."""
    run = own((), 5, 100.0)
    accelerations = {name: np.random.default_rng(0).normal(size=len(run)) for name in ("udot", "vdot", "wdot")}
    reasons = {**run.reasons, **dict.fromkeys(accelerations, np.zeros(len(run), np.uint8))}
    document = diagnose([replace(run, values={**run.values, **accelerations}, reasons=reasons)], merlin()).document()
    assert json.dumps(document) == json.dumps(diagnosed().document())


@pytest.mark.slow
def test_the_same_log_and_seed_give_the_same_cause():
    again = diagnose([own((PLANTED,), 5, 100.0)], merlin())
    assert json.dumps(again.document()) == json.dumps(explained().document())
    assert again.settings == explained().settings


@pytest.mark.slow
def test_where_the_true_effect_is_left_out_of_the_library_less_of_the_gap_closes():
    document, whole = diagnose([own((PLANTED,), 5, 100.0)], merlin(), without=["inflow_loss"]).document(), explained().document()
    tried, before = ({row["effect"] for row in d["ranking"]} for d in (document, whole))
    unseen = {row["effect"] for row in document["not_testable"]}  # what it leaves is more to see the others through
    assert before - tried - unseen == {"inflow_loss"}, "it and no other"
    assert document["shrinkage"]["high"] < whole["shrinkage"]["low"]


@pytest.mark.slow
def test_several_runs_are_one_diagnosis():
    found = diagnose([own((PLANTED,), 5, 100.0), own((PLANTED,), 6, 100.0)], merlin())
    check_document(written(found))
    assert found.runs == ("own5", "own6") and found.run == "own5, own6"
    assert [cause.effect for cause in found.causes] == ["inflow_loss"]


@pytest.mark.slow
def test_the_sample_names_what_was_left_in():
    assert diagnose([demo.sample()], merlin()).document()["causes"][0]["effect"] == "inflow_loss"


@pytest.mark.slow
def test_the_independent_plant(tmp_path):
    run = foreign(tmp_path, (("thruster_degraded", "HFP", 1.0),), 11, 150.0)
    document = diagnose([run], merlin()).document()
    check_schema(document)
    assert any(name.endswith("[HFP]") for name in document["causes"][0]["group"])


TUMBLED = [
    ("buoyancy_error:force=-6", "force", -6.0),
    ("gyro_bias:q=0.02", "q", 0.02),
    ("thruster_degraded[T5]:loss=0.4", "loss", 0.4),
]


@pytest.mark.slow
@pytest.mark.parametrize(("planted", "parameter", "value"), TUMBLED)
def test_a_vehicle_that_tumbles_is_diagnosed(planted: str, parameter: str, value: float):
    """Through pitch of +-80 degrees and more, and upside down for a good part of the log."""
    causes = diagnose([tumbling((planted,), seconds=80.0)], bluerov2()).causes
    assert [cause.effect for cause in causes] == [planted.partition(":")[0]]
    found = causes[0].parameters[parameter]
    assert found.low < value < found.high
    assert found.value == pytest.approx(value, rel=0.15)


@pytest.mark.slow
def test_nothing_is_named_of_a_healthy_vehicle_that_tumbles():
    assert diagnose([tumbling(seconds=80.0)], bluerov2()).verdict == "no_gap"
