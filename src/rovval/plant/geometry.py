"""What follows from where a vehicle's thrusters stand: which jet reaches which thruster, and on which side the hull lies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from rovval.vehicle.model import Vehicle, allocation

Array = NDArray[np.float64]

JET_SPREAD = 0.1  # tan of the half-angle of a jet's core (Brix, Manoeuvring Technical Manual 1993: 10 % of the way travelled)
TANDEM = 0.75  # loss of a thruster in line behind another: 1 - t = 0.75^((x/D)^(2/3)), ABS DP guide; t is the share left
REACHED = 0.01  # of thrust: a jet that takes less passes by (chosen)
FAINT = 0.05  # of the strongest jet's share: left out (chosen)
NEAREST = 1.01  # times the distance of the nearest neighbour: as near (chosen)
SMALLEST_DIAMETER = 0.05  # share of the hull's longest side taken for a propeller whose diameter the vehicle file does not give


@dataclass(frozen=True, slots=True)
class Jets:
    """Pairs (upstream, downstream) (m, 2) and the share of effect with the upstream thruster turning ahead and astern (m, 2), the
    strongest on each thruster being 1."""

    pairs: NDArray[np.int64]
    weights: Array


def jets(vehicle: Vehicle) -> Jets:
    """Whose jet every thruster stands in. A jet leaves against the thrust, spreads, and weakens as the tandem rule says; beyond the
    core it falls off as a Gaussian. Where no free jet reaches a thruster, its nearest neighbour is taken whichever way it turns
    (jets bend along the hull, and the tandem rule knows distance alone); of several as near, each has its part."""
    smallest, ways = SMALLEST_DIAMETER * max(vehicle.body.size), allocation(vehicle)[:3].T.tolist()
    return _jets(tuple((t.position, tuple(way), t.diameter or smallest) for t, way in zip(vehicle.thruster, ways, strict=True)))


@lru_cache(maxsize=16)  # the vehicles that a calibration tries mostly have their thrusters in one place
def _jets(thrusters: tuple[tuple[tuple[float, ...], tuple[float, ...], float], ...]) -> Jets:
    """The same of thrusters at their places, pushing their ways (unit vectors), and of these diameters."""
    position, way = np.array([place for place, _, _ in thrusters]), np.array([way for _, way, _ in thrusters])
    diameter = [diameter for _, _, diameter in thrusters]
    pairs: list[tuple[int, int]] = []
    weights: list[Array] = []
    for i, place in enumerate(position):
        weight = _reaching(position, way, diameter, i)
        if weight.max(initial=0.0) < REACHED:
            distance = np.where(np.arange(len(position)) == i, np.inf, np.linalg.norm(position - place, axis=1))
            near = np.isfinite(distance) & (distance <= NEAREST * distance.min())
            weight = np.repeat(near[:, None] / max(near.sum(), 1), 2, axis=1)
        else:
            weight = weight / weight.max()
        upstream = np.flatnonzero(weight.max(axis=1) > FAINT)
        pairs += [(int(j), i) for j in upstream]
        weights += list(weight[upstream])
    found = Jets(np.array(pairs, dtype=np.int64).reshape(-1, 2), np.array(weights, dtype=float).reshape(-1, 2))
    found.pairs.setflags(write=False)
    found.weights.setflags(write=False)
    return found


def _reaching(position: Array, way: Array, diameter: Sequence[float], i: int) -> Array:
    """Share (k, 2) of the thrust of thruster ``i`` that the free jet of each other takes, turning ahead and astern."""
    share = np.zeros((len(position), 2))
    for j in range(len(position)):
        if j != i:
            share[j] = [_share(position[i] - position[j], -sign * way[j], diameter[j]) for sign in (1.0, -1.0)]
    return share


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
