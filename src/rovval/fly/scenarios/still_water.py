"""A made-up Run in still water: thruster speeds that a scenario commands, at rest at the start. Nothing in it was measured."""

from __future__ import annotations

import numpy as np

from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import RATE_HZ, Array, ClockReport, Reason, Run, SimResult
from rovval.simulation import simulate
from rovval.vehicle.model import Vehicle

DEPTH_M = 100.0  # chosen: still under water after the eight minutes of the protocol in the library's lightest vehicle, which rises 0.17 m/s
RPM = 1.0 / 60.0


AT_REST = (0.0, 0.0, DEPTH_M, 0.0, 0.0, 0.0)


def commanded(vehicle: Vehicle, speed_rpm: Array, name: str, pose: tuple[float, ...] = AT_REST) -> Run:
    """A run whose thrusters turn as ``speed_rpm`` (n, k) says at 10 Hz, started at rest at a ``pose`` (x y z phi theta psi; m, rad)."""
    n = len(speed_rpm)
    values = {f"n:{thruster}": speed_rpm[:, j] * RPM for j, thruster in enumerate(vehicle.thrusters)}
    start = np.full(n, np.nan)
    start[0] = 0.0
    values |= dict.fromkeys((*VELOCITIES, *POSE), start)
    values |= {channel: start + value for channel, value in zip(POSE, pose, strict=True)}
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


def swim(vehicle: Vehicle, speed_rpm: Array, model: str, name: str, pose: tuple[float, ...] = AT_REST) -> SimResult:
    """The simulator's motion under these speeds from rest at a ``pose``."""
    return simulate(commanded(vehicle, speed_rpm, name, pose), vehicle, model)


def unmeasured(sim: SimResult) -> Run:
    """A run as long as a simulation in which nothing was measured: what a recording of the motion alone stands on."""
    n = len(sim.free.ok)
    reasons = np.full(n, Reason.NOT_LOGGED, dtype=np.uint8)
    return Run(
        id=f"{sim.run_id}-{sim.model}", source="scenario", sha256="", profile="", vehicle=sim.vehicle, t0_ns=None, dt=sim.dt,
        values={"x": np.full(n, np.nan)}, reasons={"x": reasons}, resampled={},
        clock=ClockReport("row", n, n, sim.dt, None, None, "commanded, not recorded"), properties={},
    )  # fmt: skip
