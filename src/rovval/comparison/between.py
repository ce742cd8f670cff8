"""Simulator against simulator: B minus A of two motions of the same samples, neither of which is the truth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES, POSE, VELOCITIES, channel
from rovval.core.data import Array, Run, SimResult, frozen_array
from rovval.core.errors import BadInput
from rovval.core.frames import wrap

RESOLUTION = 1e-4  # of the fastest motion of its kind: how well the integration agrees with an independent one (tests/plant/test_physics.py)


@dataclass(frozen=True, slots=True)
class Track:
    """A motion by its ``name``: body velocity ``nu`` (n, 6) m/s and rad/s, pose ``eta`` (n, 6) m and rad, NaN where there is none; ``dt`` s."""

    name: str
    dt: float
    nu: Array
    eta: Array

    def __post_init__(self) -> None:
        for name in ("nu", "eta"):
            object.__setattr__(self, name, frozen_array(getattr(self, name)))


@dataclass(frozen=True, slots=True)
class ChannelDifference:
    """B minus A of one channel over its ``n`` common samples, in its ``unit``: ``mean``, ``iae`` (integral of the absolute difference, unit x s),
    ``rms`` and ``largest`` (the one furthest from zero, signed). ``share``: the integral of |B - A| over that of |A|; None for a pose, and where A
    stands still. ``tie``: no difference is larger than `RESOLUTION` of the fastest motion of its kind in A or B."""

    channel: str
    unit: str
    n: int
    mean: float
    iae: float
    rms: float
    largest: float
    share: float | None
    tie: bool


@dataclass(frozen=True, slots=True)
class Difference:
    """Two motions, the differences of the six velocities by axis and of the pose by channel. ``tie``: every channel is one."""

    a: Track
    b: Track
    velocities: Mapping[str, ChannelDifference]
    pose: Mapping[str, ChannelDifference]

    @property
    def tie(self) -> bool:
        """Whether nothing differs beyond the integration's resolution."""
        return all(row.tie for row in (*self.velocities.values(), *self.pose.values()))


def of_simulation(sim: SimResult, name: str) -> Track:
    """The free run of a simulation."""
    return Track(name, sim.dt, sim.free.nu, sim.free.eta)


def of_run(run: Run, name: str) -> Track:
    """What a run holds of velocity and pose: a log's measurements, or the motion of a mission that was flown."""
    return Track(name, run.dt, run.stack(VELOCITIES), run.stack(POSE))


def between(a: Track, b: Track) -> Difference:
    """B minus A, sample by sample.

    Raises:
        BadInput: not the same samples, or no channel that both have.
    """
    if a.nu.shape != b.nu.shape or abs(a.dt - b.dt) > 1e-9:
        raise BadInput(
            f"{a.name} has {len(a.nu)} samples of {a.dt:g} s, {b.name} {len(b.nu)} of {b.dt:g} s: not of one run", "give two motions of the same samples"
        )
    velocities = {axis: row for j, axis in enumerate(AXES) if (row := _row(VELOCITIES[j], a.nu, b.nu, j, a.dt))}
    pose = {name: row for j, name in enumerate(POSE) if (row := _row(name, a.eta, b.eta, j, a.dt))}
    if not velocities and not pose:
        raise BadInput(f"{a.name} and {b.name}: no channel has a sample in both", "give two motions of the same run")
    return Difference(a, b, velocities, pose)


def _row(name: str, a: Array, b: Array, j: int, dt: float) -> ChannelDifference | None:
    """One channel, or None where the two have no sample in common."""
    kind = slice(0, 3) if j < 3 else slice(3, 6)
    both = np.isfinite(a[:, j]) & np.isfinite(b[:, j])
    if not both.any():
        return None
    d, unit = b[both, j] - a[both, j], channel(name).unit
    d = wrap(d) if unit == "rad" else d
    speed = name in VELOCITIES
    known = np.isfinite(a[:, kind]).all(axis=1) & np.isfinite(b[:, kind]).all(axis=1) & both
    reach = _reach(np.concatenate([a[known, kind], b[known, kind]]), speed) if known.any() else 0.0
    own = float(np.abs(a[both, j]).mean())
    return ChannelDifference(
        channel=name, unit=unit, n=len(d), mean=float(d.mean()), iae=float(np.abs(d).sum() * dt), rms=float(np.sqrt(np.mean(d**2))),
        largest=float(d[np.argmax(np.abs(d))]), share=float(np.abs(d).mean() / own) if speed and own > RESOLUTION * reach else None,
        tie=bool(np.abs(d).max() <= RESOLUTION * reach),
    )  # fmt: skip


def _reach(values: Array, speed: bool) -> float:
    """The fastest velocity of a kind, or how far a pose of a kind goes."""
    return float(np.abs(values).max()) if speed else float(np.ptp(values, axis=0).max())
