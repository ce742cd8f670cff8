"""The vehicle's data sheet, and what is worked out from it: working speed, working force, limits."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rovval.blind.plant.spec import Array

CRUISE = ((1000.0, 0.7), (100.0, 0.6), (0.0, 0.5))  # kg and above: working speed in surge, m/s (chosen)
TURN_RAD_S = 0.4  # working rate of turn (chosen)
STATIC_KT = 0.35  # thrust coefficient at rest of open propellers of pitch ratio 0.8 (Wageningen B4-70): gives a diameter where the file has none
SPARE = 1.3  # speed limit of the shafts over the speed that the working force takes (chosen)


@dataclass(frozen=True)
class Sheet:
    """Nominal numbers of a vehicle, SI, forward-starboard-down about the origin; thrusters in the order of the file, gains in N/rpm^2."""

    name: str
    mass: float
    inertia: Array
    added: Array
    linear: Array
    quadratic: Array
    volume: float
    cg: Array
    cb: Array
    density: float
    gravity: float
    half_length: float
    units: tuple[str, ...]
    at: Array
    aim: Array
    ahead: Array
    astern: Array
    diameter: Array
    advance: Array  # (2, N, 3): K_T(J) / K_T(0) = 1 + a J + b J^2 + c J^3, ahead and astern

    def drag(self, axis: int, speed: float) -> float:
        """Drag that the file states for one axis at a speed (N or N m)."""
        return float(self.linear[axis] * speed + self.quadratic[axis] * speed * speed)

    @cached_property
    def cruise(self) -> float:
        """Working speed, m/s."""
        return next(speed for least, speed in CRUISE if self.mass >= least)

    @cached_property
    def force(self) -> float:
        """Working force: the drag in surge at working speed, N."""
        return self.drag(0, self.cruise)

    @cached_property
    def reach(self) -> Array:
        """(6, N): thrust of the units to wrench about the origin."""
        return np.vstack([self.aim.T, np.cross(self.at, self.aim).T])

    @cached_property
    def share(self) -> Array:
        """(N, 6): thrust of the units for a wrench, by damped least squares."""
        scale = np.array([1.0, 1.0, 1.0, *(3 * [1.0 / self.half_length])])
        a = self.reach * scale[:, None]
        return np.asarray(a.T @ np.linalg.inv(a @ a.T + 1e-4 * np.eye(6)) * scale)

    def speeds(self, thrust: Array) -> Array:
        """Shaft speeds (rpm) that give a thrust (N) at rest by the file's square law."""
        return np.asarray(np.sign(thrust) * np.sqrt(np.abs(thrust) / np.where(thrust >= 0.0, self.ahead, self.astern)))

    @cached_property
    def rpm(self) -> float:
        """Working shaft speed: the busiest unit's at the working force, ahead or astern."""
        return float(max(np.abs(self.speeds(sign * self.force * self.share[:, 0])).max() for sign in (1.0, -1.0)))

    @cached_property
    def rpm_limit(self) -> float:
        """Largest shaft speed that the pilots ask for."""
        return SPARE * self.rpm

    @cached_property
    def thrust(self) -> float:
        """A unit's mean thrust at working shaft speed, N."""
        return float(np.mean(self.ahead + self.astern) / 2.0 * self.rpm**2)

    @cached_property
    def ask(self) -> Array:
        """(6,): largest wrench that a pilot asks for on each axis by itself, N and N m."""
        weak = np.minimum(self.ahead, self.astern) * self.rpm_limit**2
        most = np.array([np.min(weak / np.maximum(np.abs(self.share[:, i]), 1e-9)) for i in range(6)])
        want = [self.drag(i, share * self.cruise) for i, share in enumerate((1.0, 0.7, 0.6))]
        turn = max(2.0 * self.drag(5, TURN_RAD_S), 0.1 * self.force * self.half_length)
        moment = 0.3 * self.force * self.half_length
        return np.asarray(np.minimum([*want, moment, moment, turn], 0.8 * most))

    @cached_property
    def uprights_itself(self) -> bool:
        """Whether weight under buoyancy holds the vehicle level without an autopilot."""
        arm = float(np.linalg.norm(self.cg - self.cb))
        return self.mass * self.gravity * arm > 0.5 * self.force * self.half_length

    @cached_property
    def stiffness(self) -> float:
        """Righting moment a radian of pitch, with the autopilot's share where there is one, N m."""
        own = self.mass * self.gravity * float(np.linalg.norm(self.cg - self.cb))
        return own if self.uprights_itself else own + LEVEL_RAD_S**2 * float(self.inertia[1, 1] + self.added[4, 4])


LEVEL_RAD_S = 2.2  # how stiffly an autopilot keeps a vehicle level that does not right itself (chosen)


def read(path: Path) -> Sheet:
    """The sheet of a vehicle file. A key that is missing is a KeyError, a thruster without a gain a ValueError."""
    table: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    body, water, units = table["body"], table["water"], table["thruster"]
    lacking = [str(unit["name"]) for unit in units if "k_pos" not in unit or "k_neg" not in unit]
    if lacking:
        raise ValueError(f"{path}: thrusters without k_pos and k_neg: {', '.join(lacking)}; plant b needs both")
    mixed = [float(body.get(key, 0.0)) for key in ("Ixy", "Ixz", "Iyz")]
    inertia = np.diag([float(body[key]) for key in ("Ixx", "Iyy", "Izz")])
    for (i, j), value in zip(((0, 1), (0, 2), (1, 2)), mixed, strict=True):
        inertia[i, j] = inertia[j, i] = -value
    gains = np.array([[unit["k_pos"], unit["k_neg"]] for unit in units], dtype=float).T
    guess = (gains.mean(axis=0) * 3600.0 / (float(water["density"]) * STATIC_KT)) ** 0.25
    aim = np.array([unit["direction"] for unit in units], dtype=float)
    at = np.array([unit["position"] for unit in units], dtype=float)
    return Sheet(
        name=path.stem,
        mass=float(body["mass"]),
        inertia=inertia,
        added=_square(body["added_mass"]),
        linear=np.diag(_square(body["linear_drag"])).copy(),
        quadratic=np.diag(_square(body["quadratic_drag"])).copy(),
        volume=float(body["volume"]),
        cg=np.array(body.get("centre_of_gravity", [0.0, 0.0, 0.0]), dtype=float),
        cb=np.array(body["centre_of_buoyancy"], dtype=float),
        density=float(water["density"]),
        gravity=float(water["gravity"]),
        half_length=float(max(body["size"][:2])) / 2.0 if "size" in body else float(np.linalg.norm(at, axis=1).max()),
        units=tuple(str(unit["name"]) for unit in units),
        at=at,
        aim=aim / np.linalg.norm(aim, axis=1, keepdims=True),
        ahead=gains[0],
        astern=gains[1],
        diameter=np.array([float(unit.get("diameter", 0.0)) or size for unit, size in zip(units, guess, strict=True)]),
        advance=np.array([[unit.get(key, (0.0, 0.0, 0.0)) for unit in units] for key in ("advance_pos", "advance_neg")], dtype=float),
    )


def _square(value: Any) -> Array:
    """A 6 x 6 matrix, given as one or by its diagonal."""
    given = np.array(value, dtype=float)
    return np.diag(given) if given.ndim == 1 else given
