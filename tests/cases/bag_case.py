"""One motion as a bag of every kind, written by rosbags."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Bag2
from rosbags.typesys import Stores, get_typestore

from rovval.core.frames import quaternion_from_euler

START_NS = 1_700_000_000_000_000_000
N = 200


def motion() -> tuple[Any, ...]:
    """Truth in forward-left-up and east-north-up: turning left (counter-clockwise) while climbing."""
    t = np.arange(N) * 0.1
    return t, 0.2 * t, np.stack([1.0 + 0.1 * t, 2.0 + 0.0 * t, -5.0 + 0.05 * t], axis=1), np.array([0.5, 0.1, 0.05]), np.array([0.0, 0.0, 0.2])


def messages(store: Any, ros1: bool) -> Iterator[tuple[str, str, int, Any]]:
    """Topic, type, stamp of the record (ns) and message, 30 ms after the header's."""
    T = store.types
    _t, yaw, position, velocity, rate = motion()
    zero = np.zeros(36)
    for i in range(N):
        ns = START_NS + i * 100_000_000
        stamp = T["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
        more = {"seq": i} if ros1 else {}
        header = T["std_msgs/msg/Header"](stamp=stamp, frame_id="odom", **more)
        w, x, y, z = quaternion_from_euler(np.array([0.1, -0.2, yaw[i]]))
        point = T["geometry_msgs/msg/Point"](*position[i])
        pose = T["geometry_msgs/msg/Pose"](position=point, orientation=T["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w))
        vector = T["geometry_msgs/msg/Vector3"]
        twist = T["geometry_msgs/msg/Twist"](linear=vector(*velocity), angular=vector(*rate))
        odom = T["nav_msgs/msg/Odometry"](
            header=header, child_frame_id="base_link", pose=T["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=zero),
            twist=T["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=zero),
        )  # fmt: skip
        yield "/odom", "nav_msgs/msg/Odometry", ns + 30_000_000, odom
        for name, speed in (("T1", 600.0), ("T2", -60.0 * i)):
            yield f"/thrusters/{name}/rpm", "std_msgs/msg/Float64", ns, T["std_msgs/msg/Float64"](data=speed)


def write(kind: str, path: Path, chunk: int | None = None, prepare: Any = None) -> Path:
    """That motion as ``bag``, ``db3`` or ``mcap``: a chunk of a bag holds some ``chunk`` bytes; ``prepare`` is called with the writer."""
    store = get_typestore(Stores.ROS1_NOETIC if kind == "bag" else Stores.ROS2_HUMBLE)
    plugin = StoragePlugin.MCAP if kind == "mcap" else StoragePlugin.SQLITE3
    writer: Any = Bag1(path) if kind == "bag" else Bag2(path, version=9, storage_plugin=plugin)
    if chunk is not None:
        writer.chunk_threshold = chunk
    if prepare is not None:
        prepare(writer)
    with writer as bag:
        connections: dict[str, Any] = {}
        for topic, kind_, ns, message in messages(store, kind == "bag"):
            if topic not in connections:
                connections[topic] = bag.add_connection(topic, kind_, typestore=store)
            raw = store.serialize_ros1(message, kind_) if kind == "bag" else store.serialize_cdr(message, kind_)
            bag.write(connections[topic], ns, raw)
    return path
