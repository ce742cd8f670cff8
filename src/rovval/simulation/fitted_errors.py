"""How far the simulator of a calibrated vehicle was from the logs that it was calibrated on, each predicted by the others where there are several: what a
healthy vehicle of these equations shows.

The numbers stand in the vehicle file's table `[calibration]`, one a channel: root mean squares in restarted windows, in the channel's SI unit. Equations are
only nearly right, and no number of the file mends what is left. Beside them stands by how much they differ from run to run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rovval.vehicle.model import Vehicle

ERROR = "error."  # before the channel's name
SPREAD, RUNS = "error_spread", "error_runs"


def fitted_errors(vehicle: Vehicle) -> Mapping[str, float]:
    """Errors by channel of the logs that the vehicle was calibrated on; empty where its file does not say."""
    return {key.removeprefix(ERROR): value for key, value in vehicle.calibration.items() if key.startswith(ERROR)}


def spread_of_errors(vehicle: Vehicle) -> tuple[float, int]:
    """Standard deviation of the logarithm of a squared error from run to run, and of how many runs that is known; (0, 1) where the file does not say."""
    return vehicle.calibration.get(SPREAD, 0.0), int(vehicle.calibration.get(RUNS, 1.0))


def kept(errors: Mapping[str, float], each: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """Errors by channel as they stand in `[calibration]`, in four digits, of all runs and of ``each``, which say how much they differ."""
    found = {f"{ERROR}{channel}": _rounded(error) for channel, error in errors.items()}
    if len(each) < 2:
        return found
    logs = [[2.0 * np.log(one[channel]) for one in each] for channel in errors if all(one.get(channel, 0.0) > 0.0 for one in each)]
    return found | {SPREAD: _rounded(float(np.sqrt(np.var(logs, axis=1, ddof=1).mean()))), RUNS: float(len(each))} if logs else found


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")
