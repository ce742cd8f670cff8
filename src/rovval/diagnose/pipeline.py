"""The diagnosis as an algorithm."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rovval.core.data import Run
from rovval.diagnose.decision.finding import find
from rovval.diagnose.result.assembly import assemble
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.diagnose.windows.shooting import cut_all
from rovval.vehicle.model import Vehicle


def diagnose(
    runs: Sequence[Run],
    vehicle: Vehicle,
    *,
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
    seed: int = 0,
    without: Sequence[str] = (),
    progress: Callable[[str, float], None] | None = None,
) -> Diagnosis:
    """Diagnose the gap between ``vehicle``'s simulator and one or several of its logs.

    Args:
        runs: logs on the 10 Hz grid, all of this vehicle; three or more are held out one at a time, fewer in fifths.
        calibration_slop: relative error that a healthy simulator's coefficients may have; an effect must explain more than that.
        without: effects or hypotheses to leave out of the library (the withheld-effect check does).

    Raises:
        BadInput: too little of a log can be simulated, or thruster inputs are missing.
    """

    say = progress or (lambda text, share: None)
    parts, left_out = cut_all(runs, vehicle, model, window_s)
    return assemble(find(parts, without, calibration_slop, seed, say), left_out, calibration_slop, seed, say)
