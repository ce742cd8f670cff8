"""Model discrepancy of a calibration (Kennedy and O'Hagan 2001): how large forces that go with the motion, and are in no equation, are in its logs.

Equations are only nearly right. What they leave of the logs of a calibration comes again in every log of the vehicle, and is no sign that something new is at
work. On each axis it is a sum of the generic forces of a diagnosis (`residuals.external_forces`), whose coefficients are normal about zero: random effects of
each run, beside numbers within their tolerances. They are of two sizes, one of forces that go with the axis's own velocity, since damping is the least well
known part of the equations (Fossen 2021, 6.4), and one of all others. A run is predicted by the calibration of the others, and the sizes are those of
greatest likelihood.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rovval.core.channels import AXES
from rovval.core.data import Array, Run
from rovval.diagnose.inference.map_fit import healthy_fit
from rovval.diagnose.residuals.external_forces import damps, typical_wrench
from rovval.diagnose.search.discrepancy import generic_forces
from rovval.fit.calibration.random_effects import posed, variances
from rovval.simulation.fitted_tolerances import kind_of_force, with_discrepancy
from rovval.vehicle.model import Vehicle

FIRST = 0.03  # of the thrusters' rms: size of a force from which the search begins


def discrepancy(runs: Sequence[Run], vehicles: Sequence[Vehicle], model: str, window_s: float) -> dict[str, float]:
    """Standard deviations (N, N m), by `simulation.fitted_tolerances.kind_of_force`, of coefficients of generic forces of unit rms in ``runs`` of one vehicle
    about the vehicles that predict them, whose numbers have their tolerances; none of forces that no run can have, as a damping where the velocity was not
    logged. A run of which too little can be simulated says nothing."""
    asked = [one for run, vehicle in zip(runs, vehicles, strict=True) if (one := _asked(run, with_discrepancy(vehicle, {}), model, window_s))]
    if not asked:
        return {}
    start = np.tile(np.mean([FIRST * wrench for *_, wrench in asked], axis=0) ** 2, 2)
    known = np.unique(np.concatenate([kind for *_, kind, _ in asked]))
    each = [(curvature, slope, np.searchsorted(known, kind)) for curvature, slope, kind, _ in asked]
    sd = np.sqrt(variances(each, start[known]))
    kinds = [kind_of_force(axis, damping) for damping in (False, True) for axis in AXES]
    return {kinds[i]: float(x) for i, x in zip(known, sd, strict=True)}


def _asked(run: Run, vehicle: Vehicle, model: str, window_s: float) -> tuple[Array, Array, NDArray[np.int64], Array] | None:
    """What a run asks about a vehicle: curvature (f, f) and slope (f,) of its log likelihood in generic forces, N or N m, with all else at its most probable
    beside them; the kind of each (f,); and the rms of the thrusters' force by axis (6,). None where too little can be simulated."""
    problem = posed(run, vehicle, model, window_s)
    if problem is None:
        return None
    forces, wrench = generic_forces(problem, healthy_fit(problem)), typical_wrench(problem.runs)
    axis = np.array([AXES.index(name) for name, _ in forces.names])
    kind = axis + len(AXES) * np.array([damps(*name) for name in forces.names])
    curvature, slope = forces.beside_the_fit()
    unit = wrench[axis]
    return curvature / np.outer(unit, unit) / forces.tempering, slope / unit / forces.tempering, kind, wrench
