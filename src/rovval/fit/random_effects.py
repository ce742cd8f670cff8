"""Random effects: how large what every vehicle has to some degree, and no file states, is in the logs of a calibration.

An effect of which every vehicle has some (`effects.Effect.option`: loss of thrust under way, drag across axes, propeller torque) goes into a calibrated file
only where it predicts every run better. What the runs ask of it all the same is the form error of the equations, and comes again in every log of the vehicle:
no cause is new in it. Each run, predicted by the calibration of the others, asks for values of its own, normal about the file's, beside those of the numbers
that have a tolerance; their variances are those of greatest likelihood (linear mixed model; Laird and Ware 1982). One degree of freedom is that of
other vehicles: of a number its tolerance, of an effect its typical size.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval import effects
from rovval.core.data import Array, Run
from rovval.core.errors import BadInput
from rovval.diagnose.problem.problem import Problem, pose
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.plant import Plant
from rovval.simulation.fitted_tolerances import with_tolerances
from rovval.vehicle.model import Vehicle

SLOP = 0.05  # relative tolerance of the file's numbers, as a diagnosis has it where none is given
ROUNDS, SETTLED = 200, 1e-3  # of expectation and maximisation at most, and the relative change of every variance from which it has settled


def tolerances(runs: Sequence[Run], vehicles: Sequence[Vehicle], model: str, window_s: float) -> dict[str, float]:
    """Standard deviations, by key of the parameter, of the effects of which every vehicle has some, in ``runs`` of one vehicle about the vehicles that predict
    them. A run of which too little can be simulated says nothing; without any there are none."""
    problems = [p for run, vehicle in zip(runs, vehicles, strict=True) if (p := _posed(run, with_tolerances(vehicle, {}), model, window_s))]
    if not problems:
        return {}
    plant, columns = problems[0].plant, problems[0].likelihood.total.columns
    typical = np.array([problems[0].tolerance.sd.get(s, plant.slots[s].parameter.typical) for s in columns])
    sd = np.sqrt(_variances([_of_all_windows(p) for p in problems], typical**2))
    asked = _of_every_vehicle(plant)
    return {plant.slots[s].key: float(x) for s, x in zip(columns, sd, strict=True) if s in asked}


def _of_every_vehicle(plant: Plant) -> tuple[int, ...]:
    """Slots of the effects of which every vehicle has some."""
    return tuple(i for i, slot in enumerate(plant.slots) if effects.load(slot.effect).option)


def _posed(run: Run, vehicle: Vehicle, model: str, window_s: float) -> Problem | None:
    """The estimation problem of one run about a vehicle; None where too little can be simulated."""
    try:
        windows, _ = cut([run], vehicle, model, window_s)
        return pose(windows, Columns(_of_every_vehicle(windows[0].plant)), SLOP)
    except BadInput:
        return None


def _of_all_windows(problem: Problem) -> tuple[Array, Array]:
    """Curvature (k, k) and slope (k,) of the log likelihood."""
    equations = problem.likelihood.total
    return equations.A.sum(axis=0) / problem.tempering, equations.b.sum(axis=0) / problem.tempering


def _variances(runs: Sequence[tuple[Array, Array]], prior: Array) -> Array:
    """Variances (k,) of random effects of which each run has the curvature (k, k) and the slope (k,) of its log likelihood, by expectation and maximisation
    (Laird and Ware 1982, 3.2), with one degree of freedom at ``prior`` (k,)."""
    variance = prior
    for _ in range(ROUNDS):
        squares = prior.copy()
        for curvature, slope in runs:
            covariance = np.linalg.inv(curvature + np.diag(1.0 / variance))
            squares += (covariance @ slope) ** 2 + np.diag(covariance)
        before, variance = variance, squares / (1.0 + len(runs))
        if np.abs(variance / before - 1.0).max() < SETTLED:
            break
    return variance
