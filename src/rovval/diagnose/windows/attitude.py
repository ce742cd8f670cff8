"""Attitude of a run that tumbles: its residuals are rotation vectors, since Euler angles jump where the pitch passes 90 degrees.

Roll and pitch stand for the tilt, the direction of the vertical in the vehicle; the heading is left out, unless its own channel is compared. While a run
stays in the range of Euler angles their differences are the same to first order, and are taken as they are.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.core.data import Array, Run
from rovval.core.frames import attitude_difference, rotation_from_euler, tilt_difference, tumbles, turned

ANGLES = ("phi", "theta", "psi")


def tumbling(run: Run) -> bool:
    """Whether a run leaves the range of Euler angles."""
    return run.measured("theta") and tumbles(run.get("theta"))


def measured_attitude(run: Run) -> Array:
    """Euler angles (n, 3) of a run; where they are missing 0, which nothing is compared with."""
    return np.asarray(np.nan_to_num(run.stack(ANGLES)))


def attitude_error(simulated: Array, measured: Array, channels: Sequence[str]) -> Array:
    """The turn (..., 3) from the ``measured`` to the ``simulated`` attitude, Euler angles (..., 3), in body axes, rad; without the heading's where it is
    none of the ``channels``."""
    return attitude_difference(simulated, measured) if "psi" in channels else tilt_difference(simulated, measured)


def turned_through(run: Run, channels: Sequence[str]) -> Array:
    """Sum (n, 3) of the turns from sample to sample in body axes, rad: a series without jumps that is as noisy as the attitude. NaN where that is missing."""
    euler = measured_attitude(run)
    known = np.isfinite(run.stack(tuple(c for c in ANGLES if run.measured(c)))).all(axis=1)
    at = np.flatnonzero(known)
    found = np.full((len(run), 3), np.nan)
    if len(at):
        turns = attitude_error(euler[at[1:]], euler[at[:-1]], channels)
        found[at] = np.concatenate([np.zeros((1, 3)), np.cumsum(turns, axis=0)])
    return found


def tilted(eta: Array, phi: float, theta: float) -> Array:
    """Poses (m, 6) tilted by ``phi`` and ``theta`` (rad) about two axes of the body that are level, whichever these are."""
    down = rotation_from_euler(eta[:, 3:])[:, 2]
    least = np.eye(3)[np.abs(down).argmin(axis=1)]
    across = np.cross(down, least)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    return np.concatenate([eta[:, :3], turned(eta[:, 3:], phi * across + theta * np.cross(down, across))], axis=1)
