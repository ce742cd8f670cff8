"""Reading logs beside the libraries, in one run: time and memory ratios.   pytest -m benchmark -s tests/benchmarks/bench_ingest.py

Each reading is a process of its own, so that its CPU time and the most memory that it held are its own; both count the start of Python.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from merlin_case import columns
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_typestore

pytestmark = pytest.mark.benchmark

CSV_ROWS = 300_000  # some 90 MB; the file of 1.07 GB of the changelog has 3 600 000
HOUR_S, RATE_HZ = 3600, 50
TIMES_POLARS, TIMES_ANYREADER, HOUR_CPU_S = 3.0, 2.0, 3.0  # what the readers are held to
MEASURED = """import re, time
{}
held = re.search(r"VmHWM:\\s+(\\d+) kB", open("/proc/self/status").read())
print(time.process_time(), int(held[1]) / 1e3)"""
OURS = "from rovval.ingest import read; read({!r}, {!r})"
POLARS = "import polars; polars.read_csv({!r}).write_csv({!r})"
ANYREADER = """from pathlib import Path
from rosbags.highlevel import AnyReader
with AnyReader([Path({!r})]) as reader:
    for connection, _, raw in reader.messages():
        reader.deserialize(raw, connection.msgtype)"""


def cost(code: str) -> tuple[float, float]:
    """CPU time (s) and most memory (MB) of a process."""
    done = subprocess.run([sys.executable, "-c", MEASURED.format(code)], capture_output=True, text=True, check=True)
    seconds, megabytes = done.stdout.split()
    return float(seconds), float(megabytes)


def test_csv_beside_polars(tmp_path):
    path = tmp_path / "big.csv"
    cells = columns(CSV_ROWS // 3, 0.0)
    rest = [",".join(row) for row in zip(*list(cells.values())[4:], strict=True)]
    with path.open("w", encoding="utf-8") as file:
        file.write(",".join(cells) + "\n")
        for k in range(CSV_ROWS):
            ms = k * 10
            file.write(f"{ms // 3_600_000},{ms // 60_000 % 60},{ms // 1000 % 60},{ms % 1000},{rest[k % len(rest)]}\n")
    size = path.stat().st_size / 1e6
    theirs, ours = cost(POLARS.format(str(path), str(tmp_path / "out.csv"))), cost(OURS.format(str(path), "merlin"))
    print(f"\nCSV of {size:.0f} MB: rovval {ours[0]:.2f} s, {ours[1]:.0f} MB; polars read and write {theirs[0]:.2f} s, {theirs[1]:.0f} MB")
    print(f"  {ours[0] / theirs[0]:.2f} times the CPU time (at most {TIMES_POLARS:g}), {ours[1] / size:.1f} times the file's size in memory")
    assert ours[0] < TIMES_POLARS * theirs[0]


def hour(kind: str, path: Path) -> Path:
    """An hour of seven thrusters, odometry and IMU at 50 Hz: one message of each type, its stamp or speed set anew."""
    ros1 = kind == "bag"
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    T, serialize = store.types, store.serialize_ros1 if ros1 else store.serialize_cdr
    stamp = T["builtin_interfaces/msg/Time"](sec=7, nanosec=9)
    header = T["std_msgs/msg/Header"](stamp=stamp, frame_id="odom", **({"seq": 1} if ros1 else {}))
    point, turn = T["geometry_msgs/msg/Point"](1.0, 2.0, 3.0), T["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0)
    vector = T["geometry_msgs/msg/Vector3"](0.1, 0.2, 0.3)
    pose = T["geometry_msgs/msg/PoseWithCovariance"](pose=T["geometry_msgs/msg/Pose"](position=point, orientation=turn), covariance=np.zeros(36))
    twist = T["geometry_msgs/msg/TwistWithCovariance"](twist=T["geometry_msgs/msg/Twist"](linear=vector, angular=vector), covariance=np.zeros(36))
    nine = np.zeros(9)
    odometry = T["nav_msgs/msg/Odometry"](header=header, child_frame_id="base_link", pose=pose, twist=twist)
    imu = T["sensor_msgs/msg/Imu"](
        header=header, orientation=turn, orientation_covariance=nine, angular_velocity=vector, angular_velocity_covariance=nine,
        linear_acceleration=vector, linear_acceleration_covariance=nine,
    )  # fmt: skip
    sent: dict[str, tuple[str, Any]] = {"/odom": ("nav_msgs/msg/Odometry", odometry), "/imu": ("sensor_msgs/msg/Imu", imu)}
    sent |= {f"/thrusters/T{i}/rpm": ("std_msgs/msg/Float64", T["std_msgs/msg/Float64"](data=600.0)) for i in range(1, 8)}
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    writer: Any = Bag1(path) if ros1 else Bag2(path, version=9, storage_plugin=plugin)
    with writer:
        raw = {topic: bytearray(serialize(message, name)) for topic, (name, message) in sent.items()}
        connections = {topic: writer.add_connection(topic, name, typestore=store) for topic, (name, _) in sent.items()}
        for k in range(HOUR_S * RATE_HZ):
            ns = 1_700_000_000_000_000_000 + k * 10**9 // RATE_HZ
            for topic, message in raw.items():
                if len(message) > 16:
                    message[4:12] = (ns // 10**9).to_bytes(4, "little") + (ns % 10**9).to_bytes(4, "little")
                writer.write(connections[topic], ns, bytes(message))
    return path


@pytest.mark.parametrize("kind", ["bag", "db3", "mcap"])
def test_an_hour_of_messages_beside_rosbags(kind, tmp_path):
    path = hour(kind, tmp_path / f"hour.{kind}" if kind == "bag" else tmp_path / "hour")
    theirs, ours = cost(ANYREADER.format(str(path))), cost(OURS.format(str(path), "ros_odometry"))
    print(f"\nan hour as {kind}: rovval {ours[0]:.2f} s, {ours[1]:.0f} MB; AnyReader and its messages {theirs[0]:.2f} s, {theirs[1]:.0f} MB")
    print(f"  {theirs[0] / ours[0]:.1f} times as fast (at least {TIMES_ANYREADER:g}), {ours[0]:.2f} s of CPU for the hour (at most {HOUR_CPU_S:g})")
    assert theirs[0] > TIMES_ANYREADER * ours[0] and ours[0] < HOUR_CPU_S
