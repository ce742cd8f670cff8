"""What is exported: stamps, and motions in the axes of the robotics world (REP-103)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array, Run, SimResult
from rovval.core.frames import ENU_TO_NED, FLU_TO_FSD, quaternion_from_euler

WITHOUT_EPOCH_NS = 10**9  # a log that does not know when it was begins at one second: a stamp of zero is none in ROS


@dataclass(frozen=True, slots=True)
class Motion:
    """``position`` (n, 3) m east, north and up of the first sample; ``orientation`` (n, 4) w x y z from forward-left-up into that world;
    ``linear`` (n, 3) m/s and ``angular`` (n, 3) rad/s along forward, left and up. NaN where missing."""

    position: Array
    orientation: Array
    linear: Array
    angular: Array

    @property
    def posed(self) -> NDArray[np.bool_]:
        """Where the pose is whole (n,)."""
        return np.asarray(np.isfinite(self.position).all(axis=1) & np.isfinite(self.orientation).all(axis=1))

    @property
    def known(self) -> NDArray[np.bool_]:
        """Where anything of it is known (n,)."""
        parts = (self.position, self.orientation, self.linear, self.angular)
        return np.asarray(np.any([np.isfinite(part).any(axis=1) for part in parts], axis=0))


@dataclass(frozen=True, slots=True)
class Content:
    """A run and, where asked for, a simulation of it."""

    run: Run
    sim: SimResult | None

    @property
    def stamps_ns(self) -> NDArray[np.int64]:
        """Of each sample, since 1970 UTC where the log knows it (n,)."""
        start = WITHOUT_EPOCH_NS if self.run.t0_ns is None else self.run.t0_ns
        return np.asarray(start + np.rint(self.run.t * 1e9).astype(np.int64))

    def motions(self) -> Mapping[str, Motion]:
        """The measured motion as "", and of a simulation the free run as "simulated" and the one restarted in windows as "simulated/windows"."""
        found = {"": _turned(self.run.stack(POSE), self.run.stack(VELOCITIES))}
        if self.sim is not None:
            for name, trajectory in (("simulated", self.sim.free), ("simulated/windows", self.sim.windowed)):
                found[name] = _turned(trajectory.eta, trajectory.nu)
        return found


def _turned(eta: Array, nu: Array) -> Motion:
    euler = np.stack([eta[:, 3], -eta[:, 4], np.pi / 2 - eta[:, 5]], axis=1)
    return Motion(eta[:, :3] @ ENU_TO_NED.T, quaternion_from_euler(euler), nu[:, :3] @ FLU_TO_FSD.T, nu[:, 3:] @ FLU_TO_FSD.T)
