"""Diagnosis: where the gap between a simulator and logs of the vehicle lies, which effect causes it, how far it shrinks.

Every answer is about this simulator, these logs and this library of effects. A group of effects that the logs cannot tell apart, no
gap at all, an effect outside the library, and "this log cannot tell" are answers.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from rovval.data import Run
    from rovval.vehicle.model import Vehicle


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """``document``: the JSON of the contract (rovval.diagnosis/1). ``settings``: the effects found, as ``--effect`` takes them.
    ``vehicle_fixed``: TOML of the vehicle with these effects added, "" where nothing was found."""

    document: dict[str, Any]
    settings: tuple[str, ...]
    vehicle_fixed: str


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
    from rovval.diagnose.answer import answer
    from rovval.diagnose.finding import find
    from rovval.diagnose.stretches import cut_all

    say = progress or (lambda text, share: None)
    parts, left_out = cut_all(runs, vehicle, model, window_s)
    return answer(find(parts, without, calibration_slop, seed, say), left_out, calibration_slop, seed, say)
