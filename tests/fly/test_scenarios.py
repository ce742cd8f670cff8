"""The thesis's scenarios: what they check holds for the vehicles of the library, and what does not hold is said."""

import json

import pytest
from command_case import run, write_dive

from rovval import vehicle


@pytest.mark.parametrize("number", ["1", "2", "3"])
@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy"])
def test_scenarios_meet_the_thesis(number, name):
    document = json.loads(run("scenario", number, "--vehicle", name, "--json").stdout)
    assert document["passed"]
    assert all(check["holds"] for check in document["checks"])


def test_scenario_2_ends_on_the_thrusts_of_table_6_1():
    rows = json.loads(run("scenario", "2", "--json").stdout)["table_6_1"]
    assert [round(r["thrust_n"], 1) for r in rows] == [82.7, 31.3, 83.8, 87.0, 35.2, 86.7, 31.4]


def test_scenario_says_when_it_is_not_met(tmp_path):
    """A vehicle that is trimmed far too light does not lie still."""
    source = (vehicle.LIBRARY / "merlin.toml").read_text().replace("volume = 2.86341", "volume = 3.2")
    (tmp_path / "light.toml").write_text(source)
    done = run("scenario", "1", "--vehicle", str(tmp_path / "light.toml"), code=1)
    assert "FAIL" in done.stdout
    assert "NOT passed" in done.stdout


def test_scenario_4_lists_the_channels_and_5_compares(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_dive(tmp_path)
    four = json.loads(run("scenario", "4", "dive.csv", "--json").stdout)
    assert all(c["holds"] for c in four["checks"])
    assert {"u", "n:HFP", "n_cmd:HFP", "udot"} <= {c["channel"] for c in four["channels"]}
    five = json.loads(run("scenario", "5", "dive.csv", "--json").stdout)
    assert five["table_6_2"]["yaw"]["unit"] == "deg/s"
