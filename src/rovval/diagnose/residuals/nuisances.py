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
from rovval.diagnose.windows.attitude import ANGLES
from rovval.diagnose.windows.windows import VELOCITY_CHANNELS, Windows

POSE_OF_RATE = {"u": "x", "v": "y", "w": "z", "p": "phi", "q": "theta", "r": "psi"}  # the pose whose slope gives a velocity that was not logged

POSE_INDEX = {6: 3, 7: 4, 8: 2, 9: 5}  # component of the pose of the initial states after the six velocities: roll, pitch, depth, heading
STATE_STEP = (0.02, 0.02, 0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02)  # m/s, rad/s, rad, m: about twice the noise of good sensors


def initial_states(windows: Windows) -> list[tuple[int, float]]:
    """Initial states that are nuisances, each with its finite difference (m/s, rad/s, rad or m): six velocities, roll, pitch; depth and heading where they are
    residual channels."""
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
    """Prior standard deviation of each nuisance of a window (s,): initial states, attitude drift, then disturbances, which are in units of it."""
    disturbances = 0 if windows.disturbance_response is None else windows.disturbance_response.shape[-1]
    return np.concatenate([initial_state_sd(windows), np.ones(disturbances)])


def initial_state_sd(windows: Windows) -> Array:
    """Prior standard deviation of a window's initial states and of the attitude sensors' drift (s,), in m/s, rad/s, rad and m: the noise of the channel, or a
    stated value where it was not measured."""
    noise = dict(zip(windows.channels, windows.noise, strict=True))
    run = windows.run
    found = []
    for index, _ in initial_states(windows):
        name = (*VELOCITY_CHANNELS, "phi", "theta", "z", "psi")[index]
        if run.measured(name):
            least = LEAST_ANGLE_START_SD if name in ANGLES else LEAST_START_SD
            found.append(max(noise.get(name, 0.0), least))
        else:
            pose = POSE_OF_RATE.get(name, "")
            found.append(max(SLOPE_START_NOISE * noise.get(pose, 0.0), SLOPE_START_SD) if run.measured(pose) else UNLOGGED_START_SD)
    return np.array([*found, *[ATTITUDE_DRIFT_SD] * len(drifting_channels(windows))])
