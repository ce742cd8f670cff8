"""What each of several runs by itself says of a number that all of them share, and whether the runs contradict one another.

In the linearisation about the joint fit. What is the vehicle's stays where all runs together have it; the causes, and what is each run's own within its
tolerance (how sensors were mounted and aligned that day), move with the run.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import stats

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.criteria import PARAMETER_FORM_ERROR, WIDEST_INTERVAL
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, sandwich_variance
from rovval.diagnose.problem.problem import Problem


@dataclass(frozen=True, slots=True)
class ByRun:
    """A parameter in each run.

    Attributes:
        values, errors: estimate and standard error of each run (runs,), in the parameter's unit; NaN where the run says too little.
        homogeneity: probability that runs which share one value differ by as much; None where fewer than two say anything.
    """

    values: Array
    errors: Array
    homogeneity: float | None


def by_run(problem: Problem, fitted: HypothesisFit) -> dict[int, ByRun]:
    """Of each fitted slot but onsets, what every run says of it; empty for a single run.

    A run's error is that of its normal equations, larger by as much as the scatter of windows about each run's own values is larger than all of them have
    it (residuals are neither white nor independent), with the form error of the equations added, since runs differ in what they excite.
    """
    if len(problem.runs) < 2:
        return {}
    point, count = fitted.posterior, len(fitted.slots)
    own = [i for i, s in enumerate(point.columns) if i < count or not effects.load(problem.plant.slots[s].effect).in_file]
    step, shared = point.solve(point.curvature, point.descent), np.ix_(own, own)
    pull = (point.precision @ (point.departure + step))[own]
    pull[:count] = 0.0  # towards the joint value, not towards no cause
    score = (point.total.b - point.total.A @ step)[:, own]
    given = point.effects_given_others()
    mine = given[:, own]
    values, variances = np.empty((2, len(problem.runs), count))
    for run in range(len(problem.runs)):
        these = problem.run_of_window == run
        A = point.total.A[these][:, own][..., own]
        inverse = np.linalg.inv(A.sum(axis=0) + point.precision[shared])
        moved = inverse @ (score[these].sum(axis=0) - pull)
        values[run] = fitted.beta[list(fitted.slots)] + given @ step + mine @ moved
        variances[run] = problem.design_effect * np.diag(mine @ inverse @ mine.T)
        score[these] -= A @ moved
        score[these] -= score[these].mean(axis=0)
    bread = mine @ np.asarray(np.linalg.inv(point.curvature[shared]), dtype=np.float64)
    louder = np.maximum(sandwich_variance(bread, score) / (problem.design_effect * np.diag(bread @ mine.T)), 1.0)
    errors = np.sqrt(louder * variances)
    return {s: _of_slot(problem, s, values[:, i], errors[:, i]) for i, s in enumerate(fitted.slots) if problem.plant.slots[s].parameter.role != "onset"}


def _of_slot(problem: Problem, slot: int, values: Array, errors: Array) -> ByRun:
    """One slot's values, without runs that say too little of it (`WIDEST_INTERVAL`)."""
    parameter, null = problem.plant.slots[slot].parameter, float(problem.origin[slot])
    says = errors < WIDEST_INTERVAL * parameter.typical
    errors = np.where(says, np.hypot(errors, PARAMETER_FORM_ERROR * np.abs(values - null)), np.nan)
    values = np.where(says, np.clip(values, parameter.low, parameter.high), np.nan)
    return ByRun(values, errors, homogeneity(values[says], errors[says]) if says.sum() > 1 else None)


def homogeneity(values: Array, errors: Array) -> float:
    """Probability that independent estimates (k,) of one value, with these standard errors (k,), differ by as much (Cochran 1954, the Q statistic,
    chi-squared with k - 1 degrees of freedom)."""
    weight = errors**-2.0
    mean = float(weight @ values / weight.sum())
    return float(stats.chi2.sf(float(weight @ (values - mean) ** 2), len(values) - 1))
