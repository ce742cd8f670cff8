"""The published tank runs of a BlueROV2, and the vehicle as other stretches of them show it.

What the three runs have in common and the published file does not: half of the table's thrust, an attitude 5.8 degrees off the frame of the
velocities, and lateral thrust that does not heel the vehicle as thrusters 85 mm below its centre would.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from types import MappingProxyType

from real_data import real

from rovval import vehicle
from rovval.core.data import Run
from rovval.fit import fit
from rovval.storage.archive import open_run
from rovval.vehicle.model import Vehicle

TUNED = ("drag", "trim", "thrust", "added_mass", "thrust_lag", "rpm_scale", "reverse_asymmetry", "attitude_bias")
HALF_S = 66.0  # of run a's 132 s
SLOP = 0.01  # what is not tuned stays as the file has it: slop that the fit takes up is not in the vehicle that it writes
DIAGNOSED: Mapping[str, tuple[str, ...]] = MappingProxyType({"a, first half": ("a, second half", "b"), "c": ("a", "b")})  # and what is fitted


@cache
def tank(name: str) -> tuple[Run, Vehicle]:
    """A stretch of the tank runs and the vehicle fitted to others; nothing of the stretch is in the fit."""
    result = fit([stretch(other) for other in DIAGNOSED[name]], level(vehicle.load("bluerov2_heavy")), TUNED, calibration_slop=SLOP)
    return stretch(name), vehicle.parse(result.vehicle, "fitted")


def stretch(name: str) -> Run:
    """A run by its letter, or a half of it."""
    letter, _, half = name.partition(", ")
    run = open_run(real(f"bluerov2_tank/run_{letter}.csv"))
    middle = round(HALF_S / run.dt)
    if not half:
        return run
    of = slice(0, middle) if half == "first half" else slice(middle, None)
    values, reasons = {c: x[of] for c, x in run.values.items()}, {c: x[of] for c, x in run.reasons.items()}
    return replace(run, id=f"{run.id} {half}", values=values, reasons=reasons)


def level(nominal: Vehicle) -> Vehicle:
    """The vehicle with its horizontal thrusters at the height of its centre."""
    moved = [t.model_copy(update={"position": (*t.position[:2], 0.0)}) if not t.direction[2] else t for t in nominal.thruster]
    return nominal.model_copy(update={"thruster": type(nominal.thruster)(moved)})
