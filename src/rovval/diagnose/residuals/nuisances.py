"""TODO The lanes of a linearisation: which simulations, of every window, its derivatives are taken from."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.windows.noise import ANGLES
from rovval.diagnose.windows.windows import VELOCITY_CHANNELS, Windows

UNLOGGED = 0.3  # m/s, rad/s, rad: start of what was neither logged nor follows from the pose: anything slow is possible (chosen)
FROM_SLOPE = 0.01  # m/s, rad/s: least error of a start taken as the slope of the logged pose over a second (chosen)
POSE_SLOPE = {"u": "x", "v": "y", "w": "z", "p": "phi", "q": "theta", "r": "psi"}
ATTITUDE_DRIFT = 0.004  # rad: slow error of an AHRS within a window, 0.2 degrees (MTi class data sheets)

POSE_INDEX = {6: 3, 7: 4, 8: 2, 9: 5}  # start states after the six velocities: roll, pitch, depth, heading
STATE_STEP = (0.02, 0.02, 0.02, 0.01, 0.01, 0.01, 0.01, 0.01, 0.02)  # m/s, rad/s, rad, m: about twice the noise of good sensors


def initial_states(stretches: Windows) -> list[tuple[int, float]]:
    """Initial states that are marginalised: six velocities, roll, pitch, and depth where it is a residual channel."""
    chosen = list(enumerate(STATE_STEP[:8]))
    if "z" in stretches.channels:
        chosen.append((8, STATE_STEP[8]))
    if "psi" in stretches.channels:
        chosen.append((9, STATE_STEP[7]))
    return chosen


def drifting_channels(stretches: Windows) -> list[int]:
    """Channels whose sensor drifts slowly beside its white noise: roll and pitch of an AHRS."""
    return [i for i, c in enumerate(stretches.channels) if c in ("phi", "theta")]


def nuisance_sd(stretches: Windows) -> Array:
    """Standard error of each nuisance of a window (s,): start states and sensors' drift, then disturbances, whose answers are scaled to it."""
    pushed = 0 if stretches.disturbance_response is None else stretches.disturbance_response.shape[-1]
    return np.concatenate([initial_state_sd(stretches), np.ones(pushed)])


def initial_state_sd(stretches: Windows) -> Array:
    """Standard error of what a window's start adds (s,): start states (the channel's noise, or a stated value where it was not measured),
    then the attitude sensors' drift."""
    noise = dict(zip(stretches.channels, stretches.noise, strict=True))
    run = stretches.run
    found = []
    for index, _ in initial_states(stretches):
        name = (*VELOCITY_CHANNELS, "phi", "theta", "z", "psi")[index]
        if run.measured(name):
            least = 0.01 if name in ANGLES else 0.005
            found.append(max(noise.get(name, 0.0), least))
        else:
            pose = POSE_SLOPE.get(name, "")
            found.append(max(3.0 * noise.get(pose, 0.0), FROM_SLOPE) if run.measured(pose) else UNLOGGED)
    return np.array([*found, *[ATTITUDE_DRIFT] * len(drifting_channels(stretches))])
