"""Reads a vehicle as uuv_simulator and Plankton keep it in YAML: model parameters, allocation matrix, thruster gain.

Their axes are forward-left-up about ``base_link`` and their damping is negative; both are turned here, once. Keys: ``mass``,
``inertial`` (ixx ...), ``volume``, ``cog``, ``cob``, ``Ma``, ``linear_damping``, ``quad_damping``, ``density``, ``gravity`` (vehicle
parameters), ``tam`` (allocation, 6 rows), ``conversion_fcn_params`` with ``gain`` in N / (rad/s)^2 (thruster manager); at any depth.
``length``, ``width`` and ``height`` are the hull's size if they are there.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadVehicle, all_at_once
from rovval.vehicle import parse
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]
FLIP = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])  # forward-left-up to forward-starboard-down, force and moment
REQUIRED = ("mass", "inertial", "volume", "cog", "cob", "Ma", "linear_damping", "quad_damping", "tam", "conversion_fcn_params")
SHAPES: Mapping[str, tuple[tuple[int, ...], ...]] = {
    **dict.fromkeys(("mass", "volume", "density", "gravity", "length", "width", "height"), ((),)),
    **dict.fromkeys(("cog", "cob"), ((3,),)),
    **dict.fromkeys(("Ma", "linear_damping", "quad_damping"), ((6,), (6, 6))),
}
SIZE = ("length", "width", "height")
INERTIA = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
MOST_CHARACTERS = 60  # characters of a wrong value in a message
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
    found, problems = _found(paths)
    if not problems:
        problems = _problems(found)
    if problems:
        what = " + ".join(map(str, paths))
        raise BadVehicle(all_at_once(problems, what), "give the YAML of the model, of the allocation (TAM) and of the thruster manager, xacro expanded")
    columns = np.array(found["tam"], dtype=float)
    return _toml(found, columns, _gains(found["conversion_fcn_params"], columns.shape[1]), name, [str(p) for p in paths])


def _found(paths: Sequence[str | Path]) -> tuple[dict[str, Any], list[str]]:
    """Every key of every file, nested ones too, the first of a name counting; and the files that cannot be read."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    found: dict[str, Any] = {}
    problems = []

    def collect(node: Any) -> None:
        if isinstance(node, Mapping):
            for key, value in node.items():
                found.setdefault(str(key).rpartition("/")[2], value)
            for value in node.values():
                collect(value)

    for path in paths:
        try:
            collect(YAML(typ="safe").load(Path(path).read_text(encoding="utf-8")))
        except OSError as error:
            problems.append(f"{path}: {error.strerror}")
        except (UnicodeDecodeError, YAMLError) as error:
            problems.append(f"{path} is not YAML: {' '.join(str(error).split())}")
    return found, problems


def _problems(found: Mapping[str, Any]) -> list[str]:
    """What is missing, or is not the numbers that it has to be."""
    problems = [f"{key} is in none of the files" for key in REQUIRED if key not in found]
    for key, shapes in SHAPES.items():
        if key in found and not _numbers(found[key], shapes):
            wanted = " or ".join(" x ".join(map(str, shape)) + " numbers" if shape else "a number" for shape in shapes)
            problems.append(f"{key} is {_short(found[key])}, not {wanted}")
    inertial = found.get("inertial", {})
    if not isinstance(inertial, Mapping):
        problems.append(f"inertial is {_short(inertial)}, not ixx, iyy, izz and so on")
    elif "inertial" in found:
        problems += [f"inertial.{key} is missing" for key in ("ixx", "iyy", "izz") if key not in inertial]
        problems += [f"inertial.{k} is {_short(v)}, not a number" for k, v in inertial.items() if k in INERTIA and not _numbers(v, ((),))]
    return problems + (_thruster_problems(found) if "tam" in found else [])


def _thruster_problems(found: Mapping[str, Any]) -> list[str]:
    rows = found["tam"]
    if not isinstance(rows, list) or len(rows) != 6 or not isinstance(rows[0], list) or not _numbers(rows, ((6, len(rows[0])),)):
        return [f"tam is {_short(rows)}, not 6 rows of one number a thruster"]
    columns = np.array(rows, dtype=float)
    problems = [f"tam, column {i + 1}: no force, so that the thruster has no direction" for i in np.flatnonzero(~columns[:3].any(axis=0))]
    gains = _gains(found.get("conversion_fcn_params"), columns.shape[1])
    if "conversion_fcn_params" in found and len(gains) != columns.shape[1]:
        problems.append(f"conversion_fcn_params: {len(gains)} gains of proportional thrusters for the {columns.shape[1]} columns of tam")
    return problems + [f"conversion_fcn_params: gain {g:g} of thruster {i} is not above 0" for i, g in enumerate(gains) if not g > 0]


def _numbers(value: Any, shapes: Sequence[tuple[int, ...]]) -> bool:
    """Whether a value of YAML holds finite numbers in one of the shapes."""
    try:
        array = np.array(value)
    except ValueError:
        return False
    return array.dtype.kind in "if" and array.shape in shapes and bool(np.isfinite(array).all())


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= MOST_CHARACTERS else text[:MOST_CHARACTERS] + "..."


def _gains(parameters: Any, thrusters: int) -> list[float]:
    entries = parameters if isinstance(parameters, list) else [parameters] * thrusters
    return [float(e["gain"]) for e in entries if isinstance(e, Mapping) and _numbers(e.get("gain"), ((),))]


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


def _notes(found: Mapping[str, Any]) -> list[str]:
    """What a reader of the vehicle has to know of where it comes from."""
    told = ["Only moment arms are in an allocation matrix: each thruster stands where its arm is shortest."]
    if np.any(np.array(found.get("linear_damping_forward_speed", 0.0), dtype=object) != 0):
        told.append("linear_damping_forward_speed of the YAML is left out: there is no such term in the equations of rovval.")
    return told


def _toml(found: Mapping[str, Any], columns: Array, gains: list[float], name: str, files: list[str]) -> str:
    inertial, sized = found["inertial"], all(key in found for key in SIZE)
    place = [[float(x) for x in FLIP[:3] * np.array(found[key], dtype=float) + 0.0] for key in ("cog", "cob")]
    source = json.dumps("uuv_simulator YAML: " + ", ".join(files))
    lines = [f"name = {json.dumps(name)}", f"notes = {json.dumps(_notes(found))}", "", "[sources]"]
    keys = ("mass", "inertia", "added_mass", "linear_drag", "quadratic_drag", "volume", "centre_of_gravity", "centre_of_buoyancy")
    lines += [f"{key} = {source}" for key in keys]
    lines += [f"{key} = {source if key in found else json.dumps('assumed: the default of uuv_simulator')}" for key in DEFAULTS]
    lines += [f"size = {source if sized else json.dumps('assumed: no length, width and height in the YAML')}"]
    lines += [f'"thruster.{key}" = {source}' for key in ("position", "direction", "k_pos", "k_neg")]
    lines += ["", "[body]", f"mass = {float(found['mass'])!r}"]
    lines += [f"{ours} = {float(inertial[theirs])!r}" for ours, theirs in (("Ixx", "ixx"), ("Iyy", "iyy"), ("Izz", "izz"))]
    # Gazebo's ixy is the tensor's own entry, ours (thesis 3.11) its negative; y and z change sign with the axes.
    products = (("Ixy", "ixy", 1.0), ("Ixz", "ixz", 1.0), ("Iyz", "iyz", -1.0))
    lines += [f"{ours} = {s * float(inertial.get(theirs, 0.0)) + 0.0!r}" for ours, theirs, s in products]
    lines += [f"added_mass = {_matrix(found['Ma'], 1.0)}", f"linear_drag = {_matrix(found['linear_damping'], -1.0)}"]
    lines += [f"quadratic_drag = {_matrix(found['quad_damping'], -1.0)}", f"volume = {float(found['volume'])!r}"]
    lines += [f"size = {[float(found[key]) for key in SIZE]}"] if sized else []
    lines += [f"centre_of_gravity = {place[0]}", f"centre_of_buoyancy = {place[1]}", "", "[water]"]
    lines += [f"{key} = {float(found.get(key, value))!r}" for key, value in DEFAULTS.items()]
    for i, column in enumerate((FLIP[:, None] * columns).T):
        length = float(np.linalg.norm(column[:3]))
        direction, moment = column[:3] / length, column[3:] / length
        gain = gains[i] * length * RPM**2
        lines += ["", "[[thruster]]", f'name = "T{i}"', f"position = {[float(x) for x in np.cross(direction, moment) + 0.0]}"]
        lines += [f"direction = {[float(x) for x in direction + 0.0]}", f"k_pos = {gain!r}", f"k_neg = {gain!r}"]
    return "\n".join(lines) + "\n"
