"""The score of a set: chance scores chance, intervals hold, and every stratum and fault is told."""

from __future__ import annotations

import numpy as np
import pytest
from blind_case import HYPOTHESES, answered_right

from rovval import vehicle
from rovval.blind.scoring import intervals, tables
from rovval.blind.scoring.score import score_logs

MERLIN = vehicle.LIBRARY / "merlin.toml"


def test_shuffled_labels_score_chance():
    rng = np.random.default_rng(1)
    labels, answers = answered_right(rng, 240)
    assert score_logs(labels, answers, {}, str(MERLIN))["strata"]["single"]["top_1"]["value"] == 1.0
    order = rng.permutation(240)
    mixed = {str(i): labels[str(j)] for i, j in enumerate(order)}
    top = score_logs(mixed, answers, {}, str(MERLIN))["strata"]["single"]["top_1"]
    assert top["low"] <= 1 / len(HYPOTHESES) <= top["high"]
    assert top["high"] < 0.25


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
