"""Flights and their logs: the same seed gives the same log, every mission stays sane, and nothing of the simulator is in them."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import numpy as np
import pytest
from blind_case import ROOT, vehicle_file

from rovval.blind.cases import flight as plant
from rovval.blind.cases import generate
from rovval.blind.cases.csv_log import header, write_csv
from rovval.blind.cases.grid import BEGIN, DURATION_S, grid
from rovval.blind.missions.manoeuvres import MISSIONS
from rovval.blind.plant.spec import STEP_S, Flight, Planted
from rovval.blind.planted.catalogue import catalogue

SECONDS = 24.0


@pytest.fixture(scope="module")
def merlin() -> Path:
    return vehicle_file("merlin")


@pytest.fixture(scope="module")
def healthy(merlin: Path) -> Flight:
    return plant.fly(merlin, "rich", [], 11, SECONDS)


def test_the_same_seed_gives_the_same_log_and_another_does_not(merlin: Path, healthy: Flight) -> None:
    again = plant.fly(merlin, "rich", [], 11, SECONDS)
    assert all(np.array_equal(x, again.measured[name], equal_nan=True) for name, x in healthy.measured.items())
    other = plant.fly(merlin, "rich", [], 12, SECONDS)
    assert not np.array_equal(other.true["u"], healthy.true["u"])


@pytest.mark.parametrize("mission", MISSIONS)
@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy", "minerva"])
def test_every_mission_flies_within_sane_limits(mission: str, name: str) -> None:
    flight = plant.fly(vehicle_file(name), mission, [], 5, 40.0)
    assert all(np.isfinite(x).all() for x in flight.true.values())
    assert np.max(np.abs([flight.true[k] for k in "uvw"])) < 2.0
    assert np.min(flight.true["altitude"]) > 0.0
    assert np.max(np.abs([flight.true["phi"], flight.true["theta"]])) < 1.2


def test_wrong_names_targets_and_severities_are_refused(merlin: Path) -> None:
    for item in (Planted("gremlin"), Planted("thruster_degraded", "T9"), Planted("tether_drag", severity=-1.0)):
        with pytest.raises(ValueError, match=r"gremlin|T9|tether_drag"):
            plant.fly(merlin, "rich", [item], 1, 1.0)


def test_the_csv_has_the_header_of_the_hardware_log_and_three_columns_more(
    tmp_path: Path, merlin: Path, healthy: Flight
) -> None:
    write_csv(healthy, tmp_path / "log.csv")
    with (tmp_path / "log.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.reader(file))
    assert tuple(table[0]) == header(healthy.thrusters)
    assert table[0][:10] == [
        "Hour",
        "Minute",
        "Second",
        "Millisecond",
        "Latitude",
        "Longitude",
        "Depth",
        "Roll",
        "Pitch",
        "Heading",
    ]
    assert table[0][19:23] == ["VFP_SP", "VFP_PV", "VFS_SP", "VFS_PV"]
    assert table[0][-3:] == ["Altitude", "Voltage", "TetherLength"]
    assert len(table) == 1 + round(SECONDS / STEP_S)
    assert {len(row) for row in table} == {len(table[0])}
    at = table[0].index("LinVelX")
    assert any(row[at] == "" for row in table) and not any("nan" in row for row in table)
    heading = [float(row[9]) for row in table[1:]]
    assert min(heading) >= 0.0 and max(heading) <= 360.0


def test_the_generator_writes_logs_and_labels_apart(tmp_path: Path, merlin: Path) -> None:
    cases = [
        {"mission": "rich", "duration_s": 5.0},
        {"mission": "survey", "effects": [{"name": "buoyancy_error", "severity": 2.0}], "duration_s": 5.0, "seed": 7},
    ]
    (tmp_path / "cases.json").write_text(json.dumps(cases), encoding="utf-8")
    words = ["--vehicle", str(merlin), "--out", str(tmp_path / "logs"), "--seed", "1", "--cases", str(tmp_path / "cases.json")]
    assert generate.main(words) == 0
    labels = json.loads((tmp_path / "logs-labels" / "labels.json").read_text(encoding="utf-8"))["logs"]
    assert sorted(labels) == sorted(p.name for p in (tmp_path / "logs").iterdir())
    assert sorted(len(label["effects"]) for label in labels.values()) == [0, 1]


def test_the_grid_holds_every_effect_and_healthy_logs(merlin: Path) -> None:
    cases = grid(merlin, 1)
    assert {e.name for case in cases for e in case.effects} == set(catalogue())
    assert sum(not case.effects for case in cases) >= 40
    assert len({case.seed for case in cases}) == len(cases)
    assert {len(case.effects) for case in cases} == {0, 1, 2, 3}
    begun = [e for case in cases for e in case.effects if e.onset_s is not None]
    assert len(begun) == BEGIN and all(0.3 * DURATION_S <= float(e.onset_s or 0.0) <= 0.55 * DURATION_S for e in begun)


def test_the_plant_shares_no_code_with_what_it_tests() -> None:
    """Modules that make the truth import nothing of rovval but one another, the second plant, refusals, and how a file is written whole."""
    rooms = ("plant", "planted", "missions", "cases")
    files = [path for room in rooms for path in (ROOT / "src/rovval/blind" / room).glob("*.py")]
    allowed = (*(f"rovval.blind.{room}" for room in rooms), "rovval.blind.second", "rovval.storage.atomic", "rovval.core.errors")
    assert {path.parent.name for path in files} == set(rooms)
    for path in files:
        used = re.findall(r"^\s*(?:from|import)\s+(rovval[\w.]*)", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert all(name.startswith(allowed) for name in used), f"{path.name} imports {used}"
