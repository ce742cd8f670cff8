"""What a healthy simulator and healthy sensors may be off by, before anything is blamed: the prior that detection stands on.

Coefficients are off by the declared calibration tolerance (`--calibration-slop`, one standard deviation, relative). Trim, mounting and sensors have
tolerances of their own; each effect states its own (`effects.Tolerance`): what a careful installation of an ROV reaches.
"""

from __future__ import annotations

from collections.abc import Mapping

from rovval.diagnose.residuals.ridge import Prior
from rovval.plant import Plant


def tolerance_prior(plant: Plant, relative: float) -> Prior:
    """Standard deviation by plant slot of what a healthy simulator and log may be off by, as each effect states it; empty where ``relative``, the
    relative calibration tolerance, is zero."""
    if relative <= 0:
        return Prior({})
    stated = ((i, slot, slot.parameter.tolerance) for i, slot in enumerate(plant.slots))
    return Prior({i: t.of(slot.parameter, plant.vehicle, slot.target, relative) for i, slot, t in stated if t is not None})




def loosened_by_closed_loop(prior: Prior, plant: Plant, gain: Mapping[str, float]) -> Prior:
    """The tolerances of what turns the vehicle about an axis that an autopilot steadies with the loop ``gain``, and of how it rights itself, wider by as
    much as the motion shows less of them (`effects.Tolerance`)."""
    sd = dict(prior.sd)
    for s in sd:
        slot = plant.slots[s]
        if slot.parameter.tolerance is not None:
            sd[s] = slot.parameter.tolerance.widened(sd[s], slot.target, gain)
    return Prior(sd)
