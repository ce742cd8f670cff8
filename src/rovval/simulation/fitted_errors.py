"""How far the simulator of a calibrated vehicle was from the logs that it was calibrated on, each predicted by the others where there are several: what a
healthy vehicle of these equations shows.

The numbers stand in the vehicle file's table `[calibration]`, one a channel: root mean squares in restarted windows, in the channel's SI unit. Equations are
only nearly right, and no number of the file mends what is left.
"""

from __future__ import annotations

from collections.abc import Mapping

from rovval.vehicle.model import Vehicle

ERROR = "error."  # before the channel's name


def fitted_errors(vehicle: Vehicle) -> Mapping[str, float]:
    """Errors by channel of the logs that the vehicle was calibrated on; empty where its file does not say."""
    return {key.removeprefix(ERROR): value for key, value in vehicle.calibration.items() if key.startswith(ERROR)}


def kept(errors: Mapping[str, float]) -> dict[str, float]:
    """Errors by channel as they stand in `[calibration]`, in four digits."""
    return {f"{ERROR}{channel}": float(f"{error:.4g}") for channel, error in errors.items()}
