"""ArduSub's published frames: how much of each stick every motor gets, as the firmware adds it to the motor's pulse width.

Source: ArduPilot, libraries/AP_Motors/AP_Motors6DOF.cpp, `setup_motors`, the calls of add_motor_raw_6dof. A motor's direction parameter
(MOT_n_DIRECTION) of -1 turns its pulse width about neutral; these are the factors before it, as for thrusters wired as the frame has them.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

COLUMNS = ("roll", "pitch", "yaw", "throttle", "forward", "lateral")  # throttle is positive up
_HORIZONTAL = ((0, 0, 1, 0, -1, 1), (0, 0, -1, 0, -1, -1), (0, 0, -1, 0, 1, 1), (0, 0, 1, 0, 1, -1))

FRAMES: Mapping[str, tuple[tuple[float, ...], ...]] = MappingProxyType(
    {
        "vectored": (*_HORIZONTAL, (1, 0, 0, -1, 0, 0), (-1, 0, 0, -1, 0, 0)),
        "vectored_6dof": (*_HORIZONTAL, (1, -1, 0, -1, 0, 0), (-1, -1, 0, -1, 0, 0), (1, 1, 0, -1, 0, 0), (-1, 1, 0, -1, 0, 0)),
    }
)


def factors(frame: str) -> dict[str, tuple[float, ...]]:
    """Factors of a frame as a vehicle's `Mixer` has them: stick -> one for each motor; heave is positive down, so minus throttle. A stick
    that drives no motor is left out. Raises KeyError for a frame that is not in `FRAMES`."""
    column = {name: tuple(float(row[i]) for row in FRAMES[frame]) for i, name in enumerate(COLUMNS)}
    sticks = {
        "surge": column["forward"],
        "sway": column["lateral"],
        "yaw": column["yaw"],
        "heave": tuple(-value for value in column["throttle"]),
        "roll": column["roll"],
        "pitch": column["pitch"],
    }
    return {name: row for name, row in sticks.items() if any(row)}
