"""What an engine that knows the true effects would close: the true hypotheses fitted to the whole log by re-simulation.

The loss is taken at the fitted point and not on held-out windows: an oracle knows the number of parameters, one to six against some
hundred independent samples, and an onset cannot be held out (the window that shows it is the only one that does).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rovval import effects
from rovval.blind.plant.spec import Array
from rovval.core.data import Run
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.library import hypotheses, initialised
from rovval.diagnose.hypotheses.snag import onset_and_anchor
from rovval.diagnose.inference.hypothesis_fit import fit_hypothesis
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.problem.problem import Problem, equations_at, gap_equations_at, pose
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.search.candidates import start_of
from rovval.diagnose.search.onset import windows_from
from rovval.diagnose.windows.multiple_shooting import cut_run
from rovval.vehicle.model import Vehicle

Wanted = Sequence[Sequence[Hypothesis]]  # of each true effect its starting points
STARTS = 3  # starting points tried, the best by linear gain first


def oracle(
    log: Path, vehicle: str, true: Sequence[str], onsets: Mapping[str, float], asked: Mapping[str, Any]
) -> dict[str, float]:
    """Shares that the hypotheses ``true`` close: ``dynamic`` of the log's gap, ``seen`` the larger of that and of the gap with the
    kinematic checks, where faults of sensors show; ``sure`` is the root of the fall of twice the log likelihood, its standard errors; of
    several, ``each`` is the least that one of them closes of what the others leave, fitted without it. Empty where
    the library has none of them or no window is usable."""
    from rovval.blind.sealed.answer import PROFILE
    from rovval.core.errors import RovvalError
    from rovval.storage.archive import open_run
    from rovval.vehicle import load as load_vehicle

    try:
        found = _fit(open_run(log, PROFILE), load_vehicle(vehicle), true, onsets, **asked)
        if found is None:
            return {}
        problem, healthy, wanted, beta = found
        left = _left(problem, wanted, beta)
        gaps = np.array([problem.gap.dynamics.c.sum(), problem.gap.total.c.sum()])
        shares = 1.0 - left / gaps
        sure = float(np.sqrt(max(0.0, float((gaps - left).max())) / problem.design_effect))
        alone = [_left(problem, others, _fitted(problem, healthy, others, onsets)) for others in _others(wanted)]
    except (RovvalError, ArithmeticError, ValueError):
        return {}
    each = {"each": min(float((1.0 - left / without).max()) for without in alone)} if alone else {}
    return {"dynamic": float(shares[0]), "seen": float(shares.max()), "sure": sure, **each}


def fitted(run: Run, vehicle: Vehicle, true: Sequence[str], onsets: Mapping[str, float]) -> dict[str, float]:
    """The oracle's parameters, ``thruster_degraded[HFP].loss`` and the like; empty where the library has none of the effects."""
    found = _fit(run, vehicle, true, onsets)
    if found is None:
        return {}
    problem, _, wanted, beta = found
    return {problem.plant.slots[s].key: float(beta[s]) for s in _slots(wanted)}


def _fit(
    run: Run,
    vehicle: Vehicle,
    true: Sequence[str],
    onsets: Mapping[str, float],
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
) -> tuple[Problem, Posterior, Wanted, Array] | None:
    """The problem, the healthy vehicle, the hypotheses that were free, and the fitted point."""
    part = cut_run(run, vehicle, model, window_s)
    begins = [onsets[name] for name in true if name in onsets and not effects.load(name.partition("[")[0]).begins]  # no onset of their own
    part = windows_from(part, max(begins)) if begins else part
    library, _ = hypotheses((part,))
    if not true or not set(true) <= {h.name for h in library}:
        return None
    problem = pose((part,), columns_of(library), calibration_slop)
    healthy = healthy_fit(problem)
    wanted = [[h for h in initialised(problem, library, healthy) if h.name == name] for name in true]
    return problem, healthy, wanted, _fitted(problem, healthy, wanted, onsets)


def _fitted(problem: Problem, healthy: Posterior, wanted: Wanted, onsets: Mapping[str, float]) -> Array:
    """The best of the fits from several starting points, kinematic checks counted."""
    free = [h for starts in wanted for h in starts]
    asked = columns_of(free)
    data = equations_at(problem, healthy.beta, asked.slots, asked.displaced)
    ranks = range(min(STARTS, max(map(len, wanted))))
    tried = [fit_hypothesis(problem, _from(problem, healthy, data, wanted, rank, onsets), _slots(wanted)).beta for rank in ranks]
    return min(tried, key=lambda beta: _left(problem, wanted, beta)[1])


def _left(problem: Problem, wanted: Wanted, beta: Array) -> Array:
    """Losses (2,) of the dynamics, and of those with the kinematic checks."""
    return np.array([float(products.c.sum()) for products in gap_equations_at(problem, beta, _slots(wanted))])


def _others(wanted: Wanted) -> list[Wanted]:
    """The hypotheses without each of them in turn; nothing where there is but one."""
    return [[*wanted[:i], *wanted[i + 1 :]] for i in range(len(wanted))] if len(wanted) > 1 else []


def _slots(wanted: Wanted) -> tuple[int, ...]:
    return tuple(dict.fromkeys(s for starts in wanted for h in starts for s in h.slots))


def _from(problem: Problem, healthy: Posterior, data: NormalEquations, wanted: Wanted, rank: int, onsets: Mapping[str, float]) -> Array:
    """Each hypothesis's start of that rank by linear gain (its last, where it has fewer), where slop settles by itself; the true onset where
    there is one."""
    beta = healthy.beta.copy()
    beta[list(_slots(wanted))] = problem.origin[list(_slots(wanted))]
    for starts in wanted:
        ordered = sorted(starts, key=lambda h: -_step(problem, data, h)[1])
        best = ordered[min(rank, len(ordered) - 1)]
        moves = np.zeros(len(data.columns))
        moves[data.place(best.columns)] = _step(problem, data, best)[0]
        beta = start_of(problem, data, best, moves, beta, best.slots)
        if best.name in onsets:
            place = onset_and_anchor(problem.runs, problem.plant, best.slots, onsets[best.name])
            beta[list(place)] = list(place.values())
    return beta


def _step(problem: Problem, data: NormalEquations, h: Hypothesis) -> tuple[Array, float]:
    i = data.place(h.columns)
    A, b = data.A.sum(axis=0)[np.ix_(i, i)], data.b.sum(axis=0)[i]
    step = np.linalg.solve(A + np.diag(problem.design_effect / np.array(h.sd) ** 2), b)
    return step, float(b @ step)
