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


def bank(vehicle: Vehicle, most_speed: Array) -> tuple[Manoeuvre, ...]:
    """The manoeuvres of a vehicle with k thrusters, scaled to ``most_speed`` (k,), the largest speeds in rev/s that the log used."""
    k = len(most_speed)
    rest = tuple([0.0] * k)

    def push(axis: str, share: float, other: str = "", other_share: float = 0.0) -> tuple[float, ...]:
        wrench = np.zeros(6)
        wrench[AXES.index(axis)] = share
        if other:
            wrench[AXES.index(other)] = other_share
        return _speeds(vehicle, wrench, most_speed, max(abs(share), abs(other_share)))

    def legs(*parts: tuple[float, tuple[float, ...]]) -> tuple[Leg, ...]:
        return tuple(Leg(seconds, speed) for seconds, speed in parts)

    found = [
        Manoeuvre(
            f"{axis} steps at three strengths with coast-downs",
            f"push in {axis} at 40, 70 and 100 % for 20 s each, thrusters off for 10 s after each",
            legs(*((s, v) for share in (0.4, 0.7, 1.0) for s, v in ((20.0, push(axis, share)), (10.0, rest)))),
        )
        for axis in ("surge", "sway", "heave", "yaw")
    ]
    found += [
        Manoeuvre(
            f"{axis} forth and back",
            f"push in {axis} at 80 % for 20 s each way with 10 s off between, twice",
            legs(*((s, v) for share in (0.8, -0.8) * 2 for s, v in ((20.0, push(axis, share)), (10.0, rest)))),
        )
        for axis in ("surge", "sway", "heave")
    ]
    found += [
        Manoeuvre("full circle at speed", "surge at 80 % while turning at 40 %, 100 s, through every heading", legs((100.0, push("surge", 0.8, "yaw", 0.4)))),
        Manoeuvre("oblique runs", "surge and sway together at 80 %, 25 s in each of the four diagonals",
                  legs(*((25.0, push("surge", a, "sway", b)) for a, b in ((0.8, 0.8), (0.8, -0.8), (-0.8, 0.8), (-0.8, -0.8))))),
        Manoeuvre("weak steps", "push in surge, sway and heave at 10 and 20 % for 12 s each way",
                  legs(*((12.0, push(axis, share)) for axis in ("surge", "sway", "heave") for share in (0.1, -0.1, 0.2, -0.2)))),
        Manoeuvre("quick reversals", "surge forth and back at 80 % with periods of 2, 4 and 8 s, 24 s each",
                  legs(*((half, push("surge", sign * 0.8)) for half in (1.0, 2.0, 4.0) for _ in range(int(12 / half)) for sign in (1, -1)))),
        Manoeuvre("thrusters one by one", "each thruster alone at 80 % forward 8 s, off 4 s, backward 8 s, off 4 s",
                  legs(*((s, _alone(k, j, v * most_speed[j])) for j in range(k) for s, v in ((8.0, 0.8), (4.0, 0.0), (8.0, -0.8), (4.0, 0.0))))),
        Manoeuvre("drift", "all thrusters off for 80 s", legs((80.0, rest))),
    ]  # fmt: skip
    return tuple(found)


def _alone(k: int, j: int, speed: float) -> tuple[float, ...]:
    return tuple(float(speed) if i == j else 0.0 for i in range(k))


def _speeds(vehicle: Vehicle, wrench: Array, most_speed: Array, share: float) -> tuple[float, ...]:
    """Thruster speeds whose thrust points along ``wrench``, the busiest thruster at ``share`` of its largest thrust in the log."""
    scale = np.array([1.0, 1.0, 1.0, *np.maximum(np.ptp([t.position for t in vehicle.thruster], axis=0), 0.1)])
    thrust = np.linalg.pinv(allocation(vehicle)) @ (wrench * scale)
    gain = np.where(thrust >= 0, [t.k_pos for t in vehicle.thruster], [t.k_neg for t in vehicle.thruster]) * 3600.0
    speed = np.sign(thrust) * np.sqrt(np.abs(thrust) / gain)
    limit = np.max(np.abs(speed) / np.maximum(most_speed, 1e-9))
    return tuple((speed * np.sqrt(share) / limit).tolist()) if limit > 0 else tuple([0.0] * len(speed))
