"""Table 6.1 of the thesis from our own plant: each thruster alone at 70 rpm on both platforms, beside the printed figures.

Thrust is read off the motion: a vehicle at rest with one thruster running and the same with none, a millionth of a second later.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.plant.inputs import Inputs
from rovval.plant.model import MODELS, Plant
from rovval.vehicle.model import Vehicle, allocation, as_matrix, rigid_body_mass

RPM = 70.0
# Thesis table 6.1, N (printed "Nm"), thrusters T0 to T6.
PRINTED = {
    "MATLAB": (82.7, 31.3, 83.8, 87.0, 35.2, 86.7, 31.4),
    "ROS": (80.5, 30.4, 78.7, 82.1, 31.7, 80.3, 29.5),
}
STEP_S = 1e-6  # s, short enough that drag has done nothing yet


@dataclass(frozen=True, slots=True)
class Row:
    """One thruster: our thrust on each platform and the printed figures, N (None for a vehicle that is not the thesis's)."""

    thruster: str
    rpm: float
    fossen: float
    freefloating: float
    matlab: float | None
    ros: float | None


def rows(vehicle: Vehicle) -> tuple[Row, ...]:
    """The table for a vehicle; the printed columns are Merlin's."""
    ours = {model: _thrusts(vehicle, model) for model in MODELS}
    printed = {p: (PRINTED[p] if vehicle.name == "merlin" else (None,) * len(vehicle.thruster)) for p in PRINTED}
    return tuple(
        Row(name, RPM, ours["fossen"][i], ours["freefloating"][i], printed["MATLAB"][i], printed["ROS"][i])
        for i, name in enumerate(vehicle.thrusters)
    )


def _thrusts(vehicle: Vehicle, model: str) -> list[float]:
    """Thrust of each thruster at 70 rpm, N: lane i runs thruster i, the last lane none."""
    k = len(vehicle.thruster)
    speed = np.repeat(np.concatenate([np.eye(k), np.zeros((1, k))]) * RPM / 60.0, 2, axis=0)
    plant = Plant(vehicle, model)
    start, zero = 2 * np.arange(k + 1), np.zeros((k + 1, 6))
    motion = plant.simulate(Inputs(STEP_S, speed, hold=True), start, 1, zero, zero, np.tile(plant.null, (k + 1, 1)))
    mass = rigid_body_mass(vehicle.body) + (as_matrix(vehicle.body.added_mass) if model == "fossen" else 0.0)
    force = (motion.nu[:k, 1] - motion.nu[k, 1]) / STEP_S @ mass.T
    return [float(f[:3] @ d) for f, d in zip(force, allocation(vehicle)[:3].T, strict=True)]


def text(vehicle: Vehicle) -> str:
    """The table as plain text."""
    lines = ["thruster   rpm   fossen  freefloating   thesis MATLAB   thesis ROS   (N)"]
    for row in rows(vehicle):
        printed = "".join(f"{'-' if v is None else format(v, '.1f'):>14}" for v in (row.matlab, row.ros))
        lines.append(f"{row.thruster:<9}{row.rpm:5.1f}{row.fossen:9.1f}{row.freefloating:14.1f}{printed}")
    return "\n".join(lines)
