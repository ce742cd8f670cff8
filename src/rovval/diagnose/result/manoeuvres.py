"""The manoeuvres that could be flown next: thruster schedules that a pilot or a script can fly.

They follow the movement protocol of the thesis (4.4) and add coast-downs, turns through every heading, single thrusters, weak steps and
quick reversals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.vehicle.model import Vehicle, allocation


@dataclass(frozen=True, slots=True)
class Leg:
    """A part of a manoeuvre: how many seconds, and the speed of each thruster in rev/s."""

    seconds: float
    speed: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Manoeuvre:
    """A schedule of thruster speeds, in words as well."""

    name: str
    text: str
    legs: tuple[Leg, ...]


@dataclass(frozen=True, slots=True)
class Helm:
    """Turns a push on an axis into thruster speeds.

    Attributes:
        vehicle: with k thrusters.
        most_speed: (k,) the largest speeds in rev/s that the thrusters may be asked for.
    """

    vehicle: Vehicle
    most_speed: Array

    @property
    def rest(self) -> tuple[float, ...]:
        """All thrusters off."""
        return (0.0,) * len(self.most_speed)

    def push(self, axis: str, share: float, other: str = "", other_share: float = 0.0) -> tuple[float, ...]:
        """Thruster speeds (k,) in rev/s that push on ``axis``, and on ``other``, with signed shares of the largest thrust."""
        wrench = np.zeros(6)
        wrench[AXES.index(axis)] = share
        if other:
            wrench[AXES.index(other)] = other_share
        return self._speeds(wrench, max(abs(share), abs(other_share)))

    def single(self, thruster: int, share: float) -> tuple[float, ...]:
        """One thruster at a signed share of its largest speed, the others off."""
        speed = float(share * self.most_speed[thruster])
        return tuple(speed if i == thruster else 0.0 for i in range(len(self.most_speed)))

    def _speeds(self, wrench: Array, share: float) -> tuple[float, ...]:
        """Speeds whose thrust points along ``wrench``, that of the busiest thruster ``share`` of its largest; moments count by the thrusters' reach."""
        fitted = self.vehicle.thruster
        scale = np.array([1.0, 1.0, 1.0, *np.maximum(np.ptp([t.position for t in fitted], axis=0), 0.1)])
        thrust = np.linalg.pinv(allocation(self.vehicle)) @ (wrench * scale)
        gain = np.where(thrust >= 0, [t.k_pos for t in fitted], [t.k_neg for t in fitted]) * 3600.0
        speed = np.sign(thrust) * np.sqrt(np.abs(thrust) / gain)
        limit = np.max(np.abs(speed) / np.maximum(self.most_speed, 1e-9))
        return tuple((speed * np.sqrt(share) / limit).tolist()) if limit > 0 else self.rest


def bank(helm: Helm) -> tuple[Manoeuvre, ...]:
    """The manoeuvres that are compared."""
    steps = [_steps(helm, axis) for axis in ("surge", "sway", "heave", "yaw")]
    return (*steps, *(_forth_and_back(helm, axis) for axis in ("surge", "sway", "heave")), *_others(helm))


def _legs(*parts: tuple[float, tuple[float, ...]]) -> tuple[Leg, ...]:
    return tuple(Leg(seconds, speed) for seconds, speed in parts)


def _steps(helm: Helm, axis: str) -> Manoeuvre:
    return Manoeuvre(
        f"{axis} steps at three strengths with coast-downs",
        f"push in {axis} at 40, 70 and 100 % for 20 s each, thrusters off for 10 s after each",
        _legs(*(leg for share in (0.4, 0.7, 1.0) for leg in ((20.0, helm.push(axis, share)), (10.0, helm.rest)))),
    )


def _forth_and_back(helm: Helm, axis: str) -> Manoeuvre:
    return Manoeuvre(
        f"{axis} forth and back",
        f"push in {axis} at 80 % for 20 s each way with 10 s off between, twice",
        _legs(*(leg for share in (0.8, -0.8) * 2 for leg in ((20.0, helm.push(axis, share)), (10.0, helm.rest)))),
    )


def _others(helm: Helm) -> tuple[Manoeuvre, ...]:
    push, rest, thrusters = helm.push, helm.rest, range(len(helm.most_speed))
    diagonals = ((0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8))
    return (
        Manoeuvre("full circle at speed", "surge at 80 % while turning at 40 %, 100 s, through every heading",
                  _legs((100.0, push("surge", 0.8, "yaw", 0.4)))),
        Manoeuvre("oblique runs", "surge and sway together at 80 %, 25 s in each of the four diagonals",
                  _legs(*((25.0, push("surge", a, "sway", b)) for a, b in diagonals))),
        Manoeuvre("weak steps", "push in surge, sway and heave at 10 and 20 % for 12 s each way",
                  _legs(*((12.0, push(axis, share)) for axis in ("surge", "sway", "heave") for share in (0.1, -0.1, 0.2, -0.2)))),
        Manoeuvre("quick reversals", "surge forth and back at 80 % with periods of 2, 4 and 8 s, 24 s each",
                  _legs(*((half, push("surge", sign * 0.8)) for half in (1.0, 2.0, 4.0) for _ in range(int(12 / half)) for sign in (1, -1)))),
        Manoeuvre("thrusters one by one", "each thruster alone at 80 % forward 8 s, off 4 s, backward 8 s, off 4 s",
                  _legs(*((s, helm.single(j, v)) for j in thrusters for s, v in ((8.0, 0.8), (4.0, 0.0), (8.0, -0.8), (4.0, 0.0))))),
        Manoeuvre("drift", "all thrusters off for 80 s", _legs((80.0, rest))),
    )  # fmt: skip
