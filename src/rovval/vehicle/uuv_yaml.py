"""Reads a vehicle as uuv_simulator and Plankton keep it in YAML: model parameters, allocation matrix, thruster gain.

Their axes are forward-left-up about ``base_link`` and their damping is negative; both are turned here, once. Keys: ``mass``,
``inertial`` (ixx ...), ``volume``, ``cog``, ``cob``, ``Ma``, ``linear_damping``, ``quad_damping``, ``density``, ``gravity`` (vehicle
parameters), ``tam`` (allocation, 6 rows), ``conversion_fcn_params`` with ``gain`` in N / (rad/s)^2 (thruster manager); at any depth.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval.errors import BadVehicle, all_at_once
from rovval.vehicle import parse
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]
FLIP = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])  # forward-left-up to forward-starboard-down, force and moment
REQUIRED = ("mass", "inertial", "volume", "cog", "cob", "Ma", "linear_damping", "quad_damping", "tam", "conversion_fcn_params")
PRINTED_DIGITS = 1e-3  # asymmetry, relative to the diagonal, that is the last printed digit (RexROV: 10.774 and 10.775)
RPM = 2.0 * np.pi / 60.0  # rad/s of one revolution per minute
DEFAULTS = {"density": 1028.0, "gravity": 9.81}  # uuv_simulator's own (vehicle.py: density 1028, gravity 9.81)


def read(paths: Sequence[str | Path], name: str) -> Vehicle:
    """The vehicle that those YAML files describe together, audited.

    Raises:
        BadVehicle: a file is not YAML or a number is missing; every problem at once.
    """
    return parse(as_toml(paths, name), " + ".join(map(str, paths)))


def as_toml(paths: Sequence[str | Path], name: str) -> str:
    """The same as a vehicle file of ours, for a user to finish and keep."""
    found = _found(paths)
    problems = [f"{key} is in none of the files" for key in REQUIRED if key not in found]
    gains: list[float] = []
    if not problems:
        columns = np.array(found["tam"], dtype=float)
        if columns.ndim != 2 or len(columns) != 6:
            problems.append(f"tam is {columns.shape}, not 6 rows")
        else:
            gains = _gains(found["conversion_fcn_params"], columns.shape[1])
            if len(gains) != columns.shape[1]:
                problems.append("conversion_fcn_params holds no gain of a proportional thruster for every column of tam")
    if problems:
        raise BadVehicle(all_at_once(problems, f"vehicle {name} from {len(paths)} YAML files"), "give the model, the TAM and the thruster manager")
    return _toml(found, columns, gains, name, [str(p) for p in paths])


def _found(paths: Sequence[str | Path]) -> dict[str, Any]:
    """Every key of every file, nested ones too; the first of a name counts."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    found: dict[str, Any] = {}

    def collect(node: Any) -> None:
        if isinstance(node, Mapping):
            for key, value in node.items():
                found.setdefault(str(key).rpartition("/")[2], value)
            for value in node.values():
                collect(value)

    for path in paths:
        try:
            collect(YAML(typ="safe").load(Path(path).read_text(encoding="utf-8")))
        except (OSError, UnicodeDecodeError, YAMLError) as error:
            raise BadVehicle(f"{path} is not a YAML file that can be read: {error}") from None
    return found


def _gains(parameters: Any, thrusters: int) -> list[float]:
    entries = parameters if isinstance(parameters, list) else [parameters] * thrusters
    return [float(e["gain"]) for e in entries if isinstance(e, Mapping) and "gain" in e]


def _matrix(values: Any, sign: float) -> list[list[float]] | list[float]:
    """Diagonal or matrix, positive, in our axes."""
    a = sign * np.array(values, dtype=float)
    if a.ndim == 1:
        return [float(x) for x in a]
    scale = np.sqrt(np.abs(np.outer(np.diag(a), np.diag(a)))) + 1e-300
    if (np.abs(a - a.T) <= PRINTED_DIGITS * scale).all():
        a = 0.5 * (a + a.T)
    turned = FLIP[:, None] * a * FLIP
    return [[float(x) + 0.0 for x in row] for row in turned]


def _toml(found: Mapping[str, Any], columns: Array, gains: list[float], name: str, files: list[str]) -> str:
    inertial = found["inertial"]
    place = [[float(x) for x in FLIP[:3] * np.array(found[key], dtype=float) + 0.0] for key in ("cog", "cob")]
    source = json.dumps("uuv_simulator YAML: " + ", ".join(files))
    note = 'notes = ["Only moment arms are in an allocation matrix: each thruster stands where its arm is shortest."]'
    lines = [f"name = {json.dumps(name)}", note, "[sources]"]
    keys = ("mass", "inertia", "added_mass", "linear_drag", "quadratic_drag", "volume", "centre_of_gravity", "centre_of_buoyancy", "density", "gravity")
    lines += [f"{key} = {source}" for key in keys]
    lines += [f'"thruster.{key}" = {source}' for key in ("position", "direction", "k_pos", "k_neg")]
    lines += ["[body]", f"mass = {float(found['mass'])!r}"]
    lines += [f"{ours} = {float(inertial[theirs])!r}" for ours, theirs in (("Ixx", "ixx"), ("Iyy", "iyy"), ("Izz", "izz"))]
    # Gazebo's ixy is the tensor's own entry, ours (thesis 3.11) its negative; y and z change sign with the axes.
    products = (("Ixy", "ixy", 1.0), ("Ixz", "ixz", 1.0), ("Iyz", "iyz", -1.0))
    lines += [f"{ours} = {s * float(inertial.get(theirs, 0.0)) + 0.0!r}" for ours, theirs, s in products]
    lines += [f"added_mass = {_matrix(found['Ma'], 1.0)}", f"linear_drag = {_matrix(found['linear_damping'], -1.0)}"]
    lines += [f"quadratic_drag = {_matrix(found['quad_damping'], -1.0)}", f"volume = {float(found['volume'])!r}"]
    lines += [f"centre_of_gravity = {place[0]}", f"centre_of_buoyancy = {place[1]}", "[water]"]
    lines += [f"{key} = {float(found.get(key, value))!r}" for key, value in DEFAULTS.items()]
    for i, column in enumerate((FLIP[:, None] * columns).T):
        length = float(np.linalg.norm(column[:3]))
        direction, moment = column[:3] / length, column[3:] / length
        gain = gains[i] * length * RPM**2
        lines += ["[[thruster]]", f'name = "T{i}"', f"position = {[float(x) for x in np.cross(direction, moment) + 0.0]}"]
        lines += [f"direction = {[float(x) for x in direction + 0.0]}", f"k_pos = {gain!r}", f"k_neg = {gain!r}"]
    return "\n".join(lines) + "\n"
