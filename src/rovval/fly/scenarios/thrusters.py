"""Scenario 2 (thesis 4.3, tables 4.3 and 4.4): each thruster alone from 0 to 70 rpm and back to 0, or to as much as that is on another vehicle.

Expected: thrust varies with the thruster's speed, and the vehicle starts to move accordingly. Merlin's thrust at 70 rpm is table 6.1.
"""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.fly.scenarios import Check, Outcome
from rovval.fly.scenarios.speed import COUNTS, scenario_rpm
from rovval.fly.scenarios.still_water import swim
from rovval.vehicle.model import Vehicle, allocation

RAMP_S, HOLD_S, REST_S = 10.0, 10.0, 30.0
START_S = 5.0  # chosen: when the vehicle starts to move; later it turns, and then it swims another way than it is pushed


def thrusters(vehicle: Vehicle, model: str, rpm: float | None = None) -> Outcome:
    """Ramp every thruster in turn, alone, and compare how the vehicle starts with the way that it is pushed."""
    top = scenario_rpm(vehicle, rpm)
    ramp = _ramp(top)
    still = np.zeros((len(ramp), len(vehicle.thrusters)))
    drifting = swim(vehicle, still, model, "scenario-2-still").free.nu[_START]
    push = allocation(vehicle)
    checks, rows = [], []
    for j, name in enumerate(vehicle.thrusters):
        speed = still.copy()
        speed[:, j] = ramp
        sim = swim(vehicle, speed, model, f"scenario-2-{name}")
        thrust = sim.thrust[:, j]
        peak = float(thrust[np.argmax(np.abs(thrust))])
        follows = bool((np.diff(np.abs(thrust)) * np.diff(ramp) >= 0).all()) and peak != 0 and abs(float(thrust[-1])) < 1e-9
        alone = bool((np.delete(sim.thrust, j, axis=1) == 0).all())
        checks.append(
            Check(
                f"{name}: its thrust follows its speed, no other pushes", f"{peak:.4g} N at {top:.4g} rpm", follows and alone
            )
        )
        power = float(push[:, j] @ (sim.free.nu[_START] - drifting))
        checks.append(
            Check(
                f"{name}: the vehicle starts the way that it is pushed, by more than {COUNTS:g} m/s",
                f"{power:+.2g} m/s along the thrust after {START_S:g} s",
                power > COUNTS,
            )
        )
        rows.append({"thruster": name, "rpm": top, "thrust_n": peak})
    return Outcome(
        2, "each thruster alone, up and back", vehicle.name, model, tuple(checks), document={"fastest_rpm": top, "table_6_1": rows},
        motion=swim(vehicle, _one_after_the_other(ramp, len(vehicle.thrusters)), model, "scenario-2"),
    )  # fmt: skip


_START = round(START_S * 10)


def _ramp(top: float) -> Array:
    up = np.linspace(0.0, top, round(RAMP_S * 10) + 1)
    return np.concatenate([up, np.full(round(HOLD_S * 10), top), up[::-1]])


def _one_after_the_other(ramp: Array, count: int) -> Array:
    """Speeds (n, count) of all thrusters in one run, each with a rest after it: what the thesis's figures show."""
    length = len(ramp) + round(REST_S * 10)
    out = np.zeros((count * length, count))
    for j in range(count):
        out[j * length : j * length + len(ramp), j] = ramp
    return out
