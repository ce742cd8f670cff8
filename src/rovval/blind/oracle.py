"""What an engine that knows the true effects would close: the true hypotheses fitted to the log by re-simulation, on held-out windows."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rovval.blind.spec import Array
from rovval.diagnose.confirm import confirm
from rovval.diagnose.library import Hypothesis, hypotheses
from rovval.diagnose.problem import Problem, pose
from rovval.diagnose.stretches import cut


def oracle(log: Path, vehicle: str, true: Sequence[str], onsets: dict[str, float], asked: dict[str, Any]) -> dict[str, float]:
    """Shares that the hypotheses ``true`` close: ``dynamic`` of the log's gap, ``seen`` the larger of that and of the gap with the
    kinematic checks, where faults of sensors show. Empty where the library has none of them or no window is usable."""
    from rovval import store
    from rovval import vehicle as vehicles
    from rovval.blind.answer import PROFILE
    from rovval.errors import RovvalError

    try:
        part = cut(store.open_run(log, PROFILE), vehicles.load(vehicle), asked["model"], asked["window_s"])
        library, _ = hypotheses((part,))
        wanted = [[h for h in library if h.name == name] for name in true]
        if not all(wanted) or not wanted:
            return {}
        problem = pose((part,), library, asked["calibration_slop"])
        beta = problem.origin.copy()
        for starts in wanted:
            _begin(problem, starts, beta, onsets.get(starts[0].name))
        slots = tuple(dict.fromkeys(s for starts in wanted for s in starts[0].slots))
        fitted = confirm(problem, beta, slots)
    except (RovvalError, ArithmeticError, ValueError):
        return {}
    dynamic = float(1.0 - fitted.dynamic_loss.sum() / problem.dynamic.c.sum())
    return {"dynamic": dynamic, "seen": max(dynamic, float(1.0 - fitted.loss.sum() / problem.data.c.sum()))}


def _begin(problem: Problem, starts: Sequence[Hypothesis], beta: Array, onset: float | None) -> None:
    """Move ``beta`` to the best starting point of a hypothesis and one linear step from there; the true onset where there is one."""
    gains = [_step(problem, h)[1] for h in starts]
    best = starts[int(np.argmax(gains))]
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
