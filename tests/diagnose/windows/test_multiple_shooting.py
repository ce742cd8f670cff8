"""Windows of a vehicle whose motion decays within a sample: they are integrated as finely as `rovval simulate` integrates it."""

from __future__ import annotations

import numpy as np
import pytest
from diagnose_case import merlin, own

from rovval.diagnose.residuals.sensitivities import residual
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.vehicle.model import as_matrix

QUICK = (1.0, 1.0, 1.0, 400.0, 1.0, 1.0)  # times the linear drag: a roll that decays in 0.03 s, as a light vehicle's


@pytest.mark.parametrize(("times", "steps"), [((1.0,) * 6, 1), (QUICK, 3)])
def test_a_stiff_vehicle_is_integrated_in_smaller_steps(times: tuple[float, ...], steps: int):
    """One step of 0.1 s a sample let a calibrated BlueROV2 leave sane limits in windows in which its simulation was right."""
    body = merlin().body
    drag = tuple(float(k * d) for k, d in zip(times, np.diag(as_matrix(body.linear_drag)), strict=True))
    vehicle = merlin().model_copy(update={"body": body.model_copy(update={"linear_drag": drag})})
    run = own.__wrapped__((), 3, 60.0, 0.0, vehicle)  # uncached: a vehicle is no key
    [windows], _ = cut([run], vehicle, "fossen", 10.0)
    assert windows.plant.substeps >= steps and (steps > 1 or windows.plant.substeps == 1)
    error, ran = residual(windows, windows.plant.null)
    assert ran.all() and np.abs(error).max() < 2e-3
