"""How large what every vehicle has to some degree, and no file states, was in the logs that a vehicle was calibrated on: loss of thrust under way, say.

The numbers stand in the vehicle file's table `[calibration]`, one a parameter of such an effect (`effects.Effect.option`): standard deviations in the
parameter's unit, by which a healthy vehicle may have it.
"""

from __future__ import annotations

from collections.abc import Mapping

from rovval.vehicle.model import Vehicle

TOLERANCE = "tolerance."  # before the parameter's key


def fitted_tolerances(vehicle: Vehicle) -> Mapping[str, float]:
    """Standard deviations by key of the parameter (``inflow_loss.loss``); empty where the vehicle's file does not say."""
    return {key.removeprefix(TOLERANCE): value for key, value in vehicle.calibration.items() if key.startswith(TOLERANCE)}


def with_tolerances(vehicle: Vehicle, found: Mapping[str, float]) -> Vehicle:
    """The vehicle with these in place of those that its file has, in four digits."""
    others = {key: value for key, value in vehicle.calibration.items() if not key.startswith(TOLERANCE)}
    return vehicle.model_copy(update={"calibration": others | {f"{TOLERANCE}{key}": float(f"{value:.4g}") for key, value in found.items()}})
