"""What is exported comes back: through our own readers, through the formats' own libraries, and with the numbers of the run."""

from __future__ import annotations

import json

import numpy as np
import polars as pl
import pytest
from command_case import run as rovval
from command_case import write_dive
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader

from rovval import vehicle
from rovval.core.channels import POSE, VELOCITIES
from rovval.core.errors import BadInput, UsageProblem
from rovval.core.frames import FLU_TO_FSD, rotation_from_quaternion
from rovval.export import formats, suffix, write
from rovval.simulation import simulate
from rovval.storage.archive import open_run


@pytest.fixture(scope="module")
def dive(tmp_path_factory):
    return write_dive(tmp_path_factory.mktemp("dive"))


@pytest.fixture(scope="module")
def run(dive):
    return open_run(dive, "merlin")


@pytest.fixture(scope="module")
def sim(run):
    return simulate(run, vehicle.load("merlin"))


def test_formats_are_the_files_of_the_room():
    assert formats() == ("bag", "csv", "mcap", "parquet", "tum")
    with pytest.raises(UsageProblem, match="unknown format 'xls'"):
        suffix("xls")


@pytest.mark.parametrize("name", formats())
def test_a_disk_that_takes_no_more_is_one_refusal_and_leaves_nothing(name, run, tmp_path, no_more_than):
    with no_more_than(4096), pytest.raises(UsageProblem, match="cannot be written"):
        write(run, name, tmp_path / f"a{suffix(name)}")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["bag", "mcap"])
def test_a_bag_comes_back_as_the_run(name, run, sim, tmp_path):
    (path,) = write(run, name, tmp_path / f"a.{name}", sim)
    back = open_run(path, "ros_odometry")
    assert len(back) == len(run) and not back.findings
    for channel in (*POSE, *VELOCITIES, *(n for n in run.values if n.startswith("n:"))):
        assert np.allclose(back.values[channel], run.values[channel], atol=1e-12, equal_nan=True), channel


def test_the_simulated_odometry_stands_beside_the_measured_one(run, sim, tmp_path):
    """By the reference library of MCAP and its decoder: poses rotate, velocities are along the body's own axes."""
    (path,) = write(run, "mcap", tmp_path / "a.mcap", sim)
    with path.open("rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        found = {t: [d.decoded_message for d in reader.iter_decoded_messages(topics=[t])] for t in ("/odom", "/simulated/odom", "/simulated/windows/odom")}
    assert {len(m) for m in found.values()} == {len(run)} and found["/simulated/odom"][5].child_frame_id == "simulated/base_link"
    for topic, eta, nu in (("/odom", run.stack(POSE), run.stack(VELOCITIES)), ("/simulated/odom", sim.free.eta, sim.free.nu)):
        one, i = found[topic][100], 100
        p, q, v = one.pose.pose.position, one.pose.pose.orientation, one.twist.twist.linear
        assert np.allclose([p.x, p.y, p.z], [eta[i, 1], eta[i, 0], -eta[i, 2]])
        assert np.allclose([v.x, v.y, v.z], FLU_TO_FSD @ nu[i, :3])
        forward = rotation_from_quaternion(np.array([q.w, q.x, q.y, q.z]))[:, 0]
        heading = eta[i, 5]
        assert np.allclose(forward[:2] / np.linalg.norm(forward[:2]), [np.sin(heading), np.cos(heading)])  # east, north


def test_a_bag_is_read_by_rosbags_with_every_channel(run, sim, tmp_path):
    (path,) = write(run, "bag", tmp_path / "a.bag", sim)
    with AnyReader([path]) as reader:
        counts = {topic: info.msgcount for topic, info in reader.topics.items()}
        kinds = {info.msgtype for info in reader.topics.values()}
    assert counts["/odom"] == counts["/simulated/windows/odom"] == len(run) and counts["/tf"] == 3 * len(run)
    assert all(f"/thrusters/{n}/rpm" in counts and f"/simulated/thrusters/{n}/thrust" in counts for n in sim.thrusters)
    assert kinds == {"nav_msgs/msg/Odometry", "std_msgs/msg/Float64", "tf2_msgs/msg/TFMessage"}


@pytest.mark.parametrize("name", ["csv", "parquet"])
def test_tables_hold_every_channel_with_its_unit(name, run, sim, tmp_path):
    (path,) = write(run, name, tmp_path / f"a.{name}", sim)
    table = pl.read_csv(path) if name == "csv" else pl.read_parquet(path)
    assert len(table) == len(run)
    assert {"t [s]", "u [m/s]", "psi [rad]", "n:HFP [rev/s]", "sim_u [m/s]", "simw_x [m]", "sim_thrust:HFP [N]"} <= set(table.columns)
    assert np.array_equal(table["u [m/s]"].to_numpy(), run.values["u"]) and np.array_equal(table["sim_r [rad/s]"].to_numpy(), sim.free.nu[:, 5])
    if name == "parquet":
        assert pl.read_parquet_metadata(path)["run"] == run.id


def test_what_is_missing_is_missing_in_the_file(dive, tmp_path):
    lines = dive.read_text().splitlines()
    header = lines[0].split(",")
    at = header.index("LinVelX")
    for k in range(100, 120):
        cells = lines[k].split(",")
        cells[at] = ""
        lines[k] = ",".join(cells)
    (tmp_path / "gap.csv").write_text("\n".join(lines) + "\n")
    run = open_run(tmp_path / "gap.csv", "merlin")
    assert (~run.ok("u")).sum() == 20
    (table,) = write(run, "parquet", tmp_path / "gap.parquet")
    assert pl.read_parquet(table)["u [m/s]"].null_count() == 20
    (bag,) = write(run, "mcap", tmp_path / "gap.mcap")
    assert np.array_equal(open_run(bag, "ros_odometry").ok("u"), run.ok("u"))


def test_trajectories_are_poses_with_their_stamps(run, sim, tmp_path):
    files = write(run, "tum", tmp_path / "a.tum", sim)
    assert [f.name for f in files] == ["a.tum", "a_simulated.tum", "a_simulated_windows.tum"]
    table = np.loadtxt(files[0])
    assert table.shape == (len(run), 8) and np.allclose(np.diff(table[:, 0]), 0.1) and np.allclose(np.linalg.norm(table[:, 4:], axis=1), 1.0)
    assert np.allclose(table[:, 1], run.values["y"])


def test_a_simulation_of_another_run_is_refused(run, sim, dive, tmp_path):
    from rovval.alignment.stretch import stretch_of

    with pytest.raises(BadInput, match="a simulation of run"):
        write(stretch_of(run, 5.0, 20.0), "bag", tmp_path / "a.bag", sim)
    assert list(tmp_path.iterdir()) == []


def test_the_command_writes_and_names_its_files(dive, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    printed = rovval("export", str(dive), "--to", "tum", "--from", "5", "--until", "20", "--json")
    document = json.loads(printed.stdout)
    assert document["schema"] == "rovval.export/1" and document["format"] == "tum"
    (path,) = document["files"]
    assert path == f"reports/{document['run']}/{document['run']}.tum" and len(np.loadtxt(tmp_path / path)) == 151
