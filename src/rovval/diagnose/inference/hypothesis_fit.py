"""Confirm a hypothesis by re-simulation: settle its parameters with slop beside them, its evidence, its held-out losses.

The evidence is twice the log Bayes factor over nothing at all (Laplace): slop that a hypothesis needs beside it costs what its prior
says, so a hypothesis that leaves a coefficient eight sigma off does not win by letting slop do the work.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from rovval.core.data import Array
from rovval.diagnose.inference.cross_validation import Fold, losses
from rovval.diagnose.inference.laplace import Point, whole_evidence
from rovval.diagnose.inference.map_fit import FEW, moved, settle
from rovval.diagnose.inference.problem import Problem, gap_at
from rovval.diagnose.residuals.normal_equations import Scaled

INTERVAL = 0.90
ONSET_SEARCH_S = (-12.0, -6.0, -3.0, -1.5, 1.5, 3.0, 6.0, 12.0)


@dataclass(frozen=True, slots=True)
class Confirmed:
    """``beta`` (k,) the vehicle with the effects and no slop; ``point`` where effects and slop settled; ``evidence``; held-out losses per
    window (m,) about ``beta``: ``loss`` of dynamics and parity, ``dynamic_loss`` of the dynamics alone, as shrinkage is reported."""

    slots: tuple[int, ...]
    beta: Array
    point: Point
    evidence: float
    loss: Array
    dynamic_loss: Array
    at_bound: tuple[int, ...]

    def light(self) -> Confirmed:
        """The fit without its slopes, which are the bulk of it; it cannot be gone on from."""
        return replace(self, point=replace(self.point, scaled=()))


def confirm(problem: Problem, start: Array, slots: tuple[int, ...]) -> Confirmed:
    """Fit ``slots`` from ``start`` by re-simulation of all windows; score each fold with the parameters that the others give."""
    return _scored(problem, _onset_tuned(problem, settle(problem, start, slots), slots), slots)


def roughly(problem: Problem, start: Array, slots: tuple[int, ...], near: tuple[Scaled, ...]) -> Confirmed:
    """As `confirm`, quicker: slop's slopes from nearby, few rounds, an onset where it began."""
    return _scored(problem, settle(problem, start, slots, near, FEW), slots)


def _onset_tuned(problem: Problem, point: Point, slots: tuple[int, ...]) -> Point:
    """An onset moved along the log in shrinking steps, since windows before it carry no slope towards it; then all settled again."""
    onsets = [s for s in slots if problem.plant.slots[s].parameter.role == "onset"]
    best = point
    for slot in onsets:
        for shift in ONSET_SEARCH_S:
            trial = moved(problem, best, slot, max(best.beta[slot] + shift, problem.plant.slots[slot].parameter.low))
            if trial.profile() < best.profile():
                best = trial
    return point if best is point else settle(problem, best.beta, slots)


def _scored(problem: Problem, point: Point, slots: tuple[int, ...]) -> Confirmed:
    beta = problem.origin.copy()
    beta[list(slots)] = point.beta[list(slots)]
    bounds = [(problem.plant.slots[s].parameter.low, problem.plant.slots[s].parameter.high) for s in slots]
    resting = tuple(s for s, (low, high) in zip(slots, bounds, strict=True) if not low < beta[s] < high and (low, high) != (0.0, 1.0))
    found = whole_evidence(problem, point)
    fitted = Confirmed(slots, beta, point, found, problem.gap_data.c, problem.gap.c, resting)
    loss, dynamic_loss = _held_losses(problem, fitted)
    return replace(fitted, loss=loss, dynamic_loss=dynamic_loss)


def _held_losses(problem: Problem, fitted: Confirmed) -> tuple[Array, Array]:
    """Losses (m,) with and without the kinematic checks, each window scored with the parameters that other folds give."""
    dynamic, data = gap_at(problem, fitted.beta, fitted.slots)
    own, loss, dynamic_loss = np.arange(len(fitted.slots)), data.c.copy(), dynamic.c.copy()
    for fold, step in held_steps(problem, fitted):
        loss[fold.test] = losses(data, own, step, fold.test)
        dynamic_loss[fold.test] = losses(dynamic, own, step, fold.test)
    return loss, dynamic_loss


def held_steps(problem: Problem, fitted: Confirmed) -> list[tuple[Fold, Array]]:
    """Each fold with the step (k,) of the fitted slots that its training windows give, as its held-out losses are scored with."""
    slots = [problem.plant.slots[s].parameter.role for s in fitted.slots]
    moves = np.array([role != "onset" for role in slots], dtype=bool)  # no fold extrapolates an onset
    return [(fold, np.where(moves, fitted.point.step(fold.train)[: len(slots)], 0.0)) for fold in problem.folds]


def errors(problem: Problem, fitted: Confirmed, fixed: Sequence[int] = ()) -> Array:
    """Standard errors (k,) of the fitted slots that hold under autocorrelated residuals and calibration slop: the sandwich of the joint fit.

    Scores are summed over pairs of windows; where these are few, never less than the inflated covariance. The other coefficients are
    off by the declared slop, of which the joint fit takes out what the log shows. Slots that are ``fixed`` stand where they are: no error.
    """
    point, k = fitted.point, len(fitted.slots)
    free, bread = np.array([c not in fixed for c in point.columns]), np.zeros_like(point.curvature)
    bread[np.ix_(free, free)] = np.linalg.inv(point.curvature[np.ix_(free, free)])
    score = point.data.b - np.einsum("wij,j->wi", point.data.A, point.solved(point.curvature, point.slope))
    score -= score.mean(axis=0)  # not zero on a bound, which takes up the rest
    pairs = score[: len(score) // 2 * 2].reshape(-1, 2, len(bread)).sum(axis=1)
    half = bread[:k] @ pairs.T
    sandwich = (half**2).sum(axis=1) * (len(score) / max(2 * len(pairs), 1)) * len(pairs) / max(len(pairs) - k, 1)
    slop = problem.inflation * (bread[:k, k:] ** 2 @ point.precision[k:])
    return np.asarray(np.sqrt(np.maximum(sandwich + slop, problem.inflation * np.diag(bread)[:k])))


def significance(problem: Problem, fitted: Confirmed, slots: tuple[int, ...]) -> float:
    """Largest departure of ``slots`` from where the vehicle stands, in standard errors that include calibration slop. Parameters that only
    place an effect (an onset, a period) have no null of their own: they do not count, and stand where they are."""
    sized = [s for s in slots if not places(problem, s)]
    error = errors(problem, fitted, [s for s in slots if s not in sized])
    return max(float(abs(fitted.beta[s] - problem.origin[s]) / max(error[fitted.slots.index(s)], 1e-12)) for s in sized)


def places(problem: Problem, slot: int) -> bool:
    """Whether a parameter only places an effect, in time or in space."""
    return problem.plant.slots[slot].parameter.places


def interval(value: float, error: float, blocks: int) -> tuple[float, float]:
    """Two-sided interval at `INTERVAL` with Student's t on half as many degrees of freedom as windows."""
    t = float(stats.t.ppf(0.5 + INTERVAL / 2, max(blocks // 2 - 1, 2)))
    return value - t * error, value + t * error
