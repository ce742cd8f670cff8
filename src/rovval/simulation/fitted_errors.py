"""How far the simulator of a calibrated vehicle was from the logs that it was calibrated on, each predicted by the others where there are several: what a
healthy vehicle of these equations shows.

The numbers stand in the vehicle file's table `[calibration]`, one a channel: root mean squares in restarted windows, in the channel's SI unit. Equations are
only nearly right, and no number of the file mends what is left.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from rovval.core.channels import VELOCITIES
from rovval.core.data import Array, Flags
from rovval.vehicle.model import Vehicle

ERROR = "error."  # before the channel's name


def fitted_errors(vehicle: Vehicle) -> Mapping[str, float]:
    """Errors by channel of the logs that the vehicle was calibrated on; empty where its file does not say."""
    return {key.removeprefix(ERROR): value for key, value in vehicle.calibration.items() if key.startswith(ERROR)}


def errors_left(residuals: Sequence[Array], ok: Sequence[Flags]) -> dict[str, float]:
    """Errors by their keys in `[calibration]`, from ``residuals`` (m, n, 10) of each log by `fit.record.CHANNELS`, where ``ok``: six velocities, roll and pitch
    (of level vehicles the body components of the vertical are as large), depth."""
    channels = {**{name: i for i, name in enumerate(VELOCITIES)}, "phi": 7, "theta": 6, "z": 9}
    found = dict[str, float]()
    for name, i in channels.items():
        error = np.concatenate([r[..., i][good[..., i]] for r, good in zip(residuals, ok, strict=True)])
        if len(error):
            found[f"{ERROR}{name}"] = float(f"{np.sqrt(np.mean(error**2)):.4g}")
    return found
