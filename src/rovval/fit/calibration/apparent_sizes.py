"""Apparent sizes of effects in the logs of a calibration: how large each effect of the library seems to be in them, by itself.

What the equations of a vehicle are off by resembles effects of the library, more or less of each, on every log of the vehicle: a thruster seems to be a little
weak, a drag a little larger. Each run, predicted by the calibration of the others, asks for a size of every parameter, beside numbers within their tolerances.
The sizes that a parameter seems to have are normal about none, of greatest likelihood (linear mixed model; Laird and Ware 1982); one degree of freedom of
their variance is that of other vehicles, on which it is as large as is typical of the effect.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rovval.core.data import Array, Run
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.ridge import eliminated
from rovval.fit.calibration.random_effects import posed, variances
from rovval.vehicle.model import Vehicle


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
    rows = [[asked.get(key, none) for key in first] for asked in each]
    data = [(np.diag([one.curvature for one in row]), np.array([one.slope for one in row]), np.arange(len(row))) for row in rows]
    return dict(zip(first, np.sqrt(variances(data, typical**2, 1.0)).tolist(), strict=True))


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
