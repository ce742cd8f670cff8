"""Scenario 2 (thesis 4.3, tables 4.3 and 4.4): each thruster alone from 0 to 70 rpm and back to 0.

Expected: thrust varies with the thruster's speed, and the vehicle starts to move accordingly. Thrust at 70 rpm is table 6.1.
"""

from __future__ import annotations

import numpy as np

from rovval.channels import AXES
from rovval.data import Array
from rovval.scenarios import Check, Outcome
from rovval.scenarios.still_water import swim
from rovval.vehicle.model import Vehicle, allocation

TOP_RPM = 70.0
RAMP_S, HOLD_S = 10.0, 10.0


def thrusters(vehicle: Vehicle, model: str) -> Outcome:
    """Ramp every thruster in turn, alone, and compare the first motion with the way it pushes."""
    ramp = _ramp()
    push = allocation(vehicle)
    checks, rows = [], []
    for j, name in enumerate(vehicle.thrusters):
        speed = np.zeros((len(ramp), len(vehicle.thrusters)))
        speed[:, j] = ramp
        sim = swim(vehicle, speed, model, f"scenario-2-{name}")
        thrust, peak = sim.thrust[:, j], float(np.abs(sim.thrust[:, j]).max())
        follows = bool((np.diff(thrust) * np.diff(ramp) >= 0).all()) and peak > 0 and abs(float(thrust[-1])) < 1e-9
        alone = bool((np.delete(sim.thrust, j, axis=1) == 0).all())
        axis, moves = _moves(push[:, j], sim.free.nu)
        checks.append(
            Check(
                f"{name}: thrust follows its speed, no other thruster pushes",
                f"{peak:.1f} N at {TOP_RPM:g} rpm",
                follows and alone,
            )
        )
        checks.append(
            Check(
                f"{name}: the vehicle moves the way that it pushes ({axis})",
                f"{moves:+.3f} {'m/s' if axis in AXES[:3] else 'rad/s'}",
                moves > 0,
            )
        )
        rows.append({"thruster": name, "rpm": TOP_RPM, "thrust_n": float(thrust[np.argmax(np.abs(thrust))])})
    return Outcome(
        2, "each thruster from 0 to 70 rpm and back", vehicle.name, model, tuple(checks), document={"table_6_1": rows}
    )


def _ramp() -> Array:
    up = np.linspace(0.0, TOP_RPM, round(RAMP_S * 10) + 1)
    return np.concatenate([up, np.full(round(HOLD_S * 10), TOP_RPM), up[::-1]])


def _moves(wrench: Array, nu: Array) -> tuple[str, float]:
    """The linear axis that the thruster pushes most, and how far the vehicle's largest velocity on it goes that way."""
    i = int(np.argmax(np.abs(wrench[:3])))
    towards = nu[:, i] * np.sign(wrench[i])
    return AXES[i], float(towards[np.nanargmax(np.abs(towards))])
