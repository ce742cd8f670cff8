"""What is said first, with which probability and whether it is so; the counts; several sets together, each plant apart."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from blind_case import answer, cause, label, planted

from rovval import vehicle
from rovval.blind.scoring.pool import pool
from rovval.blind.scoring.score import SCHEMA, score_logs
from rovval.core.errors import BadInput, UsageProblem
from rovval.report.blind import terminal

MERLIN = str(vehicle.LIBRARY / "merlin.toml")
PLAIN, HIDDEN = {"dynamic": 0.8, "seen": 0.8, "sure": 20.0, "each": 0.4}, {"dynamic": 0.02, "seen": 0.02, "sure": 9.0, "each": 0.01}
LIFT, WAVES, SCALE = planted("buoyancy_error", lift=1.0), planted("waves"), planted("rpm_scale", relative=0.1)


def believed(said: dict[str, Any], healthy: float = 0.0, causes: float = 0.0, something_else: float = 0.0) -> dict[str, Any]:
    """An answer with the probabilities of the kinds of model; what is missing to one is the file's."""
    rest = 1.0 - healthy - causes - something_else
    belief = {"healthy": healthy, "causes": causes, "miscalibrated_file": rest, "something_else": something_else}
    return said | {"document": said["document"] | {"probabilities": belief}}


CASES: list[tuple[dict[str, Any], dict[str, Any], dict[str, float], tuple[str, float], bool | None]] = [
    (label(LIFT), believed(answer(cause("buoyancy_error", 0.9)), causes=0.95), PLAIN, ("buoyancy_error", 0.9), True),
    (label(LIFT), believed(answer(cause("waves", 0.6, ("buoyancy_error",))), causes=0.8), PLAIN, ("waves", 0.6), False),
    (label(LIFT), believed(answer(), healthy=0.8), PLAIN, ("healthy", 0.8), False),
    (label(LIFT), believed(answer(), healthy=0.8), HIDDEN, ("healthy", 0.8), None),
    (label(LIFT), believed(answer(cause("waves")), causes=0.9), {**PLAIN, "sure": 2.0}, ("waves", 0.9), None),
    (label(), believed(answer(), healthy=0.7), {}, ("healthy", 0.7), True),
    (label(), believed(answer(cause("waves", 0.8)), causes=0.8), {}, ("waves", 0.8), False),
    (label(), believed(answer(verdict="unknown"), healthy=0.1, something_else=0.2), {}, ("file", 0.7), False),
    (label(planted("memory_drag")), believed(answer(verdict="unknown"), something_else=0.6), {}, ("something_else", 0.6), True),
    (label(planted("memory_drag")), believed(answer(cause("waves", 0.5)), causes=0.5), {}, ("waves", 0.5), False),
    (label(LIFT, left_out=True), believed(answer(verdict="unknown"), something_else=0.9), PLAIN, ("something_else", 0.9), True),
    (label(WAVES, SCALE), believed(answer(cause("waves", 0.9), cause("rpm_scale", 0.7)), causes=0.9), PLAIN, ("waves", 0.9), True),
    (label(WAVES, SCALE), believed(answer(cause("rpm_scale", 0.8)), causes=0.9), PLAIN, ("rpm_scale", 0.8), True),
]


@pytest.fixture(scope="module")
def scored() -> dict[str, Any]:
    labels = {str(i): case[0] for i, case in enumerate(CASES)}
    answers = {str(i): case[1] for i, case in enumerate(CASES)}
    return score_logs(labels, answers, {str(i): case[2] for i, case in enumerate(CASES)}, MERLIN)


def test_what_is_said_first_has_its_probability(scored: dict[str, Any]) -> None:
    assert [row["said"] for row in scored["logs"]] == [case[3][0] for case in CASES]
    assert [row["p_said"] for row in scored["logs"]] == pytest.approx([case[3][1] for case in CASES])
    assert [row["visible"] for row in scored["logs"]] == [case[4] is not None for case in CASES]


def test_the_reliability_counts_healthy_and_lacking_and_leaves_out_what_nobody_could_see(scored: dict[str, Any]) -> None:
    found = scored["summed"]["reliability"]
    counted = [case for case in CASES if case[4] is not None]
    assert found["n"] == len(counted) == sum(row["n"] for row in found["bins"])
    assert found["not_visible"] == 2 and found["without_probabilities"] == 0
    assert found["right"]["value"] == pytest.approx(sum(bool(case[4]) for case in counted) / len(counted))
    assert found["brier"] == pytest.approx(sum((case[3][1] - bool(case[4])) ** 2 for case in counted) / len(counted))
    assert set(found["kinds"]) == {"healthy", "causes", "something_else"}


def test_the_counts(scored: dict[str, Any]) -> None:
    got = {name: (round((number["value"] or 0.0) * number["n"]), number["n"]) for name, number in scored["summed"]["counts"].items()}
    assert got == {
        "single_found": (2, 3), "single_first": (1, 3), "single_other": (0, 3), "single_silent": (1, 3), "healthy_blamed": (1, 3),
        "healthy_alarm": (2, 3), "lacking_blamed": (1, 3), "two_both": (1, 2), "two_one": (2, 2),
    }  # fmt: skip


def test_an_answer_that_states_no_probability_is_counted_apart() -> None:
    found = score_logs({"a": label()}, {"a": answer()}, {}, MERLIN)["summed"]["reliability"]
    assert found["n"] == 0 and found["without_probabilities"] == 1


def test_sets_are_pooled_by_plant_with_every_wrong_log(scored: dict[str, Any], tmp_path: Path) -> None:
    for name, plant in (("one", "a"), ("two", "b"), ("three", "b")):
        (tmp_path / name).mkdir()
        text = {"schema": SCHEMA, "plant": plant, "engine": "abc", **scored}
        (tmp_path / name / "score.json").write_text(json.dumps(text, allow_nan=False), encoding="utf-8")
    found = pool([tmp_path / name for name in ("one", "two", "three")])
    assert {plant: row["logs"] for plant, row in found["plants"].items()} == {"a": len(CASES), "b": 2 * len(CASES)}
    page = terminal.pooled(found)
    assert "plant b" in page and page.count("memory_drag x1 -> waves at 0.50") == 3
    assert "buoyancy_error x1 (not visible) -> healthy at 0.80" in page
    with pytest.raises(UsageProblem, match="four"):
        pool([tmp_path / "one", tmp_path / "four"])
    with pytest.raises(UsageProblem, match="twice"):
        pool([tmp_path / "one", tmp_path / "one"])
    (tmp_path / "one" / "score.json").write_text("{}", encoding="utf-8")
    with pytest.raises(BadInput, match="another version"):
        pool([tmp_path / "one"])
