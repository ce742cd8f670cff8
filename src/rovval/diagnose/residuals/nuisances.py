"""Nuisance parameters of a window: its initial state, slow drift of the attitude sensors and disturbances, with their standard deviations.

The initial state of every window is an unknown of the fit, known to within the noise of what was measured (multiple shooting: Bock 1981).
"""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import (
    ATTITUDE_DRIFT_SD,
    LEAST_ANGLE_START_SD,
    LEAST_START_SD,
    SLOPE_START_NOISE,
    SLOPE_START_SD,
    UNLOGGED_START_SD,
)
from rovval.diagnose.windows.noise import ANGLES
from rovval.diagnose.windows.windows import VELOCITY_CHANNELS, Windows

POSE_SLOPE = {"u": "x", "v": "y", "w": "z", "p": "phi", "q": "theta", "r": "psi"}

POSE_INDEX = {6: 3, 7: 4, 8: 2, 9: 5}  # start states after the six velocities: roll, pitch, depth, heading
STATE_STEP = (0.02, 0.02, 0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02)  # m/s, rad/s, rad, m: about twice the noise of good sensors


def initial_states(windows: Windows) -> list[tuple[int, float]]:
    """Initial states that are marginalised: six velocities, roll, pitch, and depth where it is a residual channel."""
    chosen = list(enumerate(STATE_STEP[:8]))
    if "z" in windows.channels:
        chosen.append((8, STATE_STEP[8]))
    if "psi" in windows.channels:
        chosen.append((9, STATE_STEP[7]))
    return chosen


def drifting_channels(windows: Windows) -> list[int]:
    """Channels whose sensor drifts slowly beside its white noise: roll and pitch of an AHRS."""
    return [i for i, c in enumerate(windows.channels) if c in ("phi", "theta")]


def nuisance_sd(windows: Windows) -> Array:
    """Standard error of each nuisance of a window (s,): start states and sensors' drift, then disturbances, whose answers are scaled to it."""
    pushed = 0 if windows.disturbance_response is None else windows.disturbance_response.shape[-1]
    return np.concatenate([initial_state_sd(windows), np.ones(pushed)])


def initial_state_sd(windows: Windows) -> Array:
    """Standard error of what a window's start adds (s,): start states (the channel's noise, or a stated value where it was not measured),
    then the attitude sensors' drift."""
    noise = dict(zip(windows.channels, windows.noise, strict=True))
    run = windows.run
    found = []
    for index, _ in initial_states(windows):
        name = (*VELOCITY_CHANNELS, "phi", "theta", "z", "psi")[index]
        if run.measured(name):
            least = LEAST_ANGLE_START_SD if name in ANGLES else LEAST_START_SD
            found.append(max(noise.get(name, 0.0), least))
        else:
            pose = POSE_SLOPE.get(name, "")
            found.append(max(SLOPE_START_NOISE * noise.get(pose, 0.0), SLOPE_START_SD) if run.measured(pose) else UNLOGGED_START_SD)
    return np.array([*found, *[ATTITUDE_DRIFT_SD] * len(drifting_channels(windows))])
