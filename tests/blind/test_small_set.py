"""A small sealed set, made, answered and scored from nothing: floors that the engine must reach, and tests that chance scores chance.

Six logs of 120 s of the Merlin, one or more of each sort, the 24 logs of 240 s of `--size small`, and sixteen of plant b; all of them are slow.
The floors stand a good way below what was measured (the numbers are beside them), so that they fall when something breaks and not when a
number moves. The full set is `rovval blind make sets/a --size full && rovval blind answer sets/a && rovval blind score sets/a` (hours, two cores).
"""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rovval import vehicle
from rovval.blind.cases.grid import Case
from rovval.blind.cases.questions import Question
from rovval.blind.plant.spec import Planted
from rovval.blind.scoring import history
from rovval.blind.scoring.score import score_logs, score_set
from rovval.blind.sealed import sealing
from rovval.blind.sealed.answer import answer_set
from rovval.blind.sealed.folder import Folder
from rovval.blind.sealed.make import make_set

SEED = 20261
MERLIN = vehicle.LIBRARY / "merlin.toml"
FEW = (  # mission, what is planted, taken out of the library: one or more of each sort
    ("rich", (), ()),
    ("rich", (Planted("buoyancy_error", None, 1.5),), ()),
    ("rich", (Planted("thruster_reversed", "HAS", 1.0),), ("waves",)),
    ("rich", (Planted("dvl_misalignment", "yaw", 2.0),), ()),
    ("rich", (Planted("buoyancy_error", None, -1.5), Planted("thruster_degraded", "HFP", 1.2)), ()),
    ("rich", (Planted("reverse_asymmetry", None, 2.0),), ("reverse_asymmetry",)),
)
LOGS = {"few": (6, 3), "small": (24, 14)}  # of a set: logs, single effects


def few() -> list[Question]:
    """The questions of `FEW`."""
    cases = [(Case(mission, effects, 100 + i, 120.0), without) for i, (mission, effects, without) in enumerate(FEW)]
    return [Question(case, without, bool(case.effects) and case.effects[0].name in without) for case, without in cases]


@pytest.fixture(scope="module", params=[pytest.param(size, marks=pytest.mark.slow) for size in ("few", "small")])
def size(request: pytest.FixtureRequest) -> str:
    return str(request.param)


@pytest.fixture(scope="module")
def small(size: str, tmp_path_factory) -> Folder:
    root = tmp_path_factory.mktemp("blind") / size
    place = make_set(root, MERLIN, SEED, "small", asked=few() if size == "few" else None)
    answer_set(root, baselines=False)
    return place


@pytest.fixture(scope="module")
def result(small: Folder) -> dict[str, Any]:
    return score_set(small.root, kept=small.root.parent / "history.jsonl")


@pytest.fixture(scope="module")
def opened(small: Folder, result: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any], dict[str, Any]]:
    """Labels, answers and oracles, once the score has opened the seal."""
    labels = json.loads(sealing.unseal(small.labels.read_bytes(), sealing.read_key(small.key)))["logs"]
    answers = {row["log"]: row for row in (json.loads(p.read_text()) for p in small.answer_files())}
    return labels, answers, json.loads((small.root / "oracle.json").read_text())["logs"]


def test_the_oracle_says_of_two_effects_what_each_closes(opened):
    labels, _, oracles = opened
    two = [best for name, best in oracles.items() if len(labels[name]["effects"]) == 2 and best]
    assert two
    assert all(best["each"] <= 1.0 for best in two)
    assert not [name for name, best in oracles.items() if len(labels[name]["effects"]) == 1 and "each" in best]


def value(result: dict[str, Any], stratum: str, mark: str) -> float:
    return float(result["strata"][stratum][mark]["value"])


def test_every_log_was_answered(size: str, result: dict[str, Any]):
    assert len(result["logs"]) == LOGS[size][0]
    assert result["flights_failed"] == 0
    assert not [row for row in result["logs"] if row["verdict"] == "failed"]


# Measured of the small set with this seed on 2026-11-21: 0.93, 0.89, 0.92, 1.00, 1.00, 1.00 and below 0, 0.21, 1.2, 0.05.
FLOORS = {
    "small": [
        ("single, distinguishable", "top_1", 0.7),
        ("single, distinguishable, same form", "top_1", 0.7),
        ("single", "group_hit", 0.7),
        ("single", "of_oracle", 0.8),
        ("two", "share_found", 0.5),
        ("single", "coverage_90", 0.6),
    ],
    "few": [("single", "top_1", 0.6), ("single", "group_hit", 0.6), ("two", "share_found", 0.5)],  # of three single effects one may be missed
}
CEILINGS = {
    "small": [
        ("null", "blamed", 0.25),
        ("single", "errors", 0.8),
        ("single", "group_size", 3.0),
        ("single", "parameter_error", 0.2),
    ],
    "few": [("null", "blamed", 0.5), ("single", "errors", 1.4)],
}


def test_floors(size: str, result: dict[str, Any]):
    low = [(stratum, mark) for stratum, mark, least in FLOORS[size] if value(result, stratum, mark) < least]
    assert not low, why(result)


def test_ceilings(size: str, result: dict[str, Any]):
    high = [(stratum, mark) for stratum, mark, most in CEILINGS[size] if value(result, stratum, mark) > most]
    assert not high, why(result)


def test_a_log_takes_seconds(result: dict[str, Any]):
    """The target is a minute for five minutes of log; CPU time, so that a loaded machine does not fail it."""
    assert np.median([row["cpu_s"] for row in result["logs"]]) < 60.0


def test_the_unsealing_is_in_the_history(size: str, small: Folder, result: dict[str, Any]):
    [line] = history.read(small.root.parent / "history.jsonl")
    assert line["seed"] == SEED
    assert line["engine"] == result["engine"]
    assert line["summary"]["single"]["n"] == LOGS[size][1]


def test_shuffled_labels_score_chance(opened):
    """Labels dealt at random to the same answers: top-1 falls to how often answers and labels agree by chance."""
    labels, answers, _ = opened
    single = [
        n
        for n, label in labels.items()
        if len(label["effects"]) == 1 and not label["left_out"] and label["effects"][0]["place"] != "foreign"
    ]
    rng, found = np.random.default_rng(0), []
    for _ in range(40):
        mixed = dict(zip(single, [labels[n] for n in rng.permutation(single)], strict=True))
        found.append(score_logs(mixed, answers, {}, str(MERLIN))["strata"]["single"]["top_1"]["value"])
    assert np.mean(found) < 2.0 / len(single)


def test_file_metadata_score_chance(small: Folder, opened):
    """Nearest neighbour on everything that a listing shows, each log left out in turn: no better than the commonest kind."""
    labels, _, _ = opened
    names = sorted(labels)
    kinds = [kind(labels[n]) for n in names]
    x = np.array([metadata(small.logs / n, i) for i, n in enumerate(names)], dtype=float)
    spread = x.std(axis=0)
    assert (spread[2:] == 0.0).all(), "size, time, rows or columns differ between logs"
    x = x[:, spread > 0] / spread[spread > 0]
    far = np.linalg.norm(x[:, None] - x[None], axis=2) + np.diag(np.full(len(x), np.inf))
    hits = sum(kinds[int(j)] == kinds[i] for i, j in enumerate(far.argmin(axis=1)))
    share = Counter(kinds).most_common(1)[0][1] / len(kinds)
    chance = sum((c / len(kinds)) ** 2 for c in Counter(kinds).values())
    assert hits / len(kinds) <= max(share, chance) + 2.0 * (share * (1 - share) / len(kinds)) ** 0.5


def metadata(path: Path, place: int) -> list[float]:
    stat, text = path.stat(), path.read_text()
    return [
        float(place),
        float(int(path.stem, 16)),
        float(stat.st_size),
        float(stat.st_mtime_ns),
        float(len(text.strip().splitlines())),
        float(len(text.partition("\n")[0])),
    ]


def kind(label: dict[str, Any]) -> str:
    """Healthy, one effect by place, or several: classes that are large enough to be learnt from 24 logs."""
    if not label["effects"]:
        return "null"
    return "several" if len(label["effects"]) > 1 else str(label["effects"][0]["place"])


def why(result: dict[str, Any]) -> str:
    lines = [f"{w['kind']}: {w['truth']} -> {w['named'] or w['verdict']} (oracle {w['oracle']})" for w in result["wrong"]]
    return "wrong answers:\n" + "\n".join(lines)


@pytest.fixture(scope="module")
def second(tmp_path_factory) -> dict[str, Any]:
    """Sixteen fresh logs of plant b, five of them healthy."""
    root = tmp_path_factory.mktemp("blind") / "b"
    make_set(root, MERLIN, SEED, "16", plant="b", healthy=0.3, seconds=180.0)
    answer_set(root, baselines=False)
    return score_set(root, kept=root.parent / "history.jsonl")


@pytest.mark.slow
def test_what_is_stated_of_the_second_plant_is_better_than_a_coin(second: dict[str, Any]):
    """The floor of the probabilities on forms that nobody tunes the engine on; the denominator holds healthy logs and what the library lacks."""
    found = second["summed"]["reliability"]
    assert second["plant"] == "b" and found["n"] + found["not_visible"] == 16 and found["without_probabilities"] == 0
    assert found["brier"] < 0.25, why(second)
    assert found["log_score"] > np.log(0.5), why(second)
    assert found["calibration_error"] < 0.35, why(second)


@pytest.mark.slow
def test_healthy_logs_of_the_second_plant_are_left_alone(second: dict[str, Any]):
    blamed = second["summed"]["counts"]["healthy_blamed"]
    assert blamed["n"] == 5 and blamed["value"] <= 0.2, why(second)
