"""Real tools as peers, where they are installed: Debian's python3-rosbag (with python3-nav-msgs, python3-tf2-msgs) and evo."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest
from command_case import write_dive

from rovval.export import write
from rovval.ingest import read
from rovval.storage.archive import open_run

pytestmark = pytest.mark.slow
SYSTEM_PYTHON = "/usr/bin/python3"
RECORD = """
import rosbag, rospy, sys
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64
with rosbag.Bag(sys.argv[1], "w", compression=sys.argv[2], chunk_threshold=20000) as bag:
    for i in range(300):
        t = rospy.Time(1700000000 + i // 10, i % 10 * 100000000)
        odometry = Odometry()
        odometry.header.stamp, odometry.header.frame_id = t, "odom" + "x" * (i % 3)
        odometry.pose.pose.orientation.w, odometry.twist.twist.linear.x = 1.0, 0.01 * i
        bag.write("/odom", odometry, t)
        bag.write("/thrusters/T1/rpm", Float64(6.0 * i), t)
"""
CUSTOM = """
import genpy.dynamic, rosbag, rospy, sys
DEFINED = "Header header\\nfloat64[] rpm\\nmy_rov/State state\\n" + "=" * 80 + "\\nMSG: my_rov/State\\nuint8 mode\\nstring word\\n"
DEFINED += "=" * 80 + "\\nMSG: std_msgs/Header\\nuint32 seq\\ntime stamp\\nstring frame_id\\n"
Thrusters = genpy.dynamic.generate_dynamic("my_rov/Thrusters", DEFINED)["my_rov/Thrusters"]
with rosbag.Bag(sys.argv[1], "w", compression="lz4") as bag:
    for i in range(300):
        t = rospy.Time(1700000000 + i // 10, i % 10 * 100000000)
        message = Thrusters()
        message.header.stamp, message.rpm, message.state.word = t, [6.0 * i, -12.0 * i], "w" * (i % 5)
        bag.write("/thrusters", message, t + rospy.Duration(0, 30000000))
"""
CUSTOM_PROFILE = """
name = "own"
description = "of the tests"
format = "ros_bag"
frame = "flu"
world = "enu"
[time]
kind = "header"
[channels]
"n:HP" = { topic = "/thrusters", field = "rpm[0]", unit = "rpm" }
"n:VS" = { topic = "/thrusters", field = "rpm[1]", unit = "rpm" }
"""


def tool(*command: str) -> str:
    if shutil.which(command[0]) is None:
        pytest.skip(f"{command[0]} is not installed")
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("compression", ["none", "lz4", "bz2"])
def test_bags_of_ros_1_itself_are_read_whole_and_cut(compression, tmp_path):
    if subprocess.run([SYSTEM_PYTHON, "-c", "import rosbag, nav_msgs"], capture_output=True, check=False).returncode:
        pytest.skip("python3-rosbag and python3-nav-msgs are not installed")
    path = tmp_path / "one.bag"
    tool(SYSTEM_PYTHON, "-c", RECORD, str(path), compression)
    raw = read(path, "ros_odometry")
    assert np.allclose(raw.channels["u"].values, 0.01 * np.arange(300)) and np.allclose(raw.channels["n:T1"].values, 0.1 * np.arange(300))
    assert not raw.findings
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    cut = read(path, "ros_odometry")
    n = len(cut.channels["u"].t)
    assert 30 < n < 300 and np.allclose(cut.channels["u"].values, 0.01 * np.arange(n)) and cut.findings[0].code == "cut_file"


def test_a_custom_type_of_ros_1_is_read_by_its_definition_in_the_bag(tmp_path):
    """A vehicle's own message, as python3-rosbag writes it: speeds as an array behind a header."""
    if subprocess.run([SYSTEM_PYTHON, "-c", "import rosbag, genpy"], capture_output=True, check=False).returncode:
        pytest.skip("python3-rosbag is not installed")
    bag, profile = tmp_path / "own.bag", tmp_path / "own.toml"
    tool(SYSTEM_PYTHON, "-c", CUSTOM, str(bag))
    profile.write_text(CUSTOM_PROFILE, encoding="utf-8")
    raw = read(bag, str(profile))
    assert np.allclose(raw.channels["n:HP"].values, 0.1 * np.arange(300)) and np.allclose(raw.channels["n:VS"].values, -0.2 * np.arange(300))
    assert raw.channels["n:HP"].stamp == "header" and raw.t0_ns == 1_700_000_000 * 10**9 and not raw.findings


def test_rosbag_and_evo_read_what_is_exported(tmp_path):
    run = open_run(write_dive(tmp_path), "merlin")
    (bag,), (trajectory,) = write(run, "bag", tmp_path / "a.bag"), write(run, "tum", tmp_path / "a.tum")
    assert "/odom" in tool("rosbag", "info", str(bag)) and tool("rosbag", "check", str(bag))
    assert f"{len(run)} poses" in tool("evo_traj", "tum", str(trajectory))
    assert f"{len(run)} poses" in tool("evo_traj", "bag", str(bag), "/odom")
