"""Initial points of a spring that holds the vehicle to a point, such as a tether that has snagged.

No slope leads from no effect to a spring that holds a vehicle, and each place is a local minimum of its own. So a spring towards a point, slack within a
radius, is fitted to the forces and moments that each half of a window lacks (`missing_wrench`), from every half on. Its stiffness and where on the vehicle it
is tied enter linearly and are eliminated (variable projection; Golub and Pereyra 1973). The best few springs are where fits by simulation begin.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from rovval.core.data import Array
from rovval.diagnose.criteria import SPRING_LEAST_STIFFNESS
from rovval.diagnose.effort import SPRING_APART_S, SPRING_EVIDENT_SHARE, SPRING_STARTS
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, at_full_size
from rovval.diagnose.hypotheses.missing_wrench import MissingWrench, pull_towards
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.windows.windows import Windows
from rovval.plant import Plant

RADII = (0.2, 0.5, 0.8)  # radii tried, as shares of how far the vehicle gets from the point
EVALUATIONS, PASSES = 150, 2  # of the loss of a spring, and how often it is fitted, each time from where the one before is tied

Spring = dict[str, float]  # parameters by the names of the effect `tether_snag`, "pull" (N): its mean, and "share": of the gap, that it takes by its stretch


def springs(problem: Problem, lack: MissingWrench) -> list[Spring]:
    """The springs that explain most of what the first run's windows ``lack`` at the nominal vehicle, the best first.

    Each has the parameters of `tether_snag` (north, east, down, radius, x, z in m, stiffness in N/m, onset in s since the run's start) and the ``share``
    of the gap that it takes by its stretch: 0 for one so soft that it might as well pull evenly (`SPRING_LEAST_STIFFNESS`).
    """
    onsets, places = lack.t[:, :, 0].reshape(-1), np.asarray(lack.place[:, :, 0].reshape(-1, 3))
    first = [max(((explained(lack, t, p, r)[0], r) for r in _radii(lack, t, p)), default=(0.0, 0.0)) for t, p in zip(onsets, places, strict=True)]
    found = list[tuple[float, Spring]]()
    for i in np.argsort([-reduction for reduction, _ in first]):
        if len(found) < SPRING_STARTS and first[i][0] > 0 and all(abs(onsets[i] - spring["onset"]) >= SPRING_APART_S for _, spring in found):
            found.append(fitted_spring(lack, float(onsets[i]), places[i], first[i][1]))
    gap = float(problem.gap.dynamics.c.sum())
    shares = [(reduction / gap, spring) for reduction, spring in sorted(found, key=lambda one: -one[0]) if reduction > 0]
    return [spring | {"share": share if spring["stiffness"] >= SPRING_LEAST_STIFFNESS else 0.0} for share, spring in shares]


def explained(lack: MissingWrench, onset: float, point: Array, radius: float) -> tuple[float, Array]:
    """What a spring towards ``point`` (m), slack within ``radius`` (m), from ``onset`` (s) on takes from the loss of what is missing at its best stiffness and
    levers.

    Returns:
        That reduction, and (3,) the stiffness (N/m) and the stiffness times its levers ahead and below (N); zeros where it would have to push.
    """
    to = point - lack.place
    away = np.linalg.norm(to, axis=-1)
    pull = np.where(lack.t >= onset, np.maximum(away - radius, 0.0) / np.maximum(away, 1e-9), 0.0)
    force = np.einsum("wht,whtij,whti->whj", pull, lack.rotation, to) / pull.shape[-1]
    size, along = lack.normal(lack.levered(force))
    best = np.asarray(np.linalg.lstsq(size, along, rcond=1e-12)[0], dtype=np.float64)
    return (float(along @ best), best) if best[0] > 0 else (0.0, np.zeros_like(best))


def _radii(lack: MissingWrench, onset: float, point: Array) -> Array:
    """Radii (m) that are tried about a point."""
    away = np.linalg.norm(lack.place[lack.t >= onset] - point, axis=-1)
    return np.array(RADII) * float(away.max(initial=0.0))


def fitted_spring(lack: MissingWrench, onset: float, point: Array, radius: float) -> tuple[float, Spring]:
    """(What it takes from the loss, its parameters) of the best spring from ``onset`` (s) on near a first guess of its ``point`` and ``radius`` (m): tied
    to the vehicle's origin first, then where that fit says that it is tied."""
    at, tie, best, reduction = np.array([*point, radius]), np.zeros(3), np.zeros(3), 0.0
    for _ in range(PASSES):
        tied = replace(lack, place=lack.place + lack.rotation @ tie)

        def loss(x: Array, tied: MissingWrench = tied) -> float:
            return -explained(tied, onset, x[:3], abs(float(x[3])))[0]

        at = minimize(loss, at, method="Nelder-Mead", options={"maxfev": EVALUATIONS, "initial_simplex": _simplex(at)}).x
        at[3] = abs(at[3])
        reduction, best = explained(tied, onset, at[:3], float(at[3]))
        tie = np.array([best[1], 0.0, best[2]]) / best[0] if reduction > 0 else np.zeros(3)
    names = ("north", "east", "down", "radius", "stiffness", "x", "z", "onset", "pull")
    away = np.linalg.norm(at[:3] - lack.place[lack.t >= onset], axis=-1)
    pull = float(best[0] * np.maximum(away - at[3], 0.0).mean()) if away.size else 0.0
    return reduction, dict(zip(names, (*at.tolist(), float(best[0]), float(tie[0]), float(tie[2]), onset, pull), strict=True))


def _simplex(at: Array) -> Array:
    """Corners as far from the first guess as its radius, half a metre at least."""
    return np.asarray(at + np.vstack([np.zeros(4), max(float(at[3]), 0.5) * np.eye(4)]))


def from_springs(plant: Plant, name: str, slots: tuple[int, ...], found: Sequence[Mapping[str, float]], next_id: int) -> list[Hypothesis]:
    """One hypothesis for each spring that was ``found``: its fit begins with all of that spring at once."""
    begun = [at_full_size(plant, f"{name}@{i}", slots, spring, next_id + i) for i, spring in enumerate(found)]
    return [replace(h, evident=spring.get("share", 0.0) >= SPRING_EVIDENT_SHARE) for h, spring in zip(begun, found, strict=True)]


def from_pulls(plant: Plant, name: str, slots: tuple[int, ...], found: Sequence[Mapping[str, float]], depth: float, next_id: int) -> list[Hypothesis]:
    """One hypothesis of a steady pull towards the point of each spring that was ``found``, as strong as that pulls on average, its components those at the
    log's origin at a ``depth`` (m): what has held the vehicle since before the log began has no onset, and may well be no spring."""
    pulling = [spring for spring in found if spring.get("pull", 0.0) > 0.0]
    values = [{**spring, **pull_towards(spring, spring["pull"], depth)} for spring in pulling]
    return [at_full_size(plant, f"{name}@held{i}", slots, one, next_id + i) for i, one in enumerate(values)]


def mid_log_spring(windows: Sequence[Windows], plant: Plant, slots: tuple[int, ...]) -> Spring:
    """A spring of typical stiffness towards where the vehicle was in the middle of the first log: what competes until `springs` are known."""
    first = plant.slots[slots[0]].parameter
    at = onset_and_anchor(windows, plant, slots, float(windows[0].start[len(windows[0].start) // 2]) * windows[0].run.dt)
    return {first.name: first.typical} | {plant.slots[slot].parameter.name: value for slot, value in at.items()}


def onset_and_anchor(windows: Sequence[Windows], plant: Plant, slots: tuple[int, ...], t: float) -> dict[int, float]:
    """Values of the slots that an onset at ``t`` (s since the first run's start) fixes: the onset, and where the vehicle was then."""
    run, found = windows[0].run, dict[int, float]()
    for slot in slots:
        parameter = plant.slots[slot].parameter
        if parameter.role == "onset":
            found[slot] = t
        elif parameter.role == "anchor":
            known = np.flatnonzero(run.ok(parameter.channel))
            found[slot] = float(np.interp(t / run.dt, known, run.get(parameter.channel)[known]))
    return found
