"""The prior of a healthy vehicle: by how much its coefficients and sensors may be off without being a cause.

Coefficients are off by the declared calibration tolerance (`--calibration-slop`, one standard deviation, relative). Trim, mounting and sensors have
tolerances of their own; each effect states its own (`effects.Tolerance`): what a careful installation of an ROV reaches.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.windows.windows import Windows
from rovval.effects import Parameter
from rovval.plant import Plant
from rovval.simulation.fitted_tolerances import fitted_correlation, fitted_tolerances


def tolerance_prior(plant: Plant, relative: float) -> Prior:
    """Prior of the plant's parameters at a healthy vehicle about the values of the vehicle's file: as each effect states it, each by itself, or as the logs of
    the vehicle's calibration have it, together.

    ``relative`` is the calibration tolerance, a relative standard deviation; the prior is empty where it is zero.
    """
    if relative <= 0:
        return Prior({})
    stated, known = ((i, slot, slot.parameter.tolerance) for i, slot in enumerate(plant.slots)), fitted_tolerances(plant.vehicle)
    found = {i: t.of(slot.parameter, plant.vehicle, slot.target, relative) for i, slot, t in stated if t is not None}
    slots, (keys, correlation) = {slot.key: i for i, slot in enumerate(plant.slots)}, fitted_correlation(plant.vehicle)
    at = [i for i, key in enumerate(keys) if key in slots]
    own = tuple(slots[keys[i]] for i in at)
    return Prior(found | {slots[key]: sd for key, sd in known.items() if key in slots}, own, correlation[np.ix_(at, at)])


def wide_sd(plant: Plant, slots: Sequence[int]) -> dict[int, float]:
    """Standard deviations, by slot, of the wide prior (`PRIOR_WIDTH`) of parameters that an effect sets free."""
    return {s: PRIOR_WIDTH * plant.slots[s].parameter.typical for s in slots}


def prior_mean(parameter: Parameter, runs: Sequence[Windows], otherwise: float) -> float:
    """Mean of the prior of a parameter: of a depth what the logs say of it, the middle of where the vehicle was, or a bottom that lies as far below the
    deepest of it as the prior is wide (`PRIOR_WIDTH`); of all others what is there ``otherwise``."""
    if parameter.role not in ("datum", "level", "bottom"):
        return otherwise
    z = np.concatenate([part.depths() for part in runs])
    mean = float(z.max()) + PRIOR_WIDTH * parameter.typical if parameter.role == "bottom" else float(np.median(z))
    return parameter.within(mean)


def loosened_by_closed_loop(prior: Prior, plant: Plant, gain: Mapping[str, float]) -> Prior:
    """The prior with wider tolerances for the moments about axes that an autopilot steadies, whose size its motion shows the less (`effects.Tolerance`).

    ``gain`` is the loop gain by axis (`windows.closed_loop.loop_gains`).
    """
    stated = ((s, sd, plant.slots[s].target, plant.slots[s].parameter.tolerance) for s, sd in prior.sd.items())
    return prior.off_by_more({s: t.widened(sd, target, gain) for s, sd, target, t in stated if t is not None})
