"""Confirm a hypothesis by re-simulation: Gauss-Newton on its parameters, then held-out losses about the solution."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from rovval.data import Array
from rovval.diagnose.library import PRIOR_WIDTH
from rovval.diagnose.problem import Problem, at
from rovval.diagnose.products import Products

ROUNDS = 6
CONVERGED = 0.01  # of a parameter's standard error
INTERVAL = 0.90


@dataclass(frozen=True, slots=True)
class Confirmed:
    """``beta`` (k,) the fitted point; held-out loss per window (m,) with parity and of the dynamics alone; standard error of
    ``slots``; slots that rest on a bound."""

    slots: tuple[int, ...]
    beta: Array
    loss: Array
    dynamic_loss: Array
    error: Array
    at_bound: tuple[int, ...]


def confirm(problem: Problem, start: Array, slots: tuple[int, ...]) -> Confirmed:
    """Fit ``slots`` from ``start`` by re-simulation of all windows; score each fold with the parameters that the others give."""
    beta, data = start.copy(), at(problem, start, slots)[1]
    prior = _precision(problem, slots)
    null = problem.origin[list(slots)]
    best = _penalised(data, prior, beta[list(slots)] - null)
    for _ in range(ROUNDS):
        step = _step(data, prior, beta[list(slots)] - null, np.ones(problem.blocks, dtype=bool))
        moved = False
        for shorter in (1.0, 0.5, 0.25, 0.1):
            trial = _clipped(problem, beta, slots, shorter * step)
            there = at(problem, trial, slots)[1]
            value = _penalised(there, prior, trial[list(slots)] - null)
            if value < best:
                small = np.abs(trial[list(slots)] - beta[list(slots)]) < CONVERGED * _standard(data, prior)
                beta, data, best, moved = trial, there, value, not small.all()
                break
        if not moved:
            break
    return _scored(problem, beta, slots, prior)


def _scored(problem: Problem, beta: Array, slots: tuple[int, ...], prior: Array) -> Confirmed:
    slop = tuple(s for s in problem.slop.sd if s not in slots)
    dynamic, data = at(problem, beta, (*slots, *slop))
    free = np.arange(len(slots))
    offset = beta[list(slots)] - problem.origin[list(slots)]
    loss, dynamic_loss = np.empty(problem.blocks), np.empty(problem.blocks)
    for fold in problem.folds:
        step = _step(data, prior, offset, fold.train, free)
        loss[fold.test] = _loss(data, free, step, fold.test)
        dynamic_loss[fold.test] = _loss(dynamic, free, step, fold.test)
    bounds = [(problem.plant.slots[s].parameter.low, problem.plant.slots[s].parameter.high) for s in slots]
    resting = tuple(s for s, (low, high) in zip(slots, bounds, strict=True) if beta[s] <= low or beta[s] >= high)
    return Confirmed(slots, beta, loss, dynamic_loss, _errors(problem, data, free, prior), resting)


def _errors(problem: Problem, data: Products, free: np.ndarray, prior: Array) -> Array:
    """Standard errors that hold under autocorrelated residuals and calibration slop: sandwich over pairs of windows, plus what
    slop of the other coefficients moves the estimate by."""
    A = data.A[:, free[:, None], free[None, :]].sum(axis=0)
    bread = np.linalg.inv(A + np.diag(prior))
    score = data.b[:, free]
    pairs = score[: len(score) // 2 * 2].reshape(-1, 2, len(free)).sum(axis=1)
    meat = pairs.T @ pairs * (len(score) / max(2 * len(pairs), 1))
    factor = len(pairs) / max(len(pairs) - len(free), 1)
    covariance = factor * bread @ meat @ bread
    other = np.arange(len(free), data.A.shape[1])
    if len(other):
        sd = np.array([problem.slop.sd[data.columns[i]] for i in other])
        lever = bread @ data.A[:, free[:, None], other[None, :]].sum(axis=0) * sd
        covariance += lever @ lever.T
    return np.asarray(np.sqrt(np.maximum(np.diag(covariance), 0.0)))


def interval(value: float, error: float, blocks: int) -> tuple[float, float]:
    """Two-sided interval at `INTERVAL` with Student's t on half as many degrees of freedom as windows."""
    t = float(stats.t.ppf(0.5 + INTERVAL / 2, max(blocks // 2 - 1, 2)))
    return value - t * error, value + t * error


def _precision(problem: Problem, slots: tuple[int, ...]) -> Array:
    typical = np.array([problem.plant.slots[s].parameter.typical for s in slots])
    return np.asarray(problem.inflation / (PRIOR_WIDTH * typical) ** 2)


def _step(data: Products, prior: Array, offset: Array, which: np.ndarray, free: np.ndarray | None = None) -> Array:
    free = np.arange(len(prior)) if free is None else free
    A = data.A[which][:, free[:, None], free[None, :]].sum(axis=0) + np.diag(prior)
    return np.asarray(np.linalg.solve(A, data.b[which][:, free].sum(axis=0) - prior * offset))


def _standard(data: Products, prior: Array) -> Array:
    return np.asarray(np.sqrt(np.diag(np.linalg.inv(data.A.sum(axis=0) + np.diag(prior)))))


def _loss(data: Products, free: np.ndarray, step: Array, which: np.ndarray) -> Array:
    A, b = data.A[which][:, free[:, None], free[None, :]], data.b[which][:, free]
    return np.asarray(data.c[which] - 2 * b @ step + np.einsum("i,wij,j->w", step, A, step))


def _penalised(data: Products, prior: Array, offset: Array) -> float:
    return float(data.c.sum() + (prior * offset**2).sum())


def _clipped(problem: Problem, beta: Array, slots: tuple[int, ...], step: Array) -> Array:
    """The step, stopped at the parameters' bounds (a parameter that rests there is reported as such)."""
    trial = beta.copy()
    for slot, part in zip(slots, step, strict=True):
        parameter = problem.plant.slots[slot].parameter
        trial[slot] = min(max(beta[slot] + part, parameter.low), parameter.high)
    return trial
