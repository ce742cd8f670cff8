"""Apparent sizes of effects in the logs of a calibration: how large each effect of the library seems to be in them, by itself.

What the equations of a vehicle are off by resembles effects of the library, more or less of each, on every log of the vehicle: a thruster seems to be a little
weak, a drag a little larger. Each run, predicted by the calibration of the others, asks for a size of every parameter, beside numbers within their tolerances.
The sizes that a parameter seems to have are normal about none. Few runs say little of their variance, but all parameters together say how large such variances
are on this vehicle, in squares of what is typical of each effect: one degree of freedom of every variance is theirs (empirical Bayes: Smyth 2004). So a
steady force that none of the runs showed is new from a small size on, where runs of the same vehicle leave little of anything.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy import special, stats

from rovval.core.data import Array, Run
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.ridge import eliminated
from rovval.fit.calibration.random_effects import posed
from rovval.vehicle.model import Vehicle

VARIANCES = np.geomspace(1e-8, 1e8, 801)  # squares of typical sizes, over which is integrated: from what no log shows to what no vehicle has
MOSTLY = 0.01, 1.0  # typical sizes between which those of a vehicle mostly are (chosen): less is as good as none, and more no error of form


class _Asked(NamedTuple):
    """What a run asks of one parameter: ``curvature`` and ``slope`` of its log likelihood, and the ``typical`` size, in the parameter's unit."""

    curvature: float
    slope: float
    typical: float


def apparent_sizes(runs: Sequence[Run], vehicles: Sequence[Vehicle], model: str, window_s: float) -> dict[str, float]:
    """Standard deviations, by key of the parameter, of the sizes that effects of the library seem to have in ``runs`` of one vehicle about the vehicles that
    predict them. A run of which too little can be simulated says nothing; without any there are none."""
    each = [asked for run, vehicle in zip(runs, vehicles, strict=True) if (asked := _asked(run, vehicle, model, window_s))]
    first = {key: one for asked in each for key, one in asked.items()}
    if not first:
        return {}
    none, typical = _Asked(0.0, 0.0, 0.0), np.array([one.typical for one in first.values()])
    rows = np.array([[asked.get(key, none)[:2] for key in first] for asked in each])
    variance = pooled_variances(rows[..., 0] * typical**2, rows[..., 1] * typical)
    return dict(zip(first, (typical * np.sqrt(variance)).tolist(), strict=True))


def pooled_variances(curvature: Array, slope: Array) -> Array:
    """Variances (k,) of the sizes of k parameters: scales of inverse chi-squared distributions that have the median of the posterior of each, with a degree of
    freedom for each run and one more. The size in a new run, over its standard deviation, is Student's t.

    Their prior is scaled inverse chi-squared of one degree of freedom, about the variance (`MOSTLY`) of greatest marginal likelihood for all of them (Smyth
    2004, section 6), which is integrated numerically, since sizes are known with an error each. A single run, which is predicted by a calibration on itself,
    says nothing of the next: there the prior is about what is typical.

    Args:
        curvature, slope: of the log likelihood of the size of each parameter in each run (n, k), in typical sizes; 0 where the run does not show it.
    """
    total = curvature[..., None] * VARIANCES + 1.0
    likelihood = 0.5 * (slope[..., None] ** 2 * VARIANCES / total - np.log(total)).sum(axis=0)  # of a variance; sizes integrated out
    scales = VARIANCES[slice(*np.searchsorted(VARIANCES, np.square(MOSTLY), side="right"))] if len(slope) > 1 else np.ones(1)
    best = max(scales, key=lambda scale: float(special.logsumexp(likelihood + _log_prior(scale), axis=1).sum()))
    posterior = special.softmax(likelihood + _log_prior(best), axis=1)
    median = np.array([np.exp(np.interp(0.5, np.cumsum(one) - 0.5 * one, np.log(VARIANCES))) for one in posterior])
    return np.asarray(median * stats.chi2.median(1 + len(slope)) / (1 + len(slope)))


def _log_prior(scale: float) -> Array:
    """Log density of the logarithm of `VARIANCES`, but for a constant: scaled inverse chi-squared of one degree of freedom."""
    return np.asarray(0.5 * (np.log(scale / VARIANCES) - scale / VARIANCES))


def _asked(run: Run, vehicle: Vehicle, model: str, window_s: float) -> dict[str, _Asked]:
    """What a run asks of each parameter that has a size, by its key; none where too little can be simulated."""
    problem = posed(run, vehicle, model, window_s, lambda windows: columns_of(hypotheses(windows)[0]))
    if problem is None:
        return {}
    library, _ = hypotheses(problem.runs)
    sized = dict.fromkeys(s for h in library for s in h.slots if s in problem.likelihood.total.columns and not problem.plant.slots[s].parameter.places)
    curvature, slope = _of_each(problem, tuple(sized))
    parameters = [problem.plant.slots[s] for s in sized]
    return {slot.key: _Asked(float(a), float(b), slot.parameter.typical) for slot, a, b in zip(parameters, curvature, slope, strict=True) if a > 0.0}


def _of_each(problem: Problem, slots: tuple[int, ...]) -> tuple[Array, Array]:
    """Curvature and slope (k,) of the log likelihood in each of the ``slots`` by itself, all that has a tolerance but for it at its most probable beside it."""
    data, tolerance = problem.likelihood.total, problem.tolerance
    A, b = data.A.sum(axis=0) / problem.tempering, data.b.sum(axis=0) / problem.tempering
    found = np.empty((len(slots), 2))
    for i, slot in enumerate(slots):
        others = tuple(s for s in tolerance.sd if s != slot)
        place = data.place((slot, *others))
        left, toward = eliminated(A[np.ix_(place, place)], b[place], np.arange(1, len(place)), tolerance.precision(others), np.zeros(len(others)))
        found[i] = left[0, 0], toward[0]
    return found[:, 0], found[:, 1]
