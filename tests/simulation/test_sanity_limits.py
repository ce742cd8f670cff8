"""Speeds that a vehicle's file rules out are a finding; a simulated motion that no ROV makes ends there, with exit code 4."""

from dataclasses import replace

import batch_case
import command_case
import numpy as np
import pytest
from report_cases import make_run
from typer.testing import CliRunner

from rovval import vehicle
from rovval.cli import logs
from rovval.cli.app import app
from rovval.core.channels import channel
from rovval.core.data import Run
from rovval.core.errors import SimulationStopped
from rovval.pipeline.steps import checked_against
from rovval.simulation import simulate
from rovval.simulation.sanity_limits import first_beyond, overspeed, thrust_against_motion
from rovval.storage.archive import open_run

MERLIN = vehicle.load("merlin")


def wild(rpm: float, first: int = 300, n: int = 600) -> Run:
    """A run of slow thrusters, of which one turns at ``rpm`` from row ``first`` on."""
    run = make_run(n)
    slow = {name: 0.1 * values if name.startswith("n:") else values for name, values in run.values.items()}
    fast = np.where(np.arange(n) < first, slow["n:VFP"], rpm / 60.0)
    return replace(run, values={**slow, "n:VFP": fast})


def test_a_speed_beyond_the_files_limit_is_a_finding():
    run = wild(-3000.0)
    [found] = overspeed(run, MERLIN)
    assert (found.code, found.where) == ("overspeed", "n:VFP")
    assert "300 of 600 values beyond the 500 rpm of vehicle merlin, worst 3000 rpm" in found.detail
    beside = checked_against(run, MERLIN)
    assert checked_against(beside, MERLIN).findings == beside.findings, "said once"


def test_a_file_without_a_limit_raises_none():
    free = MERLIN.model_copy(update={"thruster": tuple(t.model_copy(update={"rpm_max": None}) for t in MERLIN.thruster)})
    assert overspeed(wild(3000.0), free) == ()
    assert free.hash == MERLIN.hash, "it moves nothing"


def test_the_first_motion_beyond_the_limits_is_told_with_its_axis_and_limit():
    """No faster than a log may hold, and no more than a turn a second."""
    fastest = channel("u").high
    nu = np.zeros((5, 6))
    nu[1, :3], nu[1, 3:] = fastest, -2 * np.pi
    assert first_beyond(nu) is None
    nu[3, 4], nu[4, 0] = -11.9, fastest + 1
    assert first_beyond(nu) == (3, "pitch at -682 deg/s, limit 360 deg/s")
    nu[2, 1] = -fastest - 1
    assert first_beyond(nu) == (2, f"sway at {-fastest - 1:g} m/s, limit {fastest:g} m/s")


@pytest.mark.parametrize("rpm", [3000.0, 300000.0])
def test_a_wild_motion_ends_where_it_leaves_the_limits(rpm):
    """Also where only some of the windows do so (the reason of another window was looked up, and the command ended in 70)."""
    run = wild(rpm)
    sim = simulate(run, MERLIN)
    assert len(sim.stops) == 1 and "stretch from 0.0 s stopped at 30." in sim.stops[0]
    assert not sim.free.ok[310:].any() and sim.windowed.ok[:300].all() and not sim.windowed.ok.all()
    for motion in (sim.free, sim.windowed):
        assert first_beyond(np.nan_to_num(motion.nu)) is None
    with pytest.raises(SimulationStopped, match=r"left sane limits: stretch from 0\.0 s"):
        logs.refuse_stopped(sim)


@pytest.mark.parametrize("command", ["compare", "simulate"])
def test_the_command_writes_what_there_is_and_ends_with_4(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    log = batch_case.write_log(tmp_path / "dive.csv", seconds=20)
    rows = [line.split(",") for line in log.read_text().splitlines()]
    for row in rows[100:]:
        row[rows[0].index("VFP_PV")] = "3000"
    log.write_text("\n".join(map(",".join, rows)) + "\n")
    done = CliRunner().invoke(app, [command, "dive.csv", "--profile", "merlin"])
    assert isinstance(done.exception, SimulationStopped) and done.exception.exit_code == 4
    assert "overspeed: n:VFP" in done.stderr and "beyond the 500 rpm" in done.stderr
    assert list((tmp_path / "reports").rglob("report.html" if command == "compare" else "fossen.parquet"))


@pytest.mark.parametrize(
    ("times", "said"), [(1 / 60, "rev/s taken for rpm is 60"), (np.pi / 30, "rad/s taken for rpm is 9.55"), (1.0, ""), (0.5, ""), (2.0, "")]
)
def test_speeds_too_small_for_the_motion_are_suspected_by_their_unit(tmp_path, times, said):
    """A log in rev/s that the profile calls rpm was a simulator that hardly moves, and no word of it."""
    run = open_run(command_case.write_dive(tmp_path))
    scaled = replace(run, values={name: times * v if name.startswith("n:") else v for name, v in run.values.items()})
    found = thrust_against_motion(scaled, MERLIN)
    assert [f.code for f in found] == ["unit"] * bool(said) and all(said in f.detail for f in found)


def test_a_vehicle_that_drifts_without_thrust_is_not_suspected(tmp_path):
    run = open_run(command_case.write_dive(tmp_path))
    rng = np.random.default_rng(0)
    idle = replace(run, values={name: rng.normal(0, 0.01, len(run)) if name.startswith("n:") else v for name, v in run.values.items()})
    assert thrust_against_motion(idle, MERLIN) == ()


def test_thrust_that_no_vehicle_has_is_suspected():
    [found] = thrust_against_motion(wild(60_000.0), MERLIN)
    assert found.code == "unit" and "times the weight of merlin" in found.detail


def test_a_missing_feedback_says_what_drives_the_thrusters_instead(tmp_path, monkeypatch):
    """One speed of seven that was blank sent all thrusters to their set-points without a word on the terminal."""
    monkeypatch.chdir(tmp_path)
    log = batch_case.write_log(tmp_path / "dive.csv", seconds=20)
    rows = [line.split(",") for line in log.read_text().splitlines()]
    for row in rows[1:]:
        row[rows[0].index("VAC_PV")] = "nan"
    log.write_text("\n".join(map(",".join, rows)) + "\n")
    done = CliRunner().invoke(app, ["compare", "dive.csv", "--profile", "merlin"])
    assert done.exit_code == 0
    assert "thruster_input: n:VAC: no measured speed, so the speed set-point drives all thrusters" in done.stderr
