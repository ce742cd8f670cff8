"""Scenario 3 in closed loop (thesis 4.4 and table 4.5): way points in a Cartesian system, steered by the autopilot on the true state.

The thesis prints neither its points nor its gains, and calls both premature (6.4): the points here are a square with a step of depth, in lengths of
the vehicle, and the gains follow from the vehicle's own mass and drag (`rovval.fly.loop.controllers`).
"""

from __future__ import annotations

import numpy as np

from rovval.core.data import Reason, SimResult, Trajectory
from rovval.fly import fly
from rovval.fly.mission import Mission
from rovval.fly.scenarios import Check
from rovval.fly.scenarios.still_water import DEPTH_M
from rovval.plant import Plant
from rovval.vehicle.model import Vehicle

SPEED = 0.2  # m/s: what 70 rpm drive Merlin with in the open loop
SIDE = 4.0  # lengths of the vehicle (chosen)
DEEPER = 1.0  # lengths of the vehicle, half of the way round (chosen)


def square(vehicle: Vehicle) -> Mission:
    """Ahead, to starboard and down, back, and to the start, with time for twice the way at `SPEED`."""
    length = max(vehicle.body.size)
    a, down = SIDE * length, DEPTH_M + DEEPER * length
    points = [(a, 0.0, DEPTH_M), (a, a, down), (0.0, a, down), (0.0, 0.0, DEPTH_M)]
    leg = {"kind": "way_points", "for_s": 30.0 + 8.0 * a / SPEED, "speed_m_s": SPEED, "points": points}
    plan = {"name": "scenario-3-closed", "title": "Way points", "start": {"depth_m": DEPTH_M}, "water": {"surface": False}, "leg": [leg]}
    return Mission.model_validate(plan)


def closed_loop(vehicle: Vehicle, model: str) -> tuple[tuple[Check, ...], SimResult]:
    """Whether each way point is passed within a vehicle's length, and the motion."""
    flight = fly(square(vehicle), vehicle, model)
    length = max(vehicle.body.size)
    checks = tuple(
        Check(f"closed loop: way point {i + 1} passed within a vehicle's length ({length:g} m)", f"{p.distance:.2f} m at {p.at_s:.0f} s", p.distance <= length)
        for i, p in enumerate(flight.passed)
    )
    n = len(flight)
    whole = Trajectory(flight.nu, flight.eta, np.full(n, Reason.OK, dtype=np.uint8), np.zeros(n, dtype=np.int64))
    plant = Plant(vehicle, model)
    sim = SimResult(
        run_id="scenario-3-closed", vehicle=vehicle.name, vehicle_hash=vehicle.hash, model=model, effects=flight.effects, window_s=n * flight.dt,
        dt=flight.dt, thrusters=flight.thrusters, input_source="autopilot", free=whole, windowed=whole, thruster_speed=flight.speed,
        thrust=plant.thrust(flight.speed), stops=flight.stops,
    )  # fmt: skip
    return checks, sim
