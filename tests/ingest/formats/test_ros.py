"""Bags: the same motion written as ROS 1, db3 and mcap, by two writers, gives the same run; damage gives one refusal."""

from __future__ import annotations

import shutil
import sqlite3
from typing import Any

import numpy as np
import pytest
from bag_case import START_NS, N, motion, write
from mcap.writer import Writer as RawMcapWriter
from mcap_ros2.writer import Writer as McapWriter
from real_data import real
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from rovval import vehicle
from rovval.comparison import compare
from rovval.core.data import Reason
from rovval.core.errors import BadInput
from rovval.ingest import read
from rovval.ingest.formats.ros_bag import read as read_bag
from rovval.ingest.profile import parse_profile
from rovval.simulation import simulate
from rovval.storage.archive import open_run


@pytest.fixture(scope="module")
def bags(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bags")
    found = {"bag": write("bag", folder / "one.bag"), "db3": write("db3", folder / "two"), "mcap": write("mcap", folder / "three")}
    found["bare db3"] = next(found["db3"].glob("*.db3"))
    found["bare mcap"] = next(found["mcap"].glob("*.mcap"))
    folder_only = folder / "no_metadata"
    folder_only.mkdir()
    shutil.copy(found["bare mcap"], folder_only)
    found["folder without metadata"] = folder_only
    return found


KINDS = ["bag", "db3", "mcap", "bare db3", "bare mcap", "folder without metadata"]


@pytest.mark.parametrize("kind", KINDS)
def test_every_container_gives_the_same_run_in_ned(bags, kind):
    run = open_run(bags[kind])
    _t, yaw, position, velocity, rate = motion()
    assert run.profile == "ros_odometry" and len(run) == N and run.t0_ns == START_NS
    assert np.allclose(run.values["x"], position[:, 1]) and np.allclose(run.values["y"], position[:, 0])
    assert np.allclose(run.values["z"], -position[:, 2])
    assert np.allclose([run.values[n][5] for n in "uvw"], velocity * [1, -1, -1])
    assert np.allclose([run.values[n][5] for n in "pqr"], rate * [1, -1, -1])
    assert np.allclose(run.values["phi"], 0.1) and np.allclose(run.values["theta"], 0.2)
    assert np.allclose(np.unwrap(run.values["psi"]), np.pi / 2 - yaw)
    assert np.allclose(run.values["n:T1"], 10.0) and np.allclose(run.values["n:T2"], -np.arange(N))
    assert run.clock.stamp == "header+record" and run.properties["record_minus_header_s"] == "0.0300"


def test_kinematics_hold_after_the_turn_of_axes(bags):
    """In north-east-down too, the heading's rate is r, which a wrong sign of either would break."""
    run = open_run(bags["bag"])
    assert np.allclose(np.diff(np.unwrap(run.values["psi"])), run.values["r"][0] * 0.1)


def test_an_independent_writer_is_read_too(tmp_path):
    path = tmp_path / "other.mcap"
    with path.open("wb") as file:
        writer = McapWriter(file)
        schema = writer.register_msgdef("std_msgs/msg/Float64", "float64 data")
        for i in range(50):
            writer.write_message("/depth", schema, {"data": float(i)}, log_time=START_NS + i * 10**8, publish_time=START_NS + i * 10**8)
        writer.finish()
    profile = parse_profile(
        {
            "name": "depth", "description": "", "format": "ros_bag", "frame": "fsd", "world": "ned", "time": {"kind": "record"},
            "channels": {"z": {"topic": "/depth", "field": "data", "unit": "cm"}},
        }, "test",
    )  # fmt: skip
    assert np.allclose(read_bag(path, profile).channels["z"].values, np.arange(50) * 0.01)


ALTERNATIVES: dict[str, Any] = {
    "name": "either", "description": "", "format": "ros_bag", "frame": "flu", "world": "enu", "time": {"kind": "record"},
    "channels": {
        "u": {"topic": ["odom", "/odom"], "field": "twist.twist.linear.x", "unit": "m/s"},
        "n:*": {"topic": ["thrusters/*/rpm", "/thrusters/*/rpm"], "field": "data", "unit": "rpm"},
    },
}  # fmt: skip


def test_a_topic_may_have_several_names_and_the_first_that_is_there_is_read(bags):
    raw = read_bag(bags["bag"], parse_profile(ALTERNATIVES, "test"))
    assert set(raw.channels) == {"u", "n:T1", "n:T2"} and raw.properties["topics"] == "/odom, /thrusters/T1/rpm, /thrusters/T2/rpm"
    both = ALTERNATIVES["channels"] | {"u": {"topic": ["/thrusters/T1/rpm", "/odom"], "field": "data", "unit": "m/s"}}
    assert read_bag(bags["bag"], parse_profile(ALTERNATIVES | {"channels": both}, "test")).channels["u"].values[0] == 600.0


def test_a_topic_under_none_of_its_names_is_missing_under_all(bags):
    absent = ALTERNATIVES | {"channels": {"u": {"topic": ["odo", "/odo"], "field": "x", "unit": "m/s"}}}
    with pytest.raises(BadInput, match="odo or /odo"):
        read_bag(bags["bag"], parse_profile(absent, "test"))


@pytest.mark.parametrize("bag", ["yaw_1", "sinRA1F05", "stepRS3E10", "ExactLin", "act_3_4_test_1", "act_3_4_test_4"])
def test_the_bags_of_a_bluerov_of_2016_compare(bag: str):
    """Pulse widths that begin late or end early are missing there, with or without a leading slash, and may stand at the end of the table; angles in degrees
    are told by their values; the vehicle turns as it is driven, but where it is held while its thrusters turn at full speed, or rolls over."""
    run = open_run(real(f"bluerov_2016/{bag}.bag"))
    assert run.vehicle.endswith("bluerov_2016")
    comparison = compare(run, simulate(run, vehicle.load("bluerov_2016")))
    assert comparison.sim.input_source == "pulse width"
    assert run.profile == ("bluerov_2016_degrees" if bag.startswith("act") else "bluerov_2016")
    if bag.startswith(("yaw", "act")):
        assert any(f.code == "short" for f in run.findings)
        skill = comparison.windowed["yaw"].skill
        assert skill is not None and skill > 0.4


def test_messages_in_the_write_ahead_log_are_not_lost(bags, tmp_path):
    """rosbags opens a db3 as immutable: what a crashed recorder left in the -wal file would be missing without a word."""
    folder = tmp_path / "crashed"
    shutil.copytree(bags["db3"], folder)
    file = next(folder.glob("*.db3"))
    live = tmp_path / "live.db3"
    shutil.copy(file, live)
    database = sqlite3.connect(live, isolation_level=None)
    database.execute("PRAGMA journal_mode=WAL")
    database.execute("PRAGMA wal_autocheckpoint=0")
    rows = database.execute("SELECT topic_id, timestamp, data FROM messages ORDER BY id DESC LIMIT 300").fetchall()
    database.execute("DELETE FROM messages WHERE id > (SELECT MAX(id) - 300 FROM messages)")
    database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    database.executemany("INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)", rows[::-1])
    shutil.copy(live, file)
    shutil.copy(tmp_path / "live.db3-wal", folder / (file.name + "-wal"))
    database.close()
    for source in (folder, file):
        raw = read(source)
        assert len(raw.channels["u"].t) == N
        assert any(f.code == "write_ahead_log" for f in raw.findings)


@pytest.mark.parametrize("kind", ["bag", "bare db3", "bare mcap"])
def test_flipped_bytes_never_give_a_traceback(bags, kind, tmp_path):
    whole = np.frombuffer(bags[kind].read_bytes(), dtype=np.uint8)
    rng = np.random.default_rng(5)
    for trial in range(12):
        spoiled = whole.copy()
        spoiled[rng.integers(20, len(whole), 8)] ^= 0xFF
        path = tmp_path / f"{trial}{bags[kind].suffix}"
        path.write_bytes(spoiled.tobytes())
        try:
            read(path)
        except BadInput as refused:
            assert refused.hint


def test_missing_topics_and_fields_are_named_at_once(bags, tmp_path):
    profile = tmp_path / "p.toml"
    profile.write_text(
        """name = "p"
description = ""
format = "ros_bag"
frame = "flu"
world = "enu"
time = { kind = "header" }
[channels]
u = { topic = "/odom", field = "twist.twist.linear.x", unit = "m/s" }
v = { topic = "/dvl", field = "x", unit = "m/s" }
w = { topic = "/dvl2", field = "x", unit = "m/s" }
"""
    )
    with pytest.raises(BadInput, match=r"2 problems\n  - /dvl\n  - /dvl2"):
        read(bags["bag"], str(profile))
    profile.write_text(profile.read_text().replace('"/dvl', '"/odom').replace("/odom2", "/odom"))
    with pytest.raises(BadInput, match=r"/odom \(nav_msgs/msg/Odometry\) has no number 'x'"):
        read(bags["bag"], str(profile))


def test_a_csv_profile_on_a_bag_is_refused(bags):
    with pytest.raises(BadInput, match="is binary, not a table of text"):
        read(bags["bag"], "merlin")


@pytest.mark.parametrize("name", ["exp1_1", "exp1_2", "exp1_3", "exp1_4", "exp1_5"])
def test_upward_thrust_lessens_depth_on_the_published_bags(name):
    """Heave is positive down: its stick leads the rate of depth by about a second with a positive correlation."""
    run = open_run(real(f"bluerov2_ballast/{name}.bag"))
    assert run.profile == "bluerov2_ballast" and run.get("z")[run.ok("z")].min() > 0.2
    ok = run.ok("z") & run.ok("stick:heave")
    z, stick = run.get("z")[ok], run.get("stick:heave")[ok]
    rate = np.gradient(np.convolve(z, np.ones(5) / 5, "same"), 0.1)[5:-5]
    assert np.corrcoef(rate[10:], stick[5:-15])[0, 1] > 0.7


def test_released_without_ballast_the_vehicle_sinks_and_with_it_floats():
    sunk, floating = (open_run(real(f"bluerov2_ballast/{n}.bag")) for n in ("ff_nb1", "ff_b1"))
    assert sunk.get("z")[-30:-10].mean() > 1.0 and abs(floating.get("z")[-30:-10].mean()) < 0.1
    assert not sunk.get("stick:heave")[sunk.ok("stick:heave")].any()
    assert (sunk.reasons["z"] != Reason.GAP).all()


def custom(**more):
    table = {
        "name": "custom", "description": "", "format": "ros_bag", "frame": "fsd", "world": "ned", "time": {"kind": "header"},
        "channels": {"n:HFP": {"topic": "/thruster", "field": "data", "unit": "rpm"}},
    }  # fmt: skip
    return parse_profile(table | more, "test")


def test_types_that_an_old_db3_does_not_define_come_from_the_profile(tmp_path):
    """Bags recorded before ROS 2 Iron hold no definitions; without the .msg text a custom type is a bare KeyError of rosbags."""
    text = "std_msgs/Header header\nfloat64 data\n"
    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg(text, "srov_msgs/msg/Float64Stamped"))
    T, kind = store.types, "srov_msgs/msg/Float64Stamped"
    with Bag2(tmp_path / "old", version=9, storage_plugin=StoragePlugin.SQLITE3) as bag:
        connection = bag.add_connection("/thruster", kind, typestore=store)
        for i in range(20):
            stamp = T["builtin_interfaces/msg/Time"](sec=1_700_000_000 + i, nanosec=0)
            message = T[kind](header=T["std_msgs/msg/Header"](stamp=stamp, frame_id=""), data=60.0 * i)
            bag.write(connection, START_NS + i * 10**9, store.serialize_cdr(message, kind))
    file = next((tmp_path / "old").glob("*.db3"))
    database = sqlite3.connect(file)
    database.execute("DROP TABLE message_definitions")
    database.execute("UPDATE schema SET schema_version = 3")
    database.commit()
    database.close()
    with pytest.raises(BadInput, match="damaged or foreign") as refused:
        read_bag(file, custom())
    assert "[messages]" in refused.value.hint
    raw = read_bag(file, custom(messages={kind: text}))
    assert np.allclose(raw.channels["n:HFP"].values, np.arange(20))


def test_an_mcap_of_another_middleware_is_read_by_its_topics(tmp_path):
    """With messages as JSON: a profile of ROS names other topics than it has."""
    path = tmp_path / "other.mcap"
    with path.open("wb") as file:
        writer = RawMcapWriter(file)
        writer.start(profile="px4")
        writer.add_message(writer.register_channel("/state", "json", 0), START_NS, b"{}", START_NS)
        writer.finish()
    with pytest.raises(BadInput, match=r"(?s)missing of profile 'ros_odometry'.*/odom"):
        read(path, "ros_odometry")
