"""What an engine that knows the true effects would close: the true hypotheses fitted to the whole log by re-simulation.

The loss is taken at the fitted point and not on held-out windows: an oracle knows the number of parameters, one to six against some
hundred independent samples, and an onset cannot be held out (the window that shows it is the only one that does).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rovval.blind.spec import Array
from rovval.data import Run
from rovval.diagnose.confirm import confirm
from rovval.diagnose.library import Hypothesis, hypotheses
from rovval.diagnose.problem import Problem, gap_at, pose
from rovval.diagnose.stretches import cut
from rovval.vehicle.model import Vehicle

Wanted = Sequence[Sequence[Hypothesis]]  # of each true effect its starting points
STARTS = 3  # starting points tried, the best by linear gain first


def oracle(
    log: Path, vehicle: str, true: Sequence[str], onsets: Mapping[str, float], asked: Mapping[str, Any]
) -> dict[str, float]:
    """Shares that the hypotheses ``true`` close: ``dynamic`` of the log's gap, ``seen`` the larger of that and of the gap with the
    kinematic checks, where faults of sensors show; of several, ``each`` is the least that one of them closes of what the others leave,
    fitted without it. Empty where the library has none of them or no window is usable."""
    from rovval import store
    from rovval import vehicle as vehicles
    from rovval.blind.answer import PROFILE
    from rovval.errors import RovvalError

    try:
        found = _fit(store.open_run(log, PROFILE), vehicles.load(vehicle), true, onsets, **asked)
        if found is None:
            return {}
        problem, wanted, beta = found
        left = _left(problem, wanted, beta)
        shares = 1.0 - left / np.array([problem.gap.c.sum(), problem.gap_data.c.sum()])
        alone = [_left(problem, others, _fitted(problem, others, onsets)) for others in _others(wanted)]
    except (RovvalError, ArithmeticError, ValueError):
        return {}
    each = {"each": min(float((1.0 - left / without).max()) for without in alone)} if alone else {}
    return {"dynamic": float(shares[0]), "seen": float(shares.max()), **each}


def fitted(run: Run, vehicle: Vehicle, true: Sequence[str], onsets: Mapping[str, float]) -> dict[str, float]:
    """The oracle's parameters, ``thruster_degraded[HFP].loss`` and the like; empty where the library has none of the effects."""
    found = _fit(run, vehicle, true, onsets)
    if found is None:
        return {}
    problem, wanted, beta = found
    return {problem.plant.slots[s].key: float(beta[s]) for s in _slots(wanted)}


def _fit(
    run: Run,
    vehicle: Vehicle,
    true: Sequence[str],
    onsets: Mapping[str, float],
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
) -> tuple[Problem, Wanted, Array] | None:
    """The problem, the hypotheses that were free, and the fitted point."""
    part = cut(run, vehicle, model, window_s)
    library, _ = hypotheses((part,))
    wanted = [[h for h in library if h.name == name] for name in true]
    if not wanted or not all(wanted):
        return None
    problem = pose((part,), library, calibration_slop)
    return problem, wanted, _fitted(problem, wanted, onsets)


def _fitted(problem: Problem, wanted: Wanted, onsets: Mapping[str, float]) -> Array:
    """The best of the fits from several starting points, kinematic checks counted."""
    tried = [_from(problem, wanted, rank, onsets) for rank in range(min(STARTS, max(map(len, wanted))))]
    return min(tried, key=lambda beta: _left(problem, wanted, beta)[1])


def _left(problem: Problem, wanted: Wanted, beta: Array) -> Array:
    """Losses (2,) of the dynamics, and of those with the kinematic checks."""
    return np.array([float(products.c.sum()) for products in gap_at(problem, beta, _slots(wanted))])


def _others(wanted: Wanted) -> list[Wanted]:
    """The hypotheses without each of them in turn; nothing where there is but one."""
    return [[*wanted[:i], *wanted[i + 1 :]] for i in range(len(wanted))] if len(wanted) > 1 else []


def _slots(wanted: Wanted) -> tuple[int, ...]:
    return tuple(dict.fromkeys(s for starts in wanted for s in starts[0].slots))


def _from(problem: Problem, wanted: Wanted, rank: int, onsets: Mapping[str, float]) -> Array:
    """Fitted point from each hypothesis's start of that rank by linear gain (its last, where it has fewer)."""
    beta = problem.origin.copy()
    for starts in wanted:
        ordered = sorted(starts, key=lambda h: -_step(problem, h)[1])
        _begin(problem, ordered[min(rank, len(ordered) - 1)], beta, onsets.get(starts[0].name))
    return confirm(problem, beta, _slots(wanted)).beta


def _begin(problem: Problem, best: Hypothesis, beta: Array, onset: float | None) -> None:
    """Move ``beta`` to a starting point of a hypothesis and one linear step from there; the true onset where there is one."""
    for slot, value in best.at:
        beta[slot] = value
    free = [d.slot for d in best.directions] or list(best.columns)
    for slot, move in zip(free, _step(problem, best)[0], strict=True):
        if slot >= 0:
            p = problem.plant.slots[slot].parameter
            beta[slot] = float(np.clip(beta[slot] + move, p.low, p.high))
    for slot in best.slots:
        if onset is not None and problem.plant.slots[slot].parameter.name == "onset":
            beta[slot] = onset


def _step(problem: Problem, h: Hypothesis) -> tuple[Array, float]:
    i = problem.data.place(h.columns)
    A, b = problem.data.A.sum(axis=0)[np.ix_(i, i)], problem.data.b.sum(axis=0)[i]
    step = np.linalg.solve(A + np.diag(problem.inflation / np.array(h.sd) ** 2), b)
    return step, float(b @ step)
