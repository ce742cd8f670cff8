"""Random effects: how large what every vehicle has to some degree, and no file states, is in the logs of a calibration; read `tolerances` first.

An effect of which every vehicle has some (`effects.Effect.option`: loss of thrust under way, drag across axes, propeller torque) goes into a calibrated file
only where it predicts every run better. What the runs ask of it all the same is the form error of the equations, and comes again in every log of the vehicle:
no cause is new in it. Each run, predicted by the calibration of the others, asks for values of its own, normal about the file's, beside those of the numbers
that have a tolerance; their variances are those of greatest likelihood (linear mixed model; Laird and Ware 1982). One degree of freedom is that of
other vehicles: of a number its tolerance, of an effect its typical size.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.core.data import Array, Flags, Run
from rovval.core.errors import BadInput
from rovval.diagnose.problem.problem import Problem, pose
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.diagnose.windows.windows import Windows
from rovval.plant.slots import Slot
from rovval.simulation.fitted_tolerances import with_tolerances
from rovval.vehicle.model import Vehicle

SLOP = 0.05  # relative tolerance of the file's numbers, as a diagnosis has it where none is given
ROUNDS, SETTLED = 200, 1e-3  # of expectation and maximisation at most, and the relative change of every variance from which it has settled


class _Asked(NamedTuple):
    """What one run asks: curvature (k, k) and slope (k,) of its log likelihood in parameters by their keys, of which those ``free`` (k,) are effects of which
    every vehicle has some, and ``prior`` (k,) standard deviations."""

    keys: tuple[str, ...]
    free: Flags
    prior: Array
    curvature: Array
    slope: Array


def tolerances(runs: Sequence[Run], vehicles: Sequence[Vehicle], model: str, window_s: float) -> dict[str, float]:
    """Standard deviations, by key of the parameter, of the effects of which every vehicle has some, in ``runs`` of one vehicle about the vehicles that predict
    them. A run of which too little can be simulated says nothing; without any there are none."""
    asked = [one for run, vehicle in zip(runs, vehicles, strict=True) if (one := _asked(run, with_tolerances(vehicle, {}), model, window_s))]
    if not asked:
        return {}
    first = asked[0]
    each = np.arange(len(first.keys))
    sd = np.sqrt(variances([(one.curvature, one.slope, each) for one in asked], first.prior**2, 1.0))
    return {key: float(x) for key, x, free in zip(first.keys, sd, first.free, strict=True) if free}


def _asked(run: Run, vehicle: Vehicle, model: str, window_s: float) -> _Asked | None:
    """What a run asks about a vehicle; None where too little can be simulated."""
    problem = posed(run, vehicle, model, window_s)
    if problem is None:
        return None
    equations, tolerance, slots = problem.likelihood.total, problem.tolerance.sd, problem.plant.slots
    columns, every = equations.columns, every_vehicle_has(slots)
    prior = np.array([tolerance.get(s, slots[s].parameter.typical) for s in columns])
    curvature, slope = equations.A.sum(axis=0) / problem.tempering, equations.b.sum(axis=0) / problem.tempering
    return _Asked(tuple(slots[s].key for s in columns), np.isin(columns, every), prior, curvature, slope)


def of_every_vehicle(windows: Sequence[Windows]) -> Columns:
    """The columns of what every vehicle has."""
    return Columns(every_vehicle_has(windows[0].plant.slots))


def posed(
    run: Run, vehicle: Vehicle, model: str, window_s: float, columns: Callable[[Sequence[Windows]], Columns] = of_every_vehicle
) -> Problem | None:
    """The estimation problem of a run in the numbers of a vehicle that have a tolerance and in other ``columns``; None where too little can be simulated."""
    try:
        windows, _ = cut([run], vehicle, model, window_s)
        return pose(windows, columns(windows), SLOP)
    except BadInput:
        return None


def every_vehicle_has(slots: Sequence[Slot]) -> tuple[int, ...]:
    """Places of the parameters of effects of which every vehicle has some (`effects.Effect.option`)."""
    return tuple(i for i, slot in enumerate(slots) if effects.load(slot.effect).option)


def variances(runs: Sequence[tuple[Array, Array, NDArray[np.int64]]], start: Array, freedom: float) -> Array:
    """Variances (g,) of groups of random effects, by expectation and maximisation (Laird and Ware 1982, 3.2) from ``start`` (g,), which has ``freedom`` degrees
    of freedom. Each run has the curvature (k, k) and the slope (k,) of its log likelihood in its effects, and the group of each of these (k,)."""
    variance, count = start, freedom + sum(np.bincount(group, minlength=len(start)) for *_, group in runs)
    for _ in range(ROUNDS):
        squares = freedom * start
        for curvature, slope, group in runs:
            covariance = np.linalg.inv(curvature + np.diag(1.0 / variance[group]))
            squares = squares + np.bincount(group, (covariance @ slope) ** 2 + np.diag(covariance), minlength=len(start))
        before, variance = variance, squares / count
        if np.abs(variance / before - 1.0).max() < SETTLED:
            break
    return variance
