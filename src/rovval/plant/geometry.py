"""What follows from where a vehicle's thrusters stand: which jet reaches which thruster, and on which side the hull lies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.vehicle.model import Vehicle, allocation

Array = NDArray[np.float64]

JET_SPREAD = 0.1  # tan of the half-angle of a jet's core (Brix, Manoeuvring Technical Manual 1993: 10 % of the way travelled)
TANDEM = 0.75  # loss of a thruster in line behind another: 1 - t = 0.75^((x/D)^(2/3)), ABS DP guide; t is the share left
PAIRS = 8  # strongest pairs kept
SMALLEST_DIAMETER = 0.05  # share of the hull's longest side taken for a propeller whose diameter the vehicle file does not give


@dataclass(frozen=True, slots=True)
class Jets:
    """Pairs (upstream, downstream) (m, 2) and the share of effect with the upstream thruster turning ahead and astern (m, 2),
    the strongest being 1."""

    pairs: NDArray[np.int64]
    weights: Array


def jets(vehicle: Vehicle) -> Jets:
    """Pairs of thrusters of which one stands in the other's jet. A jet leaves against the thrust, spreads, and weakens as the
    tandem rule says; beyond the core it falls off as a Gaussian. Scaled so that the strongest pair has 1."""
    position = np.array([t.position for t in vehicle.thruster])
    direction = allocation(vehicle)[:3].T
    size = max(vehicle.body.size)
    found: list[tuple[int, int, float, float]] = []
    for j, (place, way) in enumerate(zip(position, direction, strict=True)):
        diameter = vehicle.thruster[j].diameter or SMALLEST_DIAMETER * size
        for i in range(len(position)):
            if i != j:
                share = [_share(position[i] - place, -sign * way, diameter) for sign in (1.0, -1.0)]
                found.append((j, i, share[0], share[1]))
    found.sort(key=lambda f: -max(f[2], f[3]))
    kept = [f for f in found[:PAIRS] if max(f[2], f[3]) > 0]
    strongest = max((max(f[2], f[3]) for f in kept), default=1.0)
    return Jets(
        np.array([f[:2] for f in kept], dtype=np.int64).reshape(-1, 2),
        np.array([f[2:] for f in kept], dtype=float).reshape(-1, 2) / strongest,
    )


def _share(offset: Array, jet: Array, diameter: float) -> float:
    """Share of the jet's effect at ``offset`` from the thruster, 0 upstream."""
    along = float(offset @ jet)
    if along <= 0:
        return 0.0
    aside = float(np.linalg.norm(offset - along * jet))
    width = 0.5 * diameter + JET_SPREAD * along
    return float(TANDEM ** ((along / diameter) ** (2 / 3)) * np.exp(-((aside / width) ** 2)))


def hull_side(vehicle: Vehicle) -> Array:
    """Wrench (k, 6) of 1 N of side force at each thruster, across its thrust, towards the hull's middle (Coanda)."""
    rows = []
    for thruster, way in zip(vehicle.thruster, allocation(vehicle)[:3].T, strict=True):
        place = np.array(thruster.position)
        inward = -(place - (place @ way) * way)
        length = float(np.linalg.norm(inward))
        force = inward / length if length > 1e-9 else np.zeros(3)
        rows.append(np.concatenate([force, np.cross(place, force)]))
    return np.array(rows)
