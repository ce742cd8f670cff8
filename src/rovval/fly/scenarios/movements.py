"""Scenario 3 (thesis 4.4, tables 4.5 and 4.6): surge, sway, heave and yaw, both ways, 30 s each with 30 s of rest between.

The tables expect nothing in particular. Section 6.4 says which thrusters push which way in each movement: that is held here
for Merlin. For any vehicle, each movement goes the way that was commanded, seen from how its trim moves it with the thrusters still.
"""

from __future__ import annotations

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.fly.scenarios import Check, Outcome
from rovval.fly.scenarios.speed import COUNTS, scenario_rpm
from rovval.fly.scenarios.still_water import swim
from rovval.fly.scenarios.way_points import closed_loop
from rovval.vehicle.model import Vehicle, allocation

MOVE_S, REST_S = 30.0, 30.0
MOVEMENTS = tuple((axis, sign) for axis in ("surge", "sway", "heave", "yaw") for sign in (1, -1))
# Thesis 6.4, T0..T6 = VFP VFS VAC HFP HFS HAP HAS: sign of each thrust. Its "upward" is heave -1 here, where z is down, and its
# "rotate right" is yaw, although it prints roll.
SECTION_6_4 = {
    ("surge", 1): (0, 0, 0, 1, -1, -1, 1),
    ("surge", -1): (0, 0, 0, -1, 1, 1, -1),
    ("sway", 1): (0, 0, 0, 1, 1, 1, 1),
    ("sway", -1): (0, 0, 0, -1, -1, -1, -1),
    ("heave", 1): (1, -1, 1, 0, 0, 0, 0),
    ("heave", -1): (-1, 1, -1, 0, 0, 0, 0),
    ("yaw", 1): (0, 0, 0, 1, 1, -1, -1),
    ("yaw", -1): (0, 0, 0, -1, -1, 1, 1),
}


def protocol(vehicle: Vehicle, rpm: float | None = None) -> Array:
    """Thruster speeds (n, k) rpm at 10 Hz of the movements one after the other, each with its rest; the fastest thruster at `scenario_rpm`."""
    top = scenario_rpm(vehicle, rpm)
    patterns = [_pattern(vehicle, axis, sign, top) for axis, sign in MOVEMENTS]
    return np.vstack([np.vstack([np.tile(p, (round(MOVE_S * 10), 1)), np.zeros((round(REST_S * 10), len(p)))]) for p in patterns])


def movements(vehicle: Vehicle, model: str, rpm: float | None = None) -> Outcome:
    """Command each movement through the pseudo-inverse of the allocation, as a pilot's joystick mapping does."""
    speeds = protocol(vehicle, rpm)
    sim = swim(vehicle, speeds, model, "scenario-3")
    length, moved = round((MOVE_S + REST_S) * 10), round(MOVE_S * 10)
    adrift = swim(vehicle, 0.0 * speeds[: moved + 1], model, "scenario-3-still").free.nu[moved]
    checks, rows = [], []
    for k, (axis, sign) in enumerate(MOVEMENTS):
        i = AXES.index(axis)
        nu = sim.free.nu[k * length : k * length + moved]
        thrust = sim.thrust[k * length + 1]
        reached = float(nu[-1, i])
        unit = "m/s" if i < 3 else "rad/s"
        goes = bool(np.isfinite(reached) and (reached - adrift[i]) * sign > COUNTS)
        beside = f", {adrift[i]:+.3f} with the thrusters still" if abs(adrift[i]) > COUNTS else ""
        checks.append(Check(f"{axis} {sign:+d}: goes that way, by more than {COUNTS:g} {unit}", f"{reached:+.3f} {unit} after {MOVE_S:g} s{beside}", goes))
        if vehicle.name == "merlin":
            signs = np.sign(np.where(np.abs(thrust) > 1e-9, thrust, 0.0))
            agrees = bool((signs == np.array(SECTION_6_4[axis, sign])).all())
            said = " ".join(f"{s:+.0f}" if s else "0" for s in signs)
            checks.append(Check(f"{axis} {sign:+d}: thrusters push as in thesis 6.4", said, agrees))
        rows.append({"axis": axis, "sign": sign, "rpm": speeds[k * length].tolist(), "thrust_n": thrust.tolist(), f"reached_{unit}": reached})
    loop, closed = closed_loop(vehicle, model)  # the thesis steers by way points in Simulink alone (4.4)
    return Outcome(
        3, "movement protocol in open loop, way points in closed loop", vehicle.name, model, (*checks, *loop),
        document={"thrusters": list(vehicle.thrusters), "fastest_rpm": float(np.abs(speeds).max()), "movements": rows}, motion=sim, closed=closed,
    )  # fmt: skip


def _pattern(vehicle: Vehicle, axis: str, sign: int, top: float) -> Array:
    """Speeds (k,) rpm that push along one axis, the fastest at ``top``; a thruster that hardly helps stays still."""
    wrench = np.zeros(6)
    wrench[AXES.index(axis)] = float(sign)
    share = np.linalg.pinv(allocation(vehicle)) @ wrench
    share = np.where(np.abs(share) > 0.05 * np.abs(share).max(), share, 0.0)
    gain = np.array([t.k_pos if s > 0 else t.k_neg for t, s in zip(vehicle.thruster, share, strict=True)])
    rpm = np.sign(share) * np.sqrt(np.abs(share) / gain)
    return np.asarray(top * rpm / np.abs(rpm).max())
