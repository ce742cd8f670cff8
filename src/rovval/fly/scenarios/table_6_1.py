"""Table 6.1 of the thesis from our own plant: each thruster alone at 70 rpm on every platform, beside the printed figures.

Thrust is read off the motion: a vehicle at rest with one thruster running and the same with none, a millionth of a second later. For Merlin the
agreement is circular on two platforms: `fossen`'s gains are the printed MATLAB column, `uuv`'s the printed ROS column. What the table shows is that
masses, allocation and conversion of both give them back, and by how much the two columns differ.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.core.errors import UsageProblem
from rovval.plant import platforms
from rovval.plant.inputs import Inputs
from rovval.plant.model import Plant
from rovval.vehicle.model import Vehicle, allocation, as_matrix, rigid_body_mass

RPM = 70.0
# Thesis table 6.1, N (printed "Nm"), thrusters T0 to T6.
PRINTED = {
    "MATLAB": (82.7, 31.3, 83.8, 87.0, 35.2, 86.7, 31.4),
    "ROS": (80.5, 30.4, 78.7, 82.1, 31.7, 80.3, 29.5),
}
CIRCULAR = {"fossen": "MATLAB", "uuv": "ROS"}  # platform -> printed column that Merlin's gains on it are taken from
STEP_S = 1e-6  # s, short enough that drag has done nothing yet


@dataclass(frozen=True, slots=True)
class Row:
    """One thruster: our thrust on each platform that can simulate the vehicle, and the printed figures, N (None for a vehicle that is not the thesis's)."""

    thruster: str
    rpm: float
    ours: Mapping[str, float]
    matlab: float | None
    ros: float | None


def rows(vehicle: Vehicle) -> tuple[Row, ...]:
    """The table for a vehicle; the printed columns are Merlin's."""
    refused = refusals(vehicle)
    ours = {model: thrusts(vehicle, model) for model in platforms.names() if model not in refused}
    printed = {p: (PRINTED[p] if vehicle.name == "merlin" else (None,) * len(vehicle.thruster)) for p in PRINTED}
    return tuple(
        Row(name, RPM, {model: column[i] for model, column in ours.items()}, printed["MATLAB"][i], printed["ROS"][i])
        for i, name in enumerate(vehicle.thrusters)
    )


def refusals(vehicle: Vehicle) -> dict[str, str]:
    """Why a platform cannot simulate this vehicle, by those that cannot."""
    found = dict[str, str]()
    for model in platforms.names():
        try:
            Plant(vehicle, model)
        except UsageProblem as refusal:
            found[model] = refusal.message
    return found


def thrusts(vehicle: Vehicle, model: str, rpm: float = RPM) -> list[float]:
    """Thrust of each thruster alone at ``rpm``, N."""
    plant = Plant(vehicle, model)
    body, start = plant.simulated.body, (np.zeros(1, dtype=np.int64), 1, np.zeros((1, 6)), np.zeros((1, 6)), plant.null[None])

    def acceleration(speed: Array) -> Array:
        motion = plant.simulate(Inputs(STEP_S, np.tile(speed, (2, 1)), hold=True), *start)
        return np.asarray(motion.nu[0, 1] / STEP_S)

    still = acceleration(np.zeros(len(vehicle.thruster)))
    alone = np.stack([acceleration(speed) for speed in np.eye(len(vehicle.thruster)) * rpm / 60.0])
    force = (alone - still) @ (rigid_body_mass(body) + as_matrix(body.added_mass)).T
    return [float(f[:3] @ d) for f, d in zip(force, allocation(vehicle)[:3].T, strict=True)]


def text(vehicle: Vehicle) -> str:
    """The table as plain text."""
    table = rows(vehicle)
    names = list(table[0].ours)
    lines = ["thruster   rpm" + "".join(f"{name:>14}" for name in names) + "   thesis MATLAB   thesis ROS   (N)"]
    for row in table:
        printed = "".join(f"{'-' if v is None else format(v, '.1f'):>14}" for v in (row.matlab, row.ros))
        lines.append(f"{row.thruster:<9}{row.rpm:5.1f}" + "".join(f"{row.ours[name]:14.1f}" for name in names) + printed)
    return "\n".join(lines)
