"""A run as messages of ROS: odometry, transforms, thruster speeds in rpm as the profile `ros_odometry` reads them, the rest in SI.

``/odom`` is measured, ``/simulated/odom`` the free run beside it, ``/simulated/windows/odom`` the one that restarts. A component that is missing is NaN.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array
from rovval.core.errors import BadInput
from rovval.export.content import Content, Motion

ODOMETRY, TRANSFORMS, NUMBER, RANGE = "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage", "std_msgs/msg/Float64", "sensor_msgs/msg/Range"
WORLD, BODY = "odom", "base_link"  # REP-105
SPEEDS = {"n": ("thrusters/{}/rpm", 60.0), "n_cmd": ("thrusters/{}/rpm_command", 60.0), "pwm": ("thrusters/{}/pulse_width_us", 1.0)}
Message = tuple[str, str, int, Any]  # topic, type, stamp (ns), message


def messages(content: Content, types: Any, ros1: bool) -> Iterator[Message]:
    """Every message in the order of its stamp; ``types`` are those of a typestore of rosbags. Raises `BadInput` where there is none."""
    stamps, motions, columns = content.stamps_ns, content.motions(), _columns(content)
    known = {name: motion.known for name, motion in motions.items()}
    posed = {name: motion.posed for name, motion in motions.items()}
    if not any(k.any() for k in known.values()) and not columns:
        raise BadInput(f"run {content.run.id}: holds nothing to export", "see its findings with `rovval show run`")
    make = _Maker(types, ros1)
    for i, ns in enumerate(stamps.tolist()):
        for name, motion in motions.items():
            frame = f"{name}/{BODY}".lstrip("/")
            if known[name][i]:
                yield f"/{name}/odom".replace("//", "/"), ODOMETRY, ns, make.odometry(ns, frame, motion, i)
            if posed[name][i]:
                yield "/tf", TRANSFORMS, ns, make.transform(ns, frame, motion, i)
        for topic, column in columns.items():
            if np.isfinite(column[i]):
                kind = RANGE if topic == "/altitude" else NUMBER
                yield topic, kind, ns, make.range(ns, column[i]) if kind == RANGE else make.number(column[i])


def _columns(content: Content) -> dict[str, Array]:
    """What is neither pose nor velocity: topic -> values (n,)."""
    out: dict[str, Array] = {}
    for name, values in content.run.values.items():
        family, _, member = name.partition(":")
        if name in (*POSE, *VELOCITIES) or not content.run.measured(name):
            continue
        topic, factor = SPEEDS.get(family, (f"{family}/{{}}" if member else family, 1.0))
        out[f"/{topic.format(member)}"] = values * factor
    if content.sim is not None:
        for k, name in enumerate(content.sim.thrusters):
            out[f"/simulated/thrusters/{name}/rpm"] = content.sim.thruster_speed[:, k] * 60.0
            out[f"/simulated/thrusters/{name}/thrust"] = content.sim.thrust[:, k]
    return out


class _Maker:
    """Messages out of the types of one typestore."""

    def __init__(self, types: Any, ros1: bool) -> None:
        self.types, self.ros1, self.unknown = types, ros1, np.zeros(36)

    def _header(self, ns: int, frame: str) -> Any:
        stamp = self.types["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
        return self.types["std_msgs/msg/Header"](stamp=stamp, frame_id=frame, **({"seq": 0} if self.ros1 else {}))

    def _turn(self, motion: Motion, i: int) -> Any:
        w, x, y, z = motion.orientation[i].tolist()
        return self.types["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w)

    def odometry(self, ns: int, frame: str, motion: Motion, i: int) -> Any:
        g = self.types
        pose = g["geometry_msgs/msg/Pose"](position=g["geometry_msgs/msg/Point"](*motion.position[i].tolist()), orientation=self._turn(motion, i))
        vector = g["geometry_msgs/msg/Vector3"]
        twist = g["geometry_msgs/msg/Twist"](linear=vector(*motion.linear[i].tolist()), angular=vector(*motion.angular[i].tolist()))
        return g[ODOMETRY](
            header=self._header(ns, WORLD), child_frame_id=frame,
            pose=g["geometry_msgs/msg/PoseWithCovariance"](pose=pose, covariance=self.unknown),
            twist=g["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=self.unknown),
        )  # fmt: skip

    def transform(self, ns: int, frame: str, motion: Motion, i: int) -> Any:
        g = self.types
        way = g["geometry_msgs/msg/Transform"](translation=g["geometry_msgs/msg/Vector3"](*motion.position[i].tolist()), rotation=self._turn(motion, i))
        one = g["geometry_msgs/msg/TransformStamped"](header=self._header(ns, WORLD), child_frame_id=frame, transform=way)
        return g[TRANSFORMS](transforms=[one])

    def number(self, value: float) -> Any:
        return self.types[NUMBER](data=float(value))

    def range(self, ns: int, value: float) -> Any:
        ultrasound = 0
        return self.types[RANGE](
            header=self._header(ns, BODY), radiation_type=ultrasound, field_of_view=float("nan"), min_range=0.0, max_range=float("inf"), range=float(value)
        )
