"""What a healthy vehicle may show, as large as it was in the logs that it was calibrated on.

The numbers stand in the vehicle file's table `[calibration]`, standard deviations all of them: of what the vehicle's own numbers are off by from run to run,
and what every vehicle has to some degree and no file states, loss of thrust under way, say, one a parameter in its unit (`fit.calibration.random_effects`);
of forces that no equation of the vehicle has, two an axis, N or N m (`fit.calibration.discrepancy`); and of sizes that effects of the library only seem to
have (`fit.calibration.apparent_sizes`). Correlations of the first are a table of their own, `[tolerance_correlation]`: by key those with the keys before it.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.core.data import Array
from rovval.vehicle.model import Vehicle

TOLERANCE = "tolerance."  # before the parameter's key
DISCREPANCY = "discrepancy."  # before the kind of force
APPARENT = "apparent."  # before the parameter's key


def fitted_tolerances(vehicle: Vehicle) -> Mapping[str, float]:
    """Standard deviations by key of the parameter (``inflow_loss.loss``); empty where the vehicle's file does not say."""
    return _known(vehicle, TOLERANCE)


def fitted_correlation(vehicle: Vehicle) -> tuple[tuple[str, ...], Array]:
    """Keys of the c parameters whose tolerances go together, and their correlations (c, c); none where the vehicle's file does not say."""
    return tuple(vehicle.tolerance_correlation), vehicle.correlation


def with_tolerances(vehicle: Vehicle, found: Mapping[str, float], correlation: Array | None = None) -> Vehicle:
    """The vehicle with these in place of those that its file has, in four digits, and with their ``correlation`` (k, k), none by default, in eight places: the
    smallest eigenvalue of those of tank runs is 2e-4, and what rounding adds must stay far below it."""
    rows = dict[str, tuple[float, ...]]()
    if correlation is not None and np.tril(correlation, -1).any():
        rows = {key: tuple(round(float(x), 8) for x in row[:i]) for i, (key, row) in enumerate(zip(found, correlation, strict=True))}
    return _with(vehicle, TOLERANCE, found).model_copy(update={"tolerance_correlation": rows})


def fitted_discrepancy(vehicle: Vehicle) -> Mapping[str, float]:
    """Standard deviations (N, N m) by `kind_of_force` of forces that go with the motion and that no equation has; empty where the vehicle's file does not
    say."""
    return _known(vehicle, DISCREPANCY)


def kind_of_force(axis: str, damping: bool) -> str:
    """What a force on an axis goes by: whether it is a ``damping``, which goes with the velocity on that axis alone."""
    return f"{axis} damping" if damping else axis


def with_discrepancy(vehicle: Vehicle, found: Mapping[str, float]) -> Vehicle:
    """The vehicle with these in place of those that its file has, in four digits."""
    return _with(vehicle, DISCREPANCY, found)


def fitted_sizes(vehicle: Vehicle) -> Mapping[str, float]:
    """Standard deviations of apparent sizes by key of the parameter (``thruster_degraded[T2].loss``); empty where the vehicle's file does not say."""
    return _known(vehicle, APPARENT)


def with_sizes(vehicle: Vehicle, found: Mapping[str, float]) -> Vehicle:
    """The vehicle with these in place of those that its file has, in four digits."""
    return _with(vehicle, APPARENT, found)


def _known(vehicle: Vehicle, kind: str) -> Mapping[str, float]:
    return {key.removeprefix(kind): value for key, value in vehicle.calibration.items() if key.startswith(kind)}


def _with(vehicle: Vehicle, kind: str, found: Mapping[str, float]) -> Vehicle:
    others = {key: value for key, value in vehicle.calibration.items() if not key.startswith(kind)}
    return vehicle.model_copy(update={"calibration": others | {f"{kind}{key}": float(f"{value:.4g}") for key, value in found.items()}})
