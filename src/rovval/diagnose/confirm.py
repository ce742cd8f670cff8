"""Confirm a hypothesis by re-simulation: Gauss-Newton on its parameters with slop beside them, its evidence, its held-out losses.

The evidence is twice the log Bayes factor over nothing at all (Laplace): slop that a hypothesis needs beside it costs what its prior
says, so a hypothesis that leaves a coefficient eight sigma off does not win by letting slop do the work.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from rovval.data import Array
from rovval.diagnose.contest import Fold, heldout, losses
from rovval.diagnose.library import PRIOR_WIDTH
from rovval.diagnose.problem import Problem, beside_slop
from rovval.diagnose.products import Products

ROUNDS = 6
CONVERGED = 0.02  # of a parameter's standard error
SHORTER = (1.0, 0.4, 0.1)  # shares of the Gauss-Newton step that are tried
NAMING_SLOP = 1.0  # share of the declared slop that stands beside a hypothesis while it is named (all of it: healthy logs of the tuning set ask for that)
INTERVAL = 0.90
PLACING = ("onset", "period", "phase", "direction", "height", "reach", "radius", "depth")
ONSET_SEARCH_S = (-12.0, -6.0, -3.0, -1.5, 1.5, 3.0, 6.0, 12.0)


@dataclass(frozen=True, slots=True)
class Point:
    """Products about a parameter point, the precision of every column and the distance of each from where its prior stands."""

    beta: Array
    dynamic: Products
    data: Products
    precision: Array
    offset: Array


@dataclass(frozen=True, slots=True)
class Confirmed:
    """``beta`` (k,) the fitted point with the products about it; ``evidence``; held-out losses per window (m,) with the effects and
    nothing beside them: ``loss`` of dynamics and parity, ``dynamic_loss`` of the dynamics alone, as shrinkage is reported."""

    slots: tuple[int, ...]
    beta: Array
    point: Point
    evidence: float
    loss: Array
    dynamic_loss: Array
    at_bound: tuple[int, ...]


def confirm(problem: Problem, start: Array, slots: tuple[int, ...]) -> Confirmed:
    """Fit ``slots`` from ``start`` by re-simulation of all windows; score each fold with the parameters that the others give."""
    point = _point(problem, start, slots)
    for _ in range(ROUNDS):
        better = _better(problem, point, slots)
        if better is None:
            break
        step = np.abs(better.beta[list(slots)] - point.beta[list(slots)])
        small = step < CONVERGED * _standard(problem, better)[: len(slots)]
        point = better
        if small.all():
            break
    return _scored(problem, _onset_tuned(problem, point, slots), slots)


def _point(problem: Problem, beta: Array, slots: tuple[int, ...]) -> Point:
    dynamic, data = beside_slop(problem, beta, slots)
    width = [PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in slots]
    width += [NAMING_SLOP * problem.slop.sd[s] for s in data.columns[len(slots) :]]
    offset = np.zeros(len(data.columns))
    offset[: len(slots)] = beta[list(slots)] - problem.origin[list(slots)]
    return Point(beta, dynamic, data, problem.inflation / np.array(width) ** 2, offset)


def _better(problem: Problem, point: Point, slots: tuple[int, ...]) -> Point | None:
    """The next point of a damped Gauss-Newton iteration, None where no step improves the penalised loss."""
    step, value = _step(point, np.ones(problem.blocks, dtype=bool)), _objective(point, len(slots))
    for share in SHORTER:
        trial = _point(problem, _clipped(problem, point.beta, slots, share * step[: len(slots)]), slots)
        if _objective(trial, len(slots)) < value:
            return trial
    return None


def _onset_tuned(problem: Problem, point: Point, slots: tuple[int, ...]) -> Point:
    """An onset moved along the log in shrinking steps, since windows before it carry no slope towards it."""
    for slot in (s for s in slots if problem.plant.slots[s].parameter.name == "onset"):
        for shift in ONSET_SEARCH_S:
            beta = point.beta.copy()
            beta[slot] = max(beta[slot] + shift, problem.plant.slots[slot].parameter.low)
            trial = _point(problem, beta, slots)
            if _objective(trial, len(slots)) < _objective(point, len(slots)):
                point = trial
    return point


def _scored(problem: Problem, point: Point, slots: tuple[int, ...]) -> Confirmed:
    own = np.arange(len(slots))
    fixed = np.array([problem.plant.slots[s].parameter.name == "onset" for s in slots], dtype=bool)  # no fold extrapolates an onset
    loss, dynamic_loss = np.empty(problem.blocks), np.empty(problem.blocks)
    for fold in problem.folds:
        step = _step(point, fold.train)
        step[own] = np.where(fixed, 0.0, step[own])
        loss[fold.test] = losses(point.data, own, step[own], fold.test)
        dynamic_loss[fold.test] = losses(point.dynamic, own, step[own], fold.test)
    bounds = [(problem.plant.slots[s].parameter.low, problem.plant.slots[s].parameter.high) for s in slots]
    resting = tuple(s for s, (low, high) in zip(slots, bounds, strict=True) if not low < point.beta[s] < high and (low, high) != (0.0, 1.0))
    evidence = float(evidence_of(problem, point, len(slots), np.ones((1, problem.blocks)))[0])
    return Confirmed(slots, point.beta, point, evidence, loss, dynamic_loss, resting)


def evidence_of(problem: Problem, point: Point, own: int, counts: Array) -> Array:
    """Evidence (d,) of a hypothesis with ``own`` parameters on windows weighted by ``counts`` (d, m), over the vehicle as it is."""
    found = np.empty(len(counts))
    k = len(point.data.columns)
    flat = point.data.A.reshape(len(point.data.A), -1)
    volume = -float(np.log(point.precision).sum())
    for i, count in enumerate(counts):
        H = (count @ flat).reshape(k, k) + np.diag(point.precision)
        b = count @ point.data.b
        own_offset = float((point.precision[:own] * point.offset[:own] ** 2).sum())
        relief = b[own:] @ np.linalg.solve(H[own:, own:], b[own:]) if k > own else 0.0
        loss = float(count @ point.data.c) + own_offset - float(relief)
        found[i] = (float(count @ problem.data.c) - loss) / problem.inflation - (np.linalg.slogdet(H)[1] + volume)
    return found


def errors(problem: Problem, fitted: Confirmed) -> Array:
    """Standard errors of the fitted slots that hold under autocorrelated residuals and calibration slop: a sandwich over pairs of
    windows, plus what slop of the other coefficients moves the estimate by."""
    k, data = len(fitted.slots), fitted.point.data
    width = np.array([PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in fitted.slots])
    A = data.A.sum(axis=0)
    bread = np.linalg.inv(A[:k, :k] + np.diag(problem.inflation / width**2))
    score = data.b[:, :k]
    pairs = score[: len(score) // 2 * 2].reshape(-1, 2, k).sum(axis=1)
    meat = pairs.T @ pairs * (len(score) / max(2 * len(pairs), 1))
    covariance = len(pairs) / max(len(pairs) - k, 1) * bread @ meat @ bread
    if len(data.columns) > k:
        lever = bread @ A[:k, k:] * np.array([problem.slop.sd[c] for c in data.columns[k:]])
        covariance = covariance + lever @ lever.T
    return np.asarray(np.sqrt(np.maximum(np.diag(covariance), 0.0)))


def significance(problem: Problem, fitted: Confirmed, slots: tuple[int, ...]) -> float:
    """Largest departure of ``slots`` from where the vehicle stands, in standard errors that include calibration slop. Parameters that only
    place an effect (an onset, a period) have no null of their own and do not count."""
    error = errors(problem, fitted)
    sized = [s for s in slots if problem.plant.slots[s].parameter.name not in PLACING]
    return max(float(abs(fitted.beta[s] - problem.origin[s]) / max(error[fitted.slots.index(s)], 1e-12)) for s in sized)


def interval(value: float, error: float, blocks: int) -> tuple[float, float]:
    """Two-sided interval at `INTERVAL` with Student's t on half as many degrees of freedom as windows."""
    t = float(stats.t.ppf(0.5 + INTERVAL / 2, max(blocks // 2 - 1, 2)))
    return value - t * error, value + t * error


def slop_loss(problem: Problem, beta: Array) -> Array:
    """Held-out loss (m,) of the dynamics about ``beta`` with the whole declared slop free."""
    dynamic = beside_slop(problem, beta, ())[0] if (beta != problem.origin).any() else problem.dynamic
    return heldout(dynamic, problem.folds, problem.slop, problem.inflation)


def _step(point: Point, which: np.ndarray) -> Array:
    A = point.data.A[which].sum(axis=0) + np.diag(point.precision)
    return np.asarray(np.linalg.solve(A, point.data.b[which].sum(axis=0) - point.precision * point.offset))


def _standard(problem: Problem, point: Point) -> Array:
    return np.asarray(np.sqrt(problem.inflation * np.diag(np.linalg.inv(point.data.A.sum(axis=0) + np.diag(point.precision)))))


def _objective(point: Point, own: int) -> float:
    """Loss plus prior at the point, slop at its best."""
    A, b = point.data.A.sum(axis=0)[own:, own:], point.data.b.sum(axis=0)[own:]
    relief = float(b @ np.linalg.solve(A + np.diag(point.precision[own:]), b)) if len(b) else 0.0
    return float(point.data.c.sum()) - relief + float((point.precision[:own] * point.offset[:own] ** 2).sum())


def _clipped(problem: Problem, beta: Array, slots: tuple[int, ...], step: Array) -> Array:
    """The step, stopped at the parameters' bounds (a parameter that rests there is reported as such)."""
    trial = beta.copy()
    for slot, part in zip(slots, step, strict=True):
        parameter = problem.plant.slots[slot].parameter
        trial[slot] = min(max(beta[slot] + part, parameter.low), parameter.high)
    return trial


def held_steps(problem: Problem, fitted: Confirmed) -> list[tuple[Fold, Array]]:
    """Each fold with the step (k,) of the fitted slots that its training windows give, as its held-out losses are scored with."""
    slots = [problem.plant.slots[s].parameter.name for s in fitted.slots]
    moves = np.array([name != "onset" for name in slots])  # no fold extrapolates an onset
    return [(fold, np.where(moves, _step(fitted.point, fold.train)[: len(slots)], 0.0)) for fold in problem.folds]
