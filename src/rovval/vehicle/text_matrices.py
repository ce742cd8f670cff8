"""Reads a vehicle as the thesis's Simulink project keeps it: a folder of matrices as text (figure 3.3, ``merlinUCV``; enricoande/uuv, ``minerva``).

Files: ``M_RB M_A D_L D_q`` (6 x 6), ``T`` (allocation, 6 x k), ``COG COB`` (3), ``V`` (m3), ``D`` (propeller diameters, k), ``K_T`` (rows ahead and
astern of a polynomial in the advance ratio, highest power first), ``theta`` (thrust-loss factors, rows ahead and astern, k). Thrust is
rho D^4 n |n| theta K_T(J_a). Its axes are north-west-up; they are turned here, once.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadVehicle, all_at_once
from rovval.vehicle import parse
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]
FLIP = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])  # north-west-up to forward-starboard-down, force and moment
DENSITY, GRAVITY = 1025.0, 9.81  # sea water, standard: the project keeps them in a script
MATRICES = ("M_RB", "M_A", "D_L", "D_q")
FILES = (*MATRICES, "T", "COG", "COB", "V", "D", "K_T", "theta")


def read(folder: str | Path, name: str) -> Vehicle:
    """The vehicle of that folder, audited.

    Raises:
        BadVehicle: a file is missing or holds no such matrix; every problem at once.
    """
    return parse(as_toml(folder, name), str(folder))


def as_toml(folder: str | Path, name: str) -> str:
    """The same as a vehicle file of ours, for a user to finish and keep."""
    found, problems = _found(Path(folder))
    problems = problems or _problems(found)
    if problems:
        raise BadVehicle(all_at_once(problems, str(folder)), f"give the folder that holds {', '.join(f'{f}.txt' for f in FILES)}")
    return _toml(found, name, str(folder))


def _found(folder: Path) -> tuple[dict[str, Array], list[str]]:
    """Every matrix of the folder, two-dimensional; and the files that cannot be read as one."""
    found, problems = dict[str, Array](), list[str]()
    for name in FILES:
        path = folder / f"{name}.txt"
        try:
            rows = [line.replace(",", " ").split() for line in path.read_text(encoding="utf-8").splitlines() if line.strip()]
            found[name] = np.array([[float(x) for x in row] for row in rows])
            if not np.isfinite(found[name]).all() or not found[name].size:
                problems.append(f"{path.name}: holds a number that is not finite, or none")
        except OSError as error:
            problems.append(f"{path.name}: {error.strerror}")
        except ValueError as error:
            problems.append(f"{path.name}: no matrix of numbers ({error})")
    return found, problems


def _problems(found: dict[str, Array]) -> list[str]:
    """Matrices that have not the shape that they must have, and thrusters that have no direction or law."""
    k = found["T"].shape[1]
    shapes = dict.fromkeys(MATRICES, (6, 6)) | {"T": (6, k), "theta": (2, k)}
    problems = [f"{n}.txt is {' x '.join(map(str, found[n].shape))}, not {' x '.join(map(str, s))}" for n, s in shapes.items() if found[n].shape != s]
    sizes = {"COG": 3, "COB": 3, "V": 1, "D": k}
    problems += [f"{n}.txt has {found[n].size} numbers, not {size}" for n, size in sizes.items() if found[n].size != size]
    if found["K_T"].shape[0] != 2 or not 1 <= found["K_T"].shape[1] <= 4:
        problems.append(f"K_T.txt is {' x '.join(map(str, found['K_T'].shape))}, not two rows, ahead and astern, of a polynomial up to the third power")
    elif (found["K_T"][:, -1] <= 0).any():
        problems.append("K_T.txt: K_T(0), the last figure of a row, is not above 0")
    problems += [f"T.txt, column {i + 1}: no force, so that the thruster has no direction" for i in np.flatnonzero(~found["T"][:3].any(axis=0))]
    return problems + [f"{n}.txt: a figure is not above 0" for n in ("theta", "D", "V") if (found[n] <= 0).any()]


def _mirrored(matrix: Array) -> Array:
    """A symmetric matrix of which one half was printed alone, as the thesis prints M_RB (3.12)."""
    if not np.tril(matrix, -1).any() or not np.triu(matrix, 1).any():
        return matrix + matrix.T - np.diag(np.diag(matrix))
    return matrix


def _diagonal_or_matrix(matrix: Array) -> str:
    turned = FLIP[:, None] * matrix * FLIP + 0.0
    return repr(np.diag(turned).tolist() if (turned == np.diag(np.diag(turned))).all() else turned.tolist())


def _centres(found: dict[str, Array], mass: Array) -> tuple[list[float], list[float], str]:
    """Centres of gravity and buoyancy in our axes, and what had to be decided of them."""
    gravity, buoyancy = (found[n].reshape(-1) for n in ("COG", "COB"))
    apart = buoyancy - gravity
    note = ""
    if apart[2] < 0:
        note = "COB lies below COG as printed with z up, where the vehicle would tip over: their z is taken as down, their distance kept."
    else:
        apart = FLIP[:3] * apart
    if mass[:3, 3:].any():
        m = mass[0, 0]
        origin = np.array([mass[1, 5], mass[2, 3], mass[0, 4]]) / m
        return origin.tolist(), (origin + apart + 0.0).tolist(), note
    return [0.0] * 3, (apart + 0.0).tolist(), f"{note} M_RB couples no force with a turn: its origin is the centre of gravity.".strip()


def _toml(found: dict[str, Array], name: str, folder: str) -> str:
    mass = FLIP[:, None] * _mirrored(found["M_RB"]) * FLIP + 0.0
    gravity, buoyancy, note = _centres(found, mass)
    trim = DENSITY * float(found["V"].item()) / mass[0, 0] - 1.0
    told = [note, "Only moment arms are in an allocation matrix: each thruster stands where its arm is shortest.",
            f"V makes it {100 * abs(trim):.2g} % {'light' if trim > 0 else 'heavy'} in water of {DENSITY:g} kg/m3.",
            "k_pos and k_neg are rho D^4 theta K_T(0) / 3600, the advance rows K_T over K_T(0)."]  # fmt: skip
    source = json.dumps(f"text matrices of {Path(folder).name}")
    lines = [f"name = {json.dumps(name)}", f"notes = {json.dumps([t for t in told if t])}", "", "[sources]"]
    own = ("mass", "inertia", "added_mass", "linear_drag", "quadratic_drag", "volume", "centre_of_gravity", "centre_of_buoyancy")
    lines += [f"{key} = {source}" for key in own]
    lines += [f'"thruster.{key}" = {source}' for key in ("position", "direction", "k_pos", "k_neg", "advance")]
    lines += ['size = "assumed: not in the folder"', 'density = "assumed: sea water"', 'gravity = "assumed: standard"', "", "[body]"]
    i = mass[3:, 3:]
    lines += [f"mass = {float(mass[0, 0])!r}", *(f"I{a}{a} = {float(i[k, k])!r}" for k, a in enumerate("xyz"))]
    lines += [f"I{a} = {-float(i[r, c]) + 0.0!r}" for a, r, c in (("xy", 0, 1), ("xz", 0, 2), ("yz", 1, 2))]
    for key, matrix in (("added_mass", _mirrored(found["M_A"])), ("linear_drag", np.abs(np.diag(np.diag(found["D_L"]))) + _off(found["D_L"])),
                        ("quadratic_drag", np.abs(np.diag(np.diag(found["D_q"]))) + _off(found["D_q"]))):  # fmt: skip
        lines.append(f"{key} = {_diagonal_or_matrix(matrix)}")
    lines += [f"volume = {float(found['V'].item())!r}", f"centre_of_gravity = {gravity}", f"centre_of_buoyancy = {buoyancy}"]
    lines += ["", "[water]", f"density = {DENSITY!r}", f"gravity = {GRAVITY!r}"]
    return "\n".join([*lines, *_thrusters(found)]) + "\n"


def _off(matrix: Array) -> Array:
    """Couplings of a drag matrix, positive as its diagonal: the thesis prints all of it negative (3.13)."""
    sign = -1.0 if np.diag(matrix).sum() < 0 else 1.0
    return sign * (matrix - np.diag(np.diag(matrix)))


def _thrusters(found: dict[str, Array]) -> list[str]:
    lines = []
    diameters = found["D"].reshape(-1)
    for j, column in enumerate((FLIP[:, None] * found["T"]).T):
        length = float(np.linalg.norm(column[:3]))
        direction, moment = column[:3] / length, column[3:] / length
        at_rest = DENSITY * diameters[j] ** 4 * found["theta"][:, j] * found["K_T"][:, -1] * length / 3600.0
        rows = [(row[-2::-1] / row[-1]).tolist() for row in found["K_T"]]
        lines += ["", "[[thruster]]", f'name = "T{j}"', f"position = {(np.cross(direction, moment) + 0.0).tolist()}"]
        lines += [f"direction = {(direction + 0.0).tolist()}", f"k_pos = {float(at_rest[0])!r}", f"k_neg = {float(at_rest[1])!r}"]
        lines += [f"diameter = {float(diameters[j])!r}"]
        lines += [f"advance_{way} = {row + [0.0] * (3 - len(row))}" for way, row in zip(("pos", "neg"), rows, strict=True)]
    return lines
