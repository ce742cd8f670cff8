"""Random effects: by how much a vehicle differs from its calibration from run to run; read `tolerances` first.

No two runs determine the file's numbers alike, and of some effects every vehicle has some (`effects.Effect.option`: loss of thrust under way, drag across axes,
propeller torque), which go into a calibrated file only where they predict every run better. What a run asks of both beside the calibration comes again in
every log of the vehicle, and no cause is new in it. These departures are normal about the calibrated vehicle, and their covariance is that of greatest
likelihood (linear mixed model; Laird and Ware 1982): runs may know a sum of numbers well, thrust over drag say, and neither of them. One degree of freedom is
that of other vehicles: independent departures, of a number as large as its tolerance, of an effect as is typical of it. What sensors are off by is each run's
own, and stays as it is stated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.core.data import Array, Run
from rovval.core.errors import BadInput
from rovval.diagnose.problem.problem import Problem, pose
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.residuals.ridge import eliminated
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.diagnose.windows.windows import Windows
from rovval.plant.slots import Slot
from rovval.simulation.fitted_tolerances import with_tolerances
from rovval.vehicle.model import Vehicle

SLOP = 0.05  # relative tolerance of the file's numbers, as a diagnosis has it where none is given
ROUNDS, SETTLED = 200, 1e-3  # of expectation and maximisation at most, and the relative change of every variance from which it has settled


class _Asked(NamedTuple):
    """What one run asks: curvature (k, k) and slope (k,) of its log likelihood in the vehicle's own parameters by their keys, sensors at their most probable
    beside them, and standard deviations (k,) that they have on ``other`` vehicles."""

    keys: tuple[str, ...]
    other: Array
    curvature: Array
    slope: Array


def tolerances(runs: Sequence[Run], vehicle: Vehicle, model: str, window_s: float) -> tuple[dict[str, float], Array]:
    """Standard deviations, by key of the parameter, of what a new run of a ``vehicle`` is off by that was calibrated on ``runs``, and its correlations in the
    same order: of the vehicle's numbers that have a tolerance, and of effects of which every vehicle has some, as far as each run can have them. A run of which
    too little can be simulated says nothing; without any there are none."""
    found = (_asked(run, with_tolerances(vehicle, {}), model, window_s) for run in runs)
    asked = [one for one in found if one]
    if not asked:
        return {}, np.eye(0)
    shared = [key for key in asked[0].keys if all(key in one.keys for one in asked)]
    places = [[one.keys.index(key) for key in shared] for one in asked]
    other = asked[0].other[places[0]]
    unit = np.outer(other, other)
    standardised = covariance([(one.curvature[np.ix_(at, at)] * unit, one.slope[at] * other) for one, at in zip(asked, places, strict=True)])
    sd = np.sqrt(np.diag(standardised))
    return dict(zip(shared, (sd * other).tolist(), strict=True)), standardised / np.outer(sd, sd)


def _asked(run: Run, vehicle: Vehicle, model: str, window_s: float) -> _Asked | None:
    """What a run asks about a vehicle; None where too little can be simulated."""
    problem = posed(run, vehicle, model, window_s)
    if problem is None:
        return None
    equations, tolerance, slots = problem.likelihood.total, problem.tolerance, problem.plant.slots
    sensors = tuple(s for s in equations.columns if effects.load(slots[s].effect).place == "sensor")
    own = tuple(s for s in equations.columns if s not in sensors)
    A, b = equations.A.sum(axis=0) / problem.tempering, equations.b.sum(axis=0) / problem.tempering
    A, b = eliminated(A, b, equations.place(sensors), tolerance.precision(sensors), np.zeros(len(sensors)))
    other, at = np.array([tolerance.sd.get(s, slots[s].parameter.typical) for s in own]), equations.place(own)
    return _Asked(tuple(slots[s].key for s in own), other, A[np.ix_(at, at)], b[at])


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


def covariance(runs: Sequence[tuple[Array, Array]]) -> Array:
    """Covariance (k, k) of what a new run is off by, by expectation and maximisation (Laird and Ware 1982, 3.2), from independent departures of variance one,
    which have one degree of freedom. Each run has the curvature (k, k) and the slope (k,) of its log likelihood in its departure.

    What is calibrated on m runs is nearer to each of them than to another: their departures have 1 - 1 / m of the variance about the vehicle itself, those of a
    new run 1 + 1 / m of it. So one alone says nothing of the next.
    """
    other, count = np.eye(len(runs[0][1])), len(runs)
    if count < 2:
        return other
    found, farther = other, (count + 1) / (count - 1)
    for _ in range(ROUNDS):
        total = other
        for curvature, slope in runs:
            own = np.linalg.inv(curvature + np.linalg.inv(found))
            total = total + own + farther * np.outer(own @ slope, own @ slope)
        before, found = found, total / (1 + count)
        if np.abs(found - before).max() < SETTLED * np.abs(found).max():
            break
    return np.asarray(0.5 * (found + found.T))


def variances(runs: Sequence[tuple[Array, Array, NDArray[np.int64]]], start: Array) -> Array:
    """Variances (g,) of groups of random effects, by expectation and maximisation (Laird and Ware 1982, 3.2) from ``start`` (g,). Each run has the curvature
    (k, k) and the slope (k,) of its log likelihood in its effects, and the group of each of these (k,)."""
    variance, count = start, sum(np.bincount(group, minlength=len(start)) for *_, group in runs)
    for _ in range(ROUNDS):
        squares = np.zeros(len(start))
        for curvature, slope, group in runs:
            covariance = np.linalg.inv(curvature + np.diag(1.0 / variance[group]))
            squares = squares + np.bincount(group, (covariance @ slope) ** 2 + np.diag(covariance), minlength=len(start))
        before, variance = variance, squares / count
        if np.abs(variance / before - 1.0).max() < SETTLED:
            break
    return variance
