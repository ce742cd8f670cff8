"""A made-up Run in still water: thruster speeds that a scenario commands, at rest at the start. Nothing in it was measured."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import RATE_HZ, Array, ClockReport, Reason, Run, SimResult
from rovval.simulation import simulate
from rovval.vehicle.model import Vehicle

DEPTH_M = 20.0  # chosen: far from the surface and from any bottom
RPM = 1.0 / 60.0


def commanded(vehicle: Vehicle, speed_rpm: Array, name: str) -> Run:
    """A run whose thrusters turn as ``speed_rpm`` (n, k) says at 10 Hz, started at rest at 20 m depth."""
    n = len(speed_rpm)
    values = {f"n:{thruster}": speed_rpm[:, j] * RPM for j, thruster in enumerate(vehicle.thrusters)}
    start = np.full(n, np.nan)
    start[0] = 0.0
    values |= dict.fromkeys((*VELOCITIES, *POSE), start)
    values["z"] = start + DEPTH_M
    reasons = {c: np.where(np.isfinite(v), Reason.OK, Reason.NOT_LOGGED).astype(np.uint8) for c, v in values.items()}
    clock = ClockReport("row", n, n, 1.0 / RATE_HZ, None, None, "commanded, not recorded")
    return Run(
        id=name,
        source="scenario",
        sha256="",
        profile="",
        vehicle=vehicle.name,
        t0_ns=None,
        dt=1.0 / RATE_HZ,
        values=values,
        reasons=reasons,
        resampled={},
        clock=clock,
        properties={"synthetic": "commanded by a scenario, nothing was measured"},
    )


def swim(vehicle: Vehicle, speed_rpm: Array, model: str, name: str) -> SimResult:
    """The simulator's motion under these speeds."""
    return simulate(commanded(vehicle, speed_rpm, name), vehicle, model)
