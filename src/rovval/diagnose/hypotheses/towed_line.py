"""Initial points of a tether that is dragged along.

Across the line from the vehicle to where its tether is held the tether brakes, along it hardly: no slope leads from no effect to the way that it lies, and to
a drag that is alike all round a wrong way adds nothing. So a line to a point is fitted to the forces and moments that each half of a window lacks
(`missing_wrench`): its drag, its pull and its weight enter linearly and are eliminated (variable projection; Golub and Pereyra 1973). The best line is
where a fit by simulation begins.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np
from scipy.optimize import minimize

from rovval.core.data import Array
from rovval.diagnose.effort import LINE_BEARINGS, LINE_EVALUATIONS, LINE_LENGTHS, LINE_RISES, LINE_STARTS
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, at_full_size
from rovval.diagnose.hypotheses.missing_wrench import LEAST_DISTANCE, MissingWrench, pull_towards
from rovval.plant import Plant

LEAST_PULL = 3.0  # N: a line begins with as much, where the forces have less, since a pull of next to nothing tells no direction
DOWN = np.array([0.0, 0.0, 1.0])

Line = dict[str, float]  # by the names of the effect `tether_drag`, but for north, east and down, which are of the point that it leads to (m)


def towed_line(lack: MissingWrench) -> Line | None:
    """The line that explains most of what the windows ``lack``; None where each would push, or would not brake.

    It has `tether_drag`'s coefficient (N s2/m2), weight (N), x and z (m), the point that it leads to (north, east, down; m) and its ``pull`` (N).
    """
    middle, reach = _track(lack)
    bearings = 2.0 * np.pi * np.arange(LINE_BEARINGS) / LINE_BEARINGS
    begun = [middle + reach * far * _way(bearing, rise) for bearing, rise, far in product(bearings, LINE_RISES, LINE_LENGTHS)]
    worth = [explained(lack, point, np.zeros(3))[0] for point in begun]
    found = [fitted_line(lack, begun[i], reach) for i in np.argsort([-one for one in worth])[:LINE_STARTS] if worth[i] > 0.0]
    return max(found, key=lambda one: one[0])[1] if found else None


def explained(lack: MissingWrench, point: Array, tie: Array) -> tuple[float, Array]:
    """What a line from ``tie`` on the vehicle (m, body axes) to ``point`` (m) takes from the loss at its best.

    Returns:
        That reduction, and (3,) its drag (N s2/m2), weight (N) and pull (N); zeros where it would have to drive the vehicle, and no pull where it would push.
    """
    forces = _forces(lack, point, tie)
    size, along = lack.normal(np.stack([lack.levered(force) @ (1.0, tie[0], tie[2]) for force in forces], axis=-1))
    for kept in (3, 2):
        best = np.linalg.lstsq(size[:kept, :kept], along[:kept], rcond=1e-12)[0]
        if best[0] > 0.0 and best[2:].min(initial=0.0) >= 0.0:
            return float(along[:kept] @ best), np.pad(best, (0, 3 - kept))
    return 0.0, np.zeros(3)


def fitted_line(lack: MissingWrench, point: Array, reach: float) -> tuple[float, Line]:
    """(What it takes from the loss, its parameters) of the best line near a first guess of the ``point`` that it leads to, off by some ``reach`` (m), and tied
    to the vehicle near its origin."""

    def loss(x: Array) -> float:
        return -explained(lack, x[:3], _tie(x))[0]

    first = np.array([*point, 0.0, 0.0])
    corners = first + np.vstack([np.zeros(5), np.diag([0.5 * reach] * 3 + [LEAST_DISTANCE] * 2)])
    best = minimize(loss, first, method="Nelder-Mead", options={"maxfev": LINE_EVALUATIONS, "initial_simplex": corners}).x
    reduction, (drag, weight, pull) = explained(lack, best[:3], _tie(best))
    names = ("north", "east", "down", "x", "z", "coefficient", "weight", "pull")
    return reduction, dict(zip(names, (*best.tolist(), float(drag), float(weight), float(pull)), strict=True))


def from_line(plant: Plant, name: str, slots: tuple[int, ...], line: Mapping[str, float], depth: float, next_id: int) -> Hypothesis:
    """The hypothesis whose fit begins with all of a ``line`` at once, its pull as it is at the log's origin at a ``depth`` (m)."""
    return at_full_size(plant, f"{name}@line", slots, {**line, **pull_towards(line, max(line["pull"], LEAST_PULL), depth)}, next_id)


def _track(lack: MissingWrench) -> tuple[Array, float]:
    """The middle of where the vehicle was (m), and how far it gets from there."""
    place = lack.place.reshape(-1, 3)
    middle = np.asarray(np.median(place, axis=0))
    return middle, max(float(np.quantile(np.linalg.norm(place - middle, axis=1), 0.9)), LEAST_DISTANCE)


def _way(bearing: float, rise: float) -> Array:
    """Unit vector (north, east, down) of a ``bearing`` that rises by an angle; rad."""
    return np.array([np.cos(rise) * np.cos(bearing), np.cos(rise) * np.sin(bearing), -np.sin(rise)])


def _forces(lack: MissingWrench, point: Array, tie: Array) -> list[Array]:
    """Mean forces (m, 2, 3), body axes, in the halves of the windows, of a line from ``tie`` to ``point``: a drag of 1 N s2/m2, a weight and a pull of 1 N."""
    to = point - lack.place - lack.rotation @ tie
    to = to / np.maximum(np.linalg.norm(to, axis=-1, keepdims=True), LEAST_DISTANCE)
    along, down = (np.einsum("whtij,whti->whtj", lack.rotation, way) for way in (to, np.broadcast_to(DOWN, to.shape)))
    velocity = lack.velocity[..., :3] + np.cross(lack.velocity[..., 3:], tie)
    across = velocity - (velocity * along).sum(axis=-1, keepdims=True) * along
    return [force.mean(axis=2) for force in (-np.linalg.norm(across, axis=-1, keepdims=True) * across, down, along)]


def _tie(x: Array) -> Array:
    """Where a line is tied (m, body axes), of its point and where that is ahead and below."""
    return np.array([x[3], 0.0, x[4]])
