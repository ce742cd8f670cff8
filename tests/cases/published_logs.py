"""Questions to published logs whose answer their publishers state: ballast, yaw drag, and an outside plant's effects."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
from real_answers import Answer, Question, ask
from real_data import real

from rovval import load, vehicle
from rovval.core.data import Run
from rovval.effects.lanes import reference_speed
from rovval.fit.calibration import calibrate
from rovval.simulation import simulate
from rovval.storage.archive import open_run
from rovval.vehicle.model import Vehicle, as_matrix
from rovval.vehicle.write import to_toml

WITH_BALLAST, POWERED = ("ff_b1", "ff_b2"), tuple(f"exp1_{i}" for i in range(1, 6))
YAW, YAW_DRAG = ("yaw_1", "yaw_2", "yaw_3"), ("linear_drag[yaw]", "quadratic_drag[yaw]")
INFLOW = "thrust.flow[inflow_loss.loss]"
PART_S, PARTS, LEAST_S = 300.0, 3, 20.0  # of the outside plant's logs; what begins in the last seconds of a part shows in none of its windows
YAW_WINDOW_S = 4.0  # the shortest of the logs has thruster inputs for some 15 s
SAME = {  # families of the outside plant, and what the library calls the same by its README: its effects act on all thrusters and axes concerned
    "added_mass": ("added_mass[surge]", "added_mass[sway]", "added_mass[heave]", "added_mass[translation]"),
    "rpm_scale": ("rpm_scale", "voltage_sag"),
    "tether_drag": ("tether_drag", "tether_tension"),
    "stick_slip": ("dragged_load",),  # dry friction of the whole vehicle
    "slosh": ("shifting_ballast",),
}


def _questions(folder: str, logs: tuple[str, ...], nominal: str, right: tuple[str, ...], kind: str = "bag") -> tuple[Question, ...]:
    """Each log by itself, and all of them jointly."""
    paths, of = tuple(real(f"{folder}/{name}.{kind}") for name in logs), to_toml(vehicle.load(nominal))
    together = (Question("jointly", paths, of, right),) if len(paths) > 1 else ()
    return (*(Question("each", (path,), of, right) for path in paths), *together)


def ballast() -> tuple[Answer, ...]:
    """Bags of a BlueROV2: released without ballast, released with, and powered."""
    groups = (("ff_nb1",), WITH_BALLAST, POWERED)
    return ask(tuple(one for logs in groups for one in _questions("bluerov2_ballast", logs, "bluerov2_heavy", ("buoyancy_error",))))


def height_of_thrusters() -> tuple[Answer, ...]:
    """Tank runs of a BlueROV2 by its published file, which prints a height of thrusters that does not act."""
    return ask(_questions("bluerov2_tank", ("run_a", "run_b", "run_c"), "bluerov2_heavy", ("thruster_place",), "csv"))


def yaw_drag() -> tuple[Answer, ...]:
    """Bags of a BlueROV of 2016 that only turns."""
    return ask(_questions("bluerov_2016", YAW, "bluerov_2016", YAW_DRAG))


def yaw_drag_over_thrust(logs: tuple[str, ...]) -> float:
    """Linear drag of yaw (N m s) that takes as much power out of these runs as the calibrated vehicle's linear and quadratic drag do, and its loss of thrust by
    inflow, over the factor that the calibration puts on the thrust table: without a measured force nothing but this ratio is seen."""
    runs = [open_run(real(f"bluerov_2016/{name}.bag")) for name in logs]
    found = calibrate(runs, vehicle.load("bluerov_2016"), window_s=YAW_WINDOW_S)
    rate = np.concatenate([run.get("r")[run.ok("r")] for run in runs])
    linear, quadratic = (as_matrix(m)[5, 5] for m in (found.vehicle.body.linear_drag, found.vehicle.body.quadratic_drag))
    factor = {row.unknown.key: row.value for row in found.rows}
    drag = linear + quadratic * (np.abs(rate) ** 3).mean() / (rate**2).mean() + _lost_to_inflow(runs, found.vehicle, factor.get(INFLOW, 0.0))
    return float(drag / (factor["thrust.gain"] * np.sqrt(factor["thrust.astern"])))  # one of the two that turn it is always astern


def _lost_to_inflow(runs: Sequence[Run], of: Vehicle, loss: float) -> float:
    """Moment about z (N m s) that thrusters lose per rate of turn, which moves them through the water: loss k n_ref |n| of each (`effects`: inflow_loss) times
    the square of its lever."""
    lever = np.array([np.cross(one.position, one.direction)[2] for one in of.thruster])
    ahead, astern = (60.0**2 * np.array([getattr(one, gain) for one in of.thruster]) for gain in ("k_pos", "k_neg"))
    speed = np.concatenate([simulate(run, of).thruster_speed for run in runs])
    return float(loss * reference_speed(of) * (np.nanmean(np.abs(speed) * np.where(speed < 0.0, astern, ahead), axis=0) * lever**2).sum())


@cache
def _truth() -> Mapping[str, Any]:
    return dict(json.loads(real("outside_plant/truth.json").read_text(encoding="utf-8")))


def _right(effects: list[Mapping[str, Any]]) -> tuple[str, ...]:
    """Names of the library for what was put in."""
    found = list[str]()
    for one in effects:
        found += SAME.get(one["family"], (f"{one['family']}[{one['params']['unit']}]" if "unit" in one["params"] else one["family"],))
    return tuple(found)


def _of_outside(name: str, effects: list[Mapping[str, Any]], when: str = "", read: Callable[[Path], Run] = open_run) -> Question:
    """What was put into a log of the outside plant, or, as ``read``, into the part of it that is told as ``when``."""
    piece = when + (" and ".join(one["family"] for one in effects) or "healthy")
    return Question(piece, (real(f"outside_plant/{name}.csv.gz"),), to_toml(vehicle.load("merlin")), _right(effects), read)


def _at_work(truth: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """The effects of a log; none where they move no axis, which leaves a healthy one."""
    return truth["effects"] if truth["affected_axes"] else []


def outside_plant(minutes: float) -> tuple[Answer, ...]:
    """Logs of at most ``minutes`` of the outside plant, in order of their names."""
    return ask(tuple(_of_outside(name, _at_work(truth)) for name, truth in sorted(_truth().items()) if truth["minutes"] <= minutes))


def outside_parts() -> tuple[Answer, ...]:
    """Parts of all logs of the outside plant, of `PART_S` and up to twice as much, three of a log at most; what begins after a part is not in it."""
    asked = list[Question]()
    for name, truth in sorted(_truth().items()):
        seconds = 60.0 * truth["minutes"]
        count = max(1, int(seconds // PART_S))
        for i in range(count) if count <= PARTS else (0, count // 2, count - 1):
            start, end = i * seconds / count, (i + 1) * seconds / count
            effects = [one for one in _at_work(truth) if one["onset_s"] < end - LEAST_S]
            asked.append(_of_outside(name, effects, f"{start:.0f} to {end:.0f} s: ", partial(load, start_s=start, end_s=end)))
    return ask(tuple(asked))
