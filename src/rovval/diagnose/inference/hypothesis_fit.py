"""The fit of a hypothesis by re-simulation, jointly with coefficients within tolerance: parameters, evidence, held-out losses, standard errors.

The evidence is twice the log Bayes factor over the vehicle as its file has it, by Laplace's approximation (Kass and Raftery 1995). A departure of
coefficients that a hypothesis needs beside it costs what its prior says, so that none wins by letting the coefficients do the work.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from rovval.core.data import Array
from rovval.diagnose.criteria import INTERVAL_PROBABILITY
from rovval.diagnose.effort import ONSET_SHIFTS_S, QUICK_STEPS
from rovval.diagnose.inference.gap import errors_by_part
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence
from rovval.diagnose.inference.map_fit import effects_alone, map_fit, moved_to
from rovval.diagnose.problem.cross_validation import Fold
from rovval.diagnose.problem.problem import Problem, corrected_of, gap_equations_of
from rovval.diagnose.residuals.normal_equations import Linearisation, Whitened
from rovval.diagnose.residuals.perturbations import STEP_NEAR
from rovval.diagnose.residuals.ridge import losses
from rovval.diagnose.residuals.sensitivities import linearise


@dataclass(frozen=True, slots=True)
class HypothesisFit:
    """A hypothesis fitted to all windows, and scored on held-out ones.

    Attributes:
        slots: its parameters.
        beta: parameters (p,) of the plant with the fitted slots as they are where all others are as the vehicle's file has them (`effects_alone`).
        posterior: the joint fit of the slots and of coefficients within tolerance.
        evidence: twice the log Bayes factor over the vehicle as its file has it.
        loss: weighted squared residuals (m,) of each window about ``beta``, held out, in the metric of the gap: dynamics and parity.
        dynamics_loss: the same (m,) of the dynamics alone, of which the reduction of the gap is stated.
        parts: the same summed over windows, of each axis, initial states at their best, and of each parity relation about ``beta`` (`gap.errors_by_part`).
        at_bound: those of the slots that rest at a bound.
    """

    slots: tuple[int, ...]
    beta: Array
    posterior: Posterior
    evidence: float
    loss: Array
    dynamics_loss: Array
    parts: Mapping[str, float]
    at_bound: tuple[int, ...]

    def without_sensitivities(self) -> HypothesisFit:
        """The fit without its linearisation, which is the bulk of its memory; no further fit can begin from it."""
        return replace(self, posterior=replace(self.posterior, whitened=()))


def fit_hypothesis(problem: Problem, start: Array, slots: tuple[int, ...]) -> HypothesisFit:
    """Fit ``slots`` from ``start`` (p,) by re-simulation of all windows, and score each fold with the parameters that the others give."""
    return _scored(problem, _with_onset_searched(problem, map_fit(problem, start, slots), slots), slots)


def fit_quickly(problem: Problem, start: Array, slots: tuple[int, ...], near: tuple[Whitened, ...]) -> HypothesisFit:
    """As `fit_hypothesis`, in fewer steps (`QUICK_STEPS`): sensitivities to coefficients within tolerance are those of ``near``, and no onset is searched."""
    return _scored(problem, map_fit(problem, start, slots, near, QUICK_STEPS), slots)


def _with_onset_searched(problem: Problem, point: Posterior, slots: tuple[int, ...]) -> Posterior:
    """The posterior with onsets searched along the log, to which windows before them have no sensitivity; all else is then fitted again, and stays as it was
    where that ends no better."""
    onsets = [s for s in slots if problem.plant.slots[s].parameter.role == "onset"]
    best = point
    for slot in onsets:
        for shift in ONSET_SHIFTS_S:
            trial = moved_to(problem, best, slot, max(best.beta[slot] + shift, problem.plant.slots[slot].parameter.low))
            if trial.predicted_cost() < best.predicted_cost():
                best = trial
    return point if best is point else min(point, map_fit(problem, best.beta, slots), key=Posterior.cost)


def _scored(problem: Problem, point: Posterior, slots: tuple[int, ...]) -> HypothesisFit:
    """The fit of which ``point`` is the posterior, with its evidence and held-out losses."""
    bounds = [(problem.plant.slots[s].parameter.low, problem.plant.slots[s].parameter.high) for s in slots]
    at_bound = tuple(s for s, (low, high) in zip(slots, bounds, strict=True) if not low < point.beta[s] < high and (low, high) != (0.0, 1.0))
    found = laplace_evidence(problem, point)
    return _held_out(problem, HypothesisFit(slots, effects_alone(problem, point), point, found, problem.gap.total.c, problem.gap.dynamics.c, {}, at_bound))


def _held_out(problem: Problem, fitted: HypothesisFit) -> HypothesisFit:
    """The fit with its held-out losses."""
    linear = linearised_in_effects(problem, fitted)
    dynamic, data = gap_equations_of(problem, fitted.beta, linear)
    own, loss, dynamic_loss = np.arange(len(fitted.slots)), data.c.copy(), dynamic.c.copy()
    for fold, step in held_out_steps(problem, fitted):
        loss[fold.test] = losses(data, own, step, fold.test)
        dynamic_loss[fold.test] = losses(dynamic, own, step, fold.test)
    moved = held_out_linearisations(problem, fitted, linear)
    return replace(fitted, loss=loss, dynamics_loss=dynamic_loss, parts=errors_by_part(problem, corrected_of(problem, moved), fitted.beta))


def linearised_in_effects(problem: Problem, fitted: HypothesisFit) -> list[Linearisation]:
    """The linearisation of each run in the fitted slots about the fitted point, by small differences (`STEP_NEAR`)."""
    return [linearise(windows, fitted.beta, fitted.slots, share=STEP_NEAR) for windows in problem.runs]


def held_out_linearisations(problem: Problem, fitted: HypothesisFit, linear: Sequence[Linearisation]) -> list[Linearisation]:
    """The linearisation ``linear`` of each run about the fitted point, its residual moved to what the folds without the window give."""
    step = np.zeros((problem.window_count, len(fitted.slots)))
    for fold, own in held_out_steps(problem, fitted):
        step[fold.test] = own
    ends = np.cumsum([windows.count for windows in problem.runs])[:-1]
    return [
        replace(one, r=np.where(windows.ok, one.r - np.einsum("wtck,wk->wtc", one.S, own), 0.0))
        for windows, one, own in zip(problem.runs, linear, np.split(step, ends), strict=True)
    ]


def held_out_steps(problem: Problem, fitted: HypothesisFit) -> list[tuple[Fold, Array]]:
    """Each fold with the step (k,) of the fitted slots that its training windows ask for; its held-out windows are scored with that."""
    slots = [problem.plant.slots[s].parameter.role for s in fitted.slots]
    moves = np.array([role != "onset" for role in slots], dtype=bool)  # no fold extrapolates an onset
    given = fitted.posterior.effects_given_others()
    return [(fold, np.where(moves, given @ fitted.posterior.step(fold.train), 0.0)) for fold in problem.folds]


def standard_errors(problem: Problem, fitted: HypothesisFit, fixed: Sequence[int] = ()) -> Array:
    """Standard errors (k,) of the fitted slots under autocorrelated residuals and coefficients within tolerance, in the parameters' units.

    The sandwich covariance of the joint fit (White 1982), with scores summed over pairs of neighbouring windows, and the posterior covariance of the
    other coefficients. Of few windows it may be too small by chance: the interval that it gives (`confidence_interval`) is never shorter than the normal one of
    the linearised fit's covariance times the design effect. Slots that are ``fixed`` have no error.
    """
    point, k = fitted.posterior, len(fitted.slots)
    free, bread = np.array([c not in fixed for c in point.columns]), np.zeros_like(point.curvature)
    bread[np.ix_(free, free)] = np.linalg.inv(point.curvature[np.ix_(free, free)])
    given = point.effects_given_others()
    own, score = given @ bread, point.total.b - np.einsum("wij,j->wi", point.total.A, point.solve(point.curvature, point.descent))
    sandwich = sandwich_variance(own, score - score.mean(axis=0))  # the mean is not zero on a bound, which takes up the rest
    by_tolerance = problem.tempering * np.einsum("ij,jl,il->i", own[:, k:], point.precision[k:, k:], own[:, k:])
    normal = float(stats.norm.ppf(0.5 + INTERVAL_PROBABILITY / 2)) / _quantile(problem.window_count)
    known = problem.design_effect * np.diag(own @ given.T) * normal**2
    return np.asarray(np.sqrt(np.maximum(sandwich + by_tolerance, known)))


def sandwich_variance(bread: Array, score: Array) -> Array:
    """Variances (k,) of estimates by the sandwich formula (White 1982): ``bread`` (k, p), rows of the inverse curvature; ``score`` (m, p) of each window,
    summed over pairs of neighbours."""
    pairs = score[: len(score) // 2 * 2].reshape(-1, 2, score.shape[1]).sum(axis=1)
    of_pairs = ((bread @ pairs.T) ** 2).sum(axis=1) * (len(score) / max(2 * len(pairs), 1))
    return np.asarray(of_pairs * len(pairs) / max(len(pairs) - len(bread), 1))


def only_places(problem: Problem, slot: int) -> bool:
    """Whether a parameter only places an effect, in time or in space."""
    return problem.plant.slots[slot].parameter.places


def confidence_interval(value: float, error: float, blocks: int) -> tuple[float, float]:
    """Two-sided interval of `INTERVAL_PROBABILITY` about ``value``, of standard error ``error``: Student's t with a degree of freedom
    for two of ``blocks`` windows."""
    return value - _quantile(blocks) * error, value + _quantile(blocks) * error


def _quantile(blocks: int) -> float:
    """Standard errors in half of an interval, where so many windows say how large they are."""
    return float(stats.t.ppf(0.5 + INTERVAL_PROBABILITY / 2, max(blocks // 2 - 1, 2)))
