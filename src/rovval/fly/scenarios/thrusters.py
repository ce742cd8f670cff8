"""Scenario 2 (thesis 4.3, tables 4.3 and 4.4): each thruster alone from 0 to 70 rpm and back to 0.

Expected: thrust varies with the thruster's speed, and the vehicle starts to move accordingly. Thrust at 70 rpm is table 6.1.
"""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array
from rovval.fly.scenarios import Check, Outcome
from rovval.fly.scenarios.still_water import swim
from rovval.vehicle.model import Vehicle, allocation

TOP_RPM = 70.0
RAMP_S, HOLD_S = 10.0, 10.0
START_S = 5.0  # chosen: when the vehicle starts to move; later it turns, and then it swims another way than it is pushed


def thrusters(vehicle: Vehicle, model: str) -> Outcome:
    """Ramp every thruster in turn, alone, and compare how the vehicle starts with the way that it is pushed."""
    ramp = _ramp()
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
                f"{name}: its thrust follows its speed, no other pushes", f"{peak:.4g} N at {TOP_RPM:g} rpm", follows and alone
            )
        )
        power = float(push[:, j] @ (sim.free.nu[_START] - drifting))
        checks.append(
            Check(
                f"{name}: the vehicle starts the way that it is pushed",
                f"{power:+.2g} m/s along the thrust after {START_S:g} s",
                power > 0,
            )
        )
        rows.append({"thruster": name, "rpm": TOP_RPM, "thrust_n": peak})
    return Outcome(
        2, "each thruster from 0 to 70 rpm and back", vehicle.name, model, tuple(checks), document={"table_6_1": rows}
    )


_START = round(START_S * 10)


def _ramp() -> Array:
    up = np.linspace(0.0, TOP_RPM, round(RAMP_S * 10) + 1)
    return np.concatenate([up, np.full(round(HOLD_S * 10), TOP_RPM), up[::-1]])
