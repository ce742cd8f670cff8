"""What an ArduSub log says of its own motors: which frame the vehicle has, and which motors turn against it.

The firmware multiplies each motor's demand by MOT_n_DIRECTION before it becomes a pulse width about 1500 us (ArduPilot,
libraries/AP_Motors/AP_Motors6DOF.cpp), so that thrusters and propellers may be mounted either way round. The pulse width that pushes the way
the frame's table says is therefore 1500 + MOT_n_DIRECTION (pulse width - 1500).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from rovval.core.errors import Finding
from rovval.ingest.profile import ARDUSUB_FRAMES, Profile

if TYPE_CHECKING:
    from rovval.ingest.assembly import Signal

NEUTRAL_US = 1500.0  # us, in the firmware


def other_frame(profile: Profile, parameters: Mapping[str, float]) -> str:
    """What is wrong with the frame of a log for this profile, "" where it is the profile's or not logged."""
    code = parameters.get("FRAME_CONFIG")
    if profile.ardusub_frame is None or code is None or int(code) == ARDUSUB_FRAMES[profile.ardusub_frame]:
        return ""
    name = next((n for n, c in ARDUSUB_FRAMES.items() if c == int(code)), "of another number of motors")
    return f"FRAME_CONFIG = {ARDUSUB_FRAMES[profile.ardusub_frame]} ({profile.ardusub_frame}); the log's vehicle has {int(code)} ({name})"


def turned(profile: Profile, signals: Mapping[str, Signal], parameters: Mapping[str, float]) -> tuple[dict[str, Signal], list[Finding]]:
    """Pulse widths as the frame's table has them, motors of MOT_n_DIRECTION = -1 turned about neutral; and which these are."""
    out, backwards, unknown = dict(signals), [], []
    if profile.ardusub_frame is None:
        return out, []
    for name, signal in signals.items():
        motor = re.search(r"(\d+)(?:_raw)?$", str(signal.source.field)) if name.startswith("pwm:") else None
        if motor is None:
            continue
        direction = parameters.get(f"MOT_{motor.group(1)}_DIRECTION")
        if direction is None:
            unknown.append(name)
        elif direction < 0:
            missing = np.isin(signal.values, signal.source.missing)
            out[name] = replace(signal, values=np.where(missing, signal.values, 2.0 * NEUTRAL_US - signal.values))
            backwards.append(name)
    found = []
    if backwards:
        found.append(Finding("motor_direction", ", ".join(backwards), f"MOT_n_DIRECTION is -1: pulse widths turned about {NEUTRAL_US:g} us"))
    if unknown:
        detail = "the log does not hold MOT_n_DIRECTION: taken as 1, the firmware's default; a motor that is mounted the other way round pushes the wrong way"
        found.append(Finding("motor_direction", ", ".join(unknown), detail))
    return out, found
