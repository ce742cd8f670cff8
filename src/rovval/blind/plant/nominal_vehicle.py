"""The vehicle as its TOML states it, and the scales that severities and pilots are measured in.

Reads the layout of the project's vehicle files by itself: [body], [water] and [[thruster]] tables in SI units, forward-
starboard-down, ``k_pos`` and ``k_neg`` in N/rpm^2. Sign of the products of inertia: M_RB[3,4] = -Ixy (Merlin thesis 3.12).
"""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from rovval.blind.plant.spec import Array

T200_FORWARD = 4.0727e-6  # N/rpm^2, fit to Blue Robotics' public T200 table at 16 V; used where the TOML has no k_pos
T200_REVERSE = 3.2465e-6  # N/rpm^2, same table


@dataclass(frozen=True, slots=True)
class NominalVehicle:
    """Nominal numbers of one vehicle. Thruster rows are in the order of the file."""

    name: str
    mass: float
    inertia: Array  # (3, 3) about the origin, kg m2
    added_mass: Array  # (6, 6)
    linear_drag: Array  # (6,)
    quadratic_drag: Array  # (6,)
    volume: float
    gravity_centre: Array
    buoyancy_centre: Array
    density: float
    gravity: float
    thrusters: tuple[str, ...]
    positions: Array  # (N, 3)
    directions: Array  # (N, 3), unit
    k_pos: Array  # (N,), N/rpm^2
    k_neg: Array
    diameter: Array  # (N,), m; 0 where thrust does not depend on the advance ratio
    advance: Array  # (2, N, 3), ahead and astern: K_T(J) / K_T(0) = 1 + a J + b J^2 + c J^3


def _inertia(body: dict[str, Any]) -> Array:
    xy, xz, yz = (float(body.get(key, 0.0)) for key in ("Ixy", "Ixz", "Iyz"))
    rows = [[body["Ixx"], -xy, -xz], [-xy, body["Iyy"], -yz], [-xz, -yz, body["Izz"]]]
    return np.array(rows, dtype=float)


def _six(value: Any) -> Array:
    """A diagonal of six, whether the file gives six numbers or a 6 x 6 matrix."""
    given = np.array(value, dtype=float)
    return np.diag(given).copy() if given.ndim == 2 else given


def read_vehicle(path: Path) -> NominalVehicle:
    """A vehicle file as `NominalVehicle`. Missing keys are a KeyError: the file is ours, not a user's."""
    with path.open("rb") as file:
        table = tomllib.load(file)
    body, water, units = table["body"], table["water"], table["thruster"]
    added = np.array(body["added_mass"], dtype=float)
    aim = np.array([unit["direction"] for unit in units], dtype=float)
    return NominalVehicle(
        name=path.stem,
        mass=float(body["mass"]),
        inertia=_inertia(body),
        added_mass=np.diag(added) if added.ndim == 1 else added,
        linear_drag=_six(body["linear_drag"]),
        quadratic_drag=_six(body["quadratic_drag"]),
        volume=float(body["volume"]),
        gravity_centre=np.array(body.get("centre_of_gravity", [0.0, 0.0, 0.0]), dtype=float),
        buoyancy_centre=np.array(body["centre_of_buoyancy"], dtype=float),
        density=float(water["density"]),
        gravity=float(water["gravity"]),
        thrusters=tuple(str(unit["name"]) for unit in units),
        positions=np.array([unit["position"] for unit in units], dtype=float),
        directions=aim / np.linalg.norm(aim, axis=1, keepdims=True),
        k_pos=np.array([unit.get("k_pos", T200_FORWARD) for unit in units], dtype=float),
        k_neg=np.array([unit.get("k_neg", T200_REVERSE) for unit in units], dtype=float),
        diameter=np.array([unit.get("diameter", 0.0) for unit in units], dtype=float),
        advance=np.array([[unit.get(row, (0.0, 0.0, 0.0)) for unit in units] for row in ("advance_pos", "advance_neg")], dtype=float),
    )


def allocation(positions: Array, directions: Array) -> Array:
    """The 6 x N matrix from thrust (N) to body wrench (N, N m): force along, moment r x e."""
    return np.vstack([directions.T, np.cross(positions, directions).T])
