"""How far a vehicle's thrusters were driven in the logs that it was calibrated on, and which thrusters of another log go beyond that.

The numbers stand in the vehicle file's table `[calibration]`, one a thruster and way: thrust and drag beyond them are extrapolated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Run
from rovval.core.errors import BadInput, Finding
from rovval.simulation.actuation import recorded_actuation
from rovval.vehicle.model import Vehicle

WAYS = {"ahead": 1.0, "astern": -1.0}  # of a thruster, with the sign of its speed
BEYOND = 0.1  # of the largest fitted command: a tenth in speed is a fifth in thrust, as much as coefficients of the literature differ by
IDLE = 0.1  # of the largest command of all: a thruster that turns slower gives a hundredth of the thrust, and a sensor's noise is no command


def largest(speeds: Sequence[Array], vehicle: Vehicle) -> dict[str, float]:
    """The largest command (rpm) of each thruster, ahead and astern, in ``speeds`` (n, k) rev/s of several logs, by its key in `[calibration]`."""
    every = np.concatenate(speeds) * 60.0
    top = {way: np.maximum((every * sign).max(axis=0), 0.0) for way, sign in WAYS.items()}
    return {_key(name, way): round(float(top[way][k]), 1) for k, name in enumerate(vehicle.thrusters) for way in WAYS}


def fitted(vehicle: Vehicle) -> Mapping[str, float]:
    """What `largest` said of the logs that the vehicle was calibrated on; empty where its file does not say."""
    keys = [_key(name, way) for name in vehicle.thrusters for way in WAYS]
    return {key: vehicle.calibration[key] for key in keys if key in vehicle.calibration}


@dataclass(frozen=True, slots=True)
class Excess:
    """A ``thruster`` that a log drives ``way`` (ahead or astern) to ``worst`` rpm, where the logs of the fit reached ``limit`` rpm, on ``count`` of its
    ``rows``; ``idle``: there it had hardly turned."""

    thruster: str
    way: str
    worst: float
    limit: float
    count: int
    rows: int
    idle: bool


def excesses(speed: Array, limits: Mapping[str, float], vehicle: Vehicle) -> tuple[Excess, ...]:
    """Where ``speed`` (n, k) rev/s goes more than a tenth beyond ``limits`` as `largest` gives them, thruster by thruster."""
    rpm, idle = speed * 60.0, IDLE * max(limits.values(), default=0.0)
    found = []
    for k, name in enumerate(vehicle.thrusters):
        for way, sign in WAYS.items():
            limit, driven = limits.get(_key(name, way)), sign * rpm[:, k]
            if limit is not None and (over := driven > max((1.0 + BEYOND) * limit, idle)).any():
                found.append(Excess(name, way, float(driven.max()), limit, int(over.sum()), len(driven), limit <= idle))
    return tuple(found)


def beyond_fitted(run: Run, vehicle: Vehicle) -> tuple[Finding, ...]:
    """A finding for each thruster that the log drives more than a tenth beyond the logs that the vehicle was calibrated on.

    Empty where no channels cover every thruster: `recorded_actuation` refuses such a run.
    """
    if not (limits := fitted(vehicle)):
        return ()
    try:
        actuation = recorded_actuation(run, vehicle)
    except BadInput:
        return ()
    by_thruster: dict[str, list[str]] = {}
    for one in excesses(actuation.inputs.speed[actuation.known], limits, vehicle):
        reached = f"the next to nothing ({one.limit:.4g} rpm)" if one.idle else f"the {one.limit:.4g} rpm"
        far = "beyond" if one.idle else f"{100.0 * (one.worst / one.limit - 1.0):.0f} % beyond"
        said = f"{one.way} up to {one.worst:.4g} rpm, {far} {reached} of the logs that {vehicle.name} was fitted on ({one.count} of {one.rows} values)"
        by_thruster.setdefault(one.thruster, []).append(said)
    more = "the vehicle was not fitted there, its thrust and drag are extrapolated; fit it with this log, too"
    return tuple(Finding("beyond_fit", name, f"{'; '.join(said)}: {more}") for name, said in by_thruster.items())


def _key(thruster: str, way: str) -> str:
    return f"command.{way}[{thruster}]"
