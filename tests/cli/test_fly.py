"""`rovval fly` as a script sees it: what it writes, prints and refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command_case import run

from rovval.core.errors import UsageProblem
from rovval.storage.archive import load_run

MISSION = """vehicle = "merlin"
[sensors]
[[leg]]
kind = "hold"
for_s = 5.0
depth_m = 21.0
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("m.toml").write_text(MISSION)


def test_a_mission_is_kept_as_a_run_and_its_truth_beside_it(folder):
    document = json.loads(run("fly", "m.toml", "--out", "runs/first", "--json").stdout)
    assert document["run"] == str(Path("runs/first")) and document["vehicle"] == "merlin"
    assert load_run("runs/first").properties["loop"] == "closed on sensors" and load_run("runs/first-truth").measured("z")
    assert not Path("reports").exists()
    run("compare", "runs/first", "--json")
    run("fly", "m.toml", "--noise", "0", "--out", "runs/second", "--report", "page", "-q")
    assert not Path("runs/second-truth").exists() and Path("page/flight.html").is_file()


def test_a_run_that_was_not_flown_is_never_replaced(folder):
    Path("runs/mine").mkdir(parents=True)
    with pytest.raises(UsageProblem, match="not flown by rovval"):
        run("fly", "m.toml", "--out", "runs/mine")


def test_a_dry_run_flies_nothing_and_says_by_its_exit_code_what_is_exceeded(folder):
    assert "nothing would be exceeded" in run("fly", "m.toml", "--dry-run").stdout
    Path("m.toml").write_text(MISSION + "speed_m_s = 9.0\n")
    shown = run("fly", "m.toml", "--dry-run", "--json", code=1)
    assert "9 m/s in surge" in json.loads(shown.stdout)["timeline"][0]["exceeds"][0]
    assert not Path("archive").exists()


def test_a_mission_without_a_vehicle_asks_for_one(folder):
    Path("m.toml").write_text(MISSION.replace('vehicle = "merlin"\n', ""))
    with pytest.raises(UsageProblem, match="names no vehicle"):
        run("fly", "m.toml")
    with pytest.raises(UsageProblem, match="protocol, steps, survey"):
        run("fly", "no_such")
