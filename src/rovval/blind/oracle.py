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

STARTS = 3  # starting points tried, the best by linear gain first


def oracle(
    log: Path, vehicle: str, true: Sequence[str], onsets: Mapping[str, float], asked: Mapping[str, Any]
) -> dict[str, float]:
    """Shares that the hypotheses ``true`` close: ``dynamic`` of the log's gap, ``seen`` the larger of that and of the gap with the
    kinematic checks, where faults of sensors show. Empty where the library has none of them or no window is usable."""
    from rovval import store
    from rovval import vehicle as vehicles
    from rovval.blind.answer import PROFILE
    from rovval.errors import RovvalError

    try:
        found = _fit(store.open_run(log, PROFILE), vehicles.load(vehicle), true, onsets, **asked)
        if found is None:
            return {}
        problem, beta, slots = found
        dynamic, data = gap_at(problem, beta, slots)
    except (RovvalError, ArithmeticError, ValueError):
        return {}
    shares = [
        float(1.0 - after.c.sum() / before.c.sum()) for after, before in ((dynamic, problem.gap), (data, problem.gap_data))
    ]
    return {"dynamic": shares[0], "seen": max(shares)}


def fitted(run: Run, vehicle: Vehicle, true: Sequence[str], onsets: Mapping[str, float]) -> dict[str, float]:
    """The oracle's parameters, ``thruster_degraded[HFP].loss`` and the like; empty where the library has none of the effects."""
    found = _fit(run, vehicle, true, onsets)
    if found is None:
        return {}
    problem, beta, slots = found
    return {problem.plant.slots[s].key: float(beta[s]) for s in slots}


def _fit(
    run: Run,
    vehicle: Vehicle,
    true: Sequence[str],
    onsets: Mapping[str, float],
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
) -> tuple[Problem, Array, tuple[int, ...]] | None:
    """The problem, the fitted point and the slots that were free."""
    part = cut(run, vehicle, model, window_s)
    library, _ = hypotheses((part,))
    wanted = [[h for h in library if h.name == name] for name in true]
    if not wanted or not all(wanted):
        return None
    problem = pose((part,), library, calibration_slop)
    slots = tuple(dict.fromkeys(s for starts in wanted for s in starts[0].slots))
    tried = [_from(problem, wanted, rank, onsets, slots) for rank in range(min(STARTS, max(map(len, wanted))))]
    return problem, min(tried, key=lambda beta: float(gap_at(problem, beta, slots)[1].c.sum())), slots


def _from(
    problem: Problem, wanted: Sequence[Sequence[Hypothesis]], rank: int, onsets: Mapping[str, float], slots: tuple[int, ...]
) -> Array:
    """Fitted point from each hypothesis's start of that rank by linear gain (its last, where it has fewer)."""
    beta = problem.origin.copy()
    for starts in wanted:
        ordered = sorted(starts, key=lambda h: -_step(problem, h)[1])
        _begin(problem, ordered[min(rank, len(ordered) - 1)], beta, onsets.get(starts[0].name))
    return confirm(problem, beta, slots).beta


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
