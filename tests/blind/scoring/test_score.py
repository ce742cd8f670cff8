"""The score of a set: chance scores chance, intervals hold, and every stratum and fault is told."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from blind_case import HYPOTHESES, answer, cause, label, planted

from rovval import vehicle
from rovval.blind.scoring import ground_truth, intervals, tables
from rovval.blind.scoring.score import score_logs
from rovval.report.blind import html as blind_html
from rovval.report.blind import terminal as blind_terminal

MERLIN = vehicle.LIBRARY / "merlin.toml"


def perfect(rng: np.random.Generator, many: int) -> tuple[dict[str, Any], dict[str, Any]]:
    """Labels over the library and an answerer that is always right."""
    labels, answers = {}, {}
    for i in range(many):
        name, _, target = HYPOTHESES[int(rng.integers(len(HYPOTHESES)))].partition("[")
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
    assert top["low"] <= 1 / len(HYPOTHESES) <= top["high"]
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


def test_wilson_and_bootstrap():
    assert intervals.share([])["value"] is None
    none = intervals.share([False] * 20)
    assert none["low"] == 0.0 and none["high"] == pytest.approx(0.119, abs=0.001)
    half = intervals.share([True, False] * 50)
    assert half["low"] == pytest.approx(0.419, abs=0.001)
    m = intervals.mean([1.0, 2.0, 3.0])
    assert m["value"] == 2.0
    assert m["low"] is not None and m["high"] is not None and m["low"] <= 2.0 <= m["high"]
