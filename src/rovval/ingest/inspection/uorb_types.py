"""What PX4's message definitions say of their own fields (PX4-Autopilot, msg/*.msg: SI, body forward-right-down, world north-east-down)."""

from __future__ import annotations

# Message -> field -> channel and unit.
FIELDS: dict[str, dict[str, tuple[str, str]]] = {
    "vehicle_attitude": {"q": ("attitude", "quaternion")},
    "vehicle_angular_velocity": {f"xyz[{i}]": (c, "rad/s") for i, c in enumerate("pqr")},
    "vehicle_local_position": {**{a: (a, "m") for a in "xyz"}, **{f"v{a}": (c, "m/s") for a, c in zip("xyz", "uvw", strict=True)}},
    "distance_sensor": {"current_distance": ("altitude", "m")},
}
ALONG_WORLD = ("vehicle_local_position",)  # whose velocities are along north, east, down
ARRAYS = {"actuator_outputs": ("output", "pwm", "pwm_us")}  # message -> field, family and unit of its members, output after output
