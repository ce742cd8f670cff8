"""What the definitions of common ROS messages say of their own fields (REP-103: SI, forward-left-up, east-north-up)."""

from __future__ import annotations

_POSE = {"position.x": ("x", "m"), "position.y": ("y", "m"), "position.z": ("z", "m"), "orientation": ("attitude", "quaternion")}
_TWIST = {**{f"linear.{a}": (c, "m/s") for a, c in zip("xyz", "uvw", strict=True)}, **{f"angular.{a}": (c, "rad/s") for a, c in zip("xyz", "pqr", strict=True)}}


def _below(prefix: str, fields: dict[str, tuple[str, str]]) -> dict[str, tuple[str, str]]:
    return {f"{prefix}.{name}": meaning for name, meaning in fields.items()}


# Type -> field -> channel and unit, as the comments of the .msg files have them (common_interfaces; DVL: marine_acoustic_msgs, dvl_msgs).
FIELDS: dict[str, dict[str, tuple[str, str]]] = {
    "nav_msgs/Odometry": _below("pose.pose", _POSE) | _below("twist.twist", _TWIST),
    "geometry_msgs/PoseStamped": _below("pose", _POSE),
    "geometry_msgs/PoseWithCovarianceStamped": _below("pose.pose", _POSE),
    "geometry_msgs/Pose": _POSE,
    "geometry_msgs/Twist": _TWIST,
    "geometry_msgs/TwistStamped": _below("twist", _TWIST),
    "geometry_msgs/TwistWithCovarianceStamped": _below("twist.twist", _TWIST),
    "sensor_msgs/Imu": {"orientation": ("attitude", "quaternion"), **{f"angular_velocity.{a}": (c, "rad/s") for a, c in zip("xyz", "pqr", strict=True)}},
    "sensor_msgs/Range": {"range": ("altitude", "m")},
    "marine_acoustic_msgs/Dvl": {**{f"velocity.{a}": (c, "m/s") for a, c in zip("xyz", "uvw", strict=True)}, "altitude": ("altitude", "m")},
    "dvl_msgs/DVL": {**{f"velocity.{a}": (c, "m/s") for a, c in zip("xyz", "uvw", strict=True)}, "altitude": ("altitude", "m")},
}
ARRAYS = {"mavros_msgs/RCOut": ("channels", "pwm", "pwm_us")}  # type -> field, family and unit of its members, thruster after thruster


def meaning(kind: str) -> dict[str, tuple[str, str]]:
    """Field -> (channel, unit) of a message type by its ROS 1 or ROS 2 name; {} for one that is not listed."""
    return FIELDS.get(kind.replace("/msg/", "/"), {})
