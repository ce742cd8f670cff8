"""Pieces of physics taken out of a BlueROV2 that was calibrated on real tank runs, and damage done to these runs: what `diagnose` is to name.

The vehicle is calibrated on the two other runs, so that nothing of the run that is diagnosed is in it.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import polars as pl
from real_answers import Answer, Question, ask
from real_data import real

from rovval import vehicle
from rovval.core.code_version import source_hash
from rovval.core.data import Run
from rovval.fit.calibration import calibrate
from rovval.fit.calibration.unknowns import applied, unknowns
from rovval.storage.archive import open_run
from rovval.storage.atomic import write_text
from rovval.vehicle.model import Vehicle
from rovval.vehicle.write import to_toml, with_effects

KEPT = Path(__file__).parents[2] / ".pytest_cache"
UNUSED = ("cli", "report", "pipeline", "blind", "fly", "demo", "comparison")  # rooms that a calibration takes nothing of
RUNS = ("a", "b", "c")
LEFT = 0.05  # of a drag that is taken out
WEAK = 0.6  # of a thruster's thrust; a thruster that is left at 1/WEAK is the same mistake the other way round
LATE_S = 0.4
TURNED = math.radians(10.0)
LIFT = 3.0  # N
SHIFT = 0.02  # m
CHANNELS = ("u", "v", "w", "p", "q", "r", "phi", "theta", "z")


def tank(run: str) -> Path:
    return real(f"bluerov2_tank/run_{run}.csv")


@cache
def calibrated(left_out: str) -> Vehicle:
    """The library's BlueROV2 calibrated on the two other tank runs; kept on disk until code that a calibration uses changes."""
    kept = KEPT / f"tank_without_{left_out}_{source_hash(UNUSED, ('.py', '.toml'))}.toml"
    if not kept.exists():
        found = calibrate([open_run(tank(run)) for run in RUNS if run != left_out], vehicle.load("bluerov2_heavy"))
        write_text(kept, to_toml(found.vehicle))
    return vehicle.load(kept)


def without_surge_drag(whole: Vehicle) -> Vehicle:
    body = whole.body
    keep = (LEFT, 1.0, 1.0, 1.0, 1.0, 1.0)
    linear, quadratic = (tuple(np.multiply(keep, np.array(drag, dtype=float)).tolist()) for drag in (body.linear_drag, body.quadratic_drag))
    return whole.model_copy(update={"body": body.model_copy(update={"linear_drag": linear, "quadratic_drag": quadratic})})


def off(key: str, value: float) -> Callable[[Vehicle], Vehicle]:
    """The vehicle with one unknown of a calibration off by ``value``, the logarithm of a factor or an offset."""

    def change(whole: Vehicle) -> Vehicle:
        [one] = [u for u in unknowns(whole, CHANNELS) if u.key == key]
        return applied(whole, [one], np.array([value]))

    return change


def leaning(whole: Vehicle) -> Vehicle:
    """The centre of gravity to starboard."""
    x, y, z = whole.body.centre_of_gravity
    return whole.model_copy(update={"body": whole.body.model_copy(update={"centre_of_gravity": (x, y + SHIFT, z)})})


def dead(thruster: str) -> Callable[[Vehicle], Vehicle]:
    return lambda whole: vehicle.parse(with_effects(whole, [f"thruster_degraded[{thruster}]:loss=1"]), "dead thruster")


def as_it_is(whole: Vehicle) -> Vehicle:
    return whole


def velocity_late(path: Path) -> Run:
    """The velocity log stamped late."""
    run = open_run(path)
    k = round(LATE_S / run.dt)
    values, reasons = dict(run.values), dict(run.reasons)
    for c in "uvw":
        values[c] = np.concatenate([np.full(k, values[c][0]), values[c][:-k]])
        reasons[c] = np.concatenate([np.full(k, reasons[c][0]), reasons[c][:-k]])
    return replace(run, values=values, reasons=reasons)


def velocity_turned(path: Path) -> Run:
    """The velocity sensor's frame turned to starboard, in the log as it is written: what alignment makes of it is a part of the question."""
    log = pl.read_csv(path, infer_schema_length=None)
    u, v = log["u_mps"].to_numpy(), log["v_mps"].to_numpy()
    c, s = math.cos(TURNED), math.sin(TURNED)
    with tempfile.TemporaryDirectory() as folder:
        turned = Path(folder) / path.name
        log.with_columns(u_mps=pl.Series(c * u + s * v), v_mps=pl.Series(c * v - s * u)).write_csv(turned)
        return open_run(turned, "bluerov2_tank")


DRAG = ("linear_drag[surge]", "quadratic_drag[surge]")
PIECES: dict[str, tuple[Callable[[Vehicle], Vehicle], Callable[[Path], Run], tuple[str, ...]]] = {
    "nothing": (as_it_is, open_run, ()),
    "surge drag": (without_surge_drag, open_run, DRAG),
    "T2 at 0.6": (off("thrust.single[T2]", math.log(WEAK)), open_run, ("thruster_degraded[T2]",)),
    "T2 at 1/0.6": (off("thrust.single[T2]", -math.log(WEAK)), open_run, ("thruster_degraded[T2]",)),
    "T6 dead": (dead("T6"), open_run, ("thruster_degraded[T6]",)),
    "buoyancy, 3 N": (off("trim.buoyancy", LIFT), open_run, ("buoyancy_error",)),
    "centre of gravity, 2 cm": (leaning, open_run, ("cg_offset",)),
    "velocity 0.4 s late": (as_it_is, velocity_late, ("time_offset[velocity]",)),
    "velocity turned by 10 degrees": (as_it_is, velocity_turned, ("dvl_misalignment",)),
}


def questions(run: str) -> tuple[Question, ...]:
    whole = calibrated(run)
    return tuple(
        Question(piece, (tank(run),), to_toml(change(whole)), right, read, to_toml(whole))
        for piece, (change, read, right) in PIECES.items()
    )


def knocked_out(run: str) -> tuple[Answer, ...]:
    """The answers on one run, in the order of the pieces."""
    return ask(questions(run))
