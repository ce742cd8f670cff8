"""The thesis's scenarios: what they check holds for the vehicles of the library, and what does not hold is said."""

import json

import pytest
from command_case import run, write_dive

from rovval import vehicle
from rovval.fly.scenarios.table_6_1 import refusals, rows


@pytest.mark.parametrize("number", ["1", "2", "3"])
@pytest.mark.parametrize("name", ["merlin", "bluerov2_heavy"])
def test_scenarios_meet_the_thesis(number, name):
    document = json.loads(run("scenario", number, "--vehicle", name, "--json").stdout)
    assert document["passed"]
    assert all(check["holds"] for check in document["checks"])


def test_scenario_2_ends_on_the_thrusts_of_table_6_1():
    printed = json.loads(run("scenario", "2", "--json").stdout)["table_6_1"]
    assert [round(r["thrust_n"], 1) for r in printed] == [82.7, 31.3, 83.8, 87.0, 35.2, 86.7, 31.4]


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


def test_a_vehicle_without_a_righting_moment_fails_scenario_1(tmp_path):
    """Centre of buoyancy at the centre of gravity: upright it lies as still as any, tilted it stays so."""
    source = (vehicle.LIBRARY / "merlin.toml").read_text().replace("centre_of_buoyancy = [0.0, 0.0, -0.10]", "centre_of_buoyancy = [0.0, 0.0, 0.0]")
    (tmp_path / "neutral.toml").write_text(source)
    document = json.loads(run("scenario", "1", "--vehicle", str(tmp_path / "neutral.toml"), "--json", code=1).stdout)
    assert [c["expected"] for c in document["checks"] if not c["holds"]] == ["rights itself when it is let go tilted"]
    assert document["tilt_left_deg"] == pytest.approx(10.0, abs=0.2)


@pytest.mark.slow
def test_speeds_are_relative_to_the_vehicle_and_can_be_asked_for():
    """70 rpm on Merlin; a vehicle whose propellers turn faster for the same speed gets more; what hardly moves does not pass."""
    assert json.loads(run("scenario", "3", "--json").stdout)["fastest_rpm"] == pytest.approx(70.0)
    assert json.loads(run("scenario", "3", "--vehicle", "bluerov2_heavy", "--json").stdout)["fastest_rpm"] > 1000.0
    slow = json.loads(run("scenario", "3", "--rpm", "1", "--json", code=1).stdout)
    assert slow["fastest_rpm"] == pytest.approx(1.0) and not slow["passed"]


def test_a_document_follows_the_thesis_figure_by_figure(tmp_path):
    """Each figure of the scenarios that were asked for, in the thesis's order, and its tables beside ours."""
    run("scenario", "2", "--out", str(tmp_path / "two"), "--model", "fossen")
    page = (tmp_path / "two" / "scenarios.html").read_text()
    places = [page.index(f">Figure 5.{n}:") for n in range(6, 13)]
    assert places == sorted(places) and page.count("<svg") == 11
    text = (tmp_path / "two" / "scenarios.md").read_text()
    assert "| VFP | 82.7 | 80.5 | -2.7 % |" in text and "Circular" in text
    assert (tmp_path / "two" / "scenario-2-fossen.rrd").stat().st_size > 1000


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "model"),
    [("merlin", "fossen"), ("merlin", "uuv"), ("minerva", "fossen"), ("bluerov2", "uuv")],
)
def test_scenario_3_closes_the_loop_round_way_points(name, model):
    checks = json.loads(run("scenario", "3", "--vehicle", name, "--model", model, "--json").stdout)["checks"]
    closed = [c for c in checks if c["expected"].startswith("closed loop")]
    assert len(closed) == 4 and all(c["holds"] for c in closed)


@pytest.mark.slow
def test_scenarios_4_and_5_of_another_vehicle_have_a_log_of_its_own():
    """Synthetic, with an effect in it that the simulator beside it does not know; its name says what it is."""
    document = json.loads(run("scenario", "5", "--vehicle", "bluerov2_heavy", "--json").stdout)
    assert document["run"] == "SYNTHETIC_bluerov2_heavy_protocol" and document["vehicle"] == "bluerov2_heavy"
    assert abs(document["table_6_2"]["surge"]["mean_error"]) > 1e-4


@pytest.mark.slow
def test_a_platform_that_cannot_simulate_a_vehicle_is_left_out_of_table_6_1_and_says_why():
    nominal = vehicle.load("bluerov_2016")  # its added mass is 6.5 times its own
    assert set(rows(nominal)[0].ours) == {"fossen", "freefloating"}
    assert list(refusals(nominal)) == ["uuv"] and "unstable" in refusals(nominal)["uuv"]
