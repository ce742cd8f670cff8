"""Made-up runs and simulations for the tests of comparing and reporting: smooth motion, no simulator involved."""

from __future__ import annotations

import numpy as np

from rovval import vehicle
from rovval.channels import POSE, VELOCITIES
from rovval.data import Array, ClockReport, Reason, Resampled, Run, SimResult, Trajectory
from rovval.errors import Finding
from rovval.frames import euler_rates, rotation_from_euler, wrap

DT = 0.1


def motion(n: int) -> tuple[Array, Array]:
    """Velocity and pose (n, 6) of a plausible dive, the pose integrated from the velocity."""
    t = np.arange(n) * DT
    nu = np.stack(
        [
            0.45 + 0.3 * np.sin(t / 11) + 0.05 * np.sin(t / 2.3),
            0.08 * np.sin(t / 7 + 1),
            0.05 * np.sin(t / 17),
            0.03 * np.sin(t / 1.7),
            0.02 * np.cos(t / 2.1),
            0.15 * np.sin(t / 9) + 0.05 * np.sin(t / 3.1),
        ],
        axis=1,
    )
    eta = np.zeros((n, 6))
    eta[0] = [0, 0, 12.0, 0.02, -0.01, 3.0]
    for k in range(n - 1):
        eta[k + 1, :3] = eta[k, :3] + DT * rotation_from_euler(eta[k, 3:]) @ nu[k, :3]
        eta[k + 1, 3:] = eta[k, 3:] + DT * euler_rates(eta[k, 3:], nu[k, 3:])
    eta[:, 3:] = wrap(eta[:, 3:])
    return nu, eta


def make_run(n: int = 1200, absent: tuple[str, ...] = (), holes: dict[str, slice] | None = None, **properties: str) -> Run:
    """A Merlin run with noise; ``absent`` channels were not logged, ``holes`` are masked as gaps."""
    rng = np.random.default_rng(7)
    nu, eta = motion(n)
    values = {name: nu[:, j] + rng.normal(0, 0.006, n) for j, name in enumerate(VELOCITIES)}
    values |= {name: eta[:, j] + rng.normal(0, 0.004, n) for j, name in enumerate(POSE)}
    values["psi"] = wrap(values["psi"])
    t = np.arange(n) * DT
    for j, name in enumerate(vehicle.load("merlin").thrusters):
        values[f"n:{name}"] = np.round(14 * np.sin(t / 11 + 0.4 * j), 2)
    values = {k: v for k, v in values.items() if k not in absent}
    reasons = {k: np.zeros(n, np.uint8) for k in values}
    for name, where in (holes or {}).items():
        reasons[name][where] = Reason.GAP
    return Run(
        id="dive-0007",
        source="logs/dive_0007.csv",
        sha256="ab" * 32,
        profile="merlin_csv",
        vehicle="merlin",
        t0_ns=1_700_000_000_000_000_000,
        dt=DT,
        values=values,
        reasons=reasons,
        resampled={k: Resampled("mean", n, 0.1, 0.2, 0.5, 1.0) for k in values},
        clock=ClockReport("row", n, n, 0.2, 0.12, 0.83, "offset estimated on yaw"),
        findings=(Finding("gap", "psi", "0.9 s without a value at 61.2 s"), Finding("repeated_row", "row 412", "dropped")),
        properties=properties,
    )


def restarted(n: int, truth_nu: Array, truth_eta: Array, gap: Array, window: int = 100) -> Trajectory:
    """Windows that start on the truth and drift away from it by ``gap`` (6,) with a time constant of 3 s."""
    since = (np.arange(n) % window) * DT
    away = (1 - np.exp(-since / 3.0))[:, None] * gap
    eta = truth_eta.copy()
    eta[:, 2] += since * away[:, 2]
    eta[:, 5] = wrap(eta[:, 5] + since * away[:, 5])
    nu = truth_nu + away * (1 + 0.5 * np.sin(np.arange(n) / 90))[:, None]
    return Trajectory(nu, eta, np.zeros(n, np.uint8), np.arange(n) // window)


def make_sim(run: Run, gap: tuple[float, ...] = (0.06, -0.02, 0.01, 0.002, 0.001, 0.03), stop: int | None = None) -> SimResult:
    """A simulation of `make_run` that is ``gap`` off per axis; from row ``stop`` on the free run has left sane limits."""
    n = len(run)
    nu, eta = motion(n)
    off = np.array(gap)
    reasons = np.zeros(n, np.uint8)
    free_nu, free_eta = nu * 1.08 + off, eta.copy()
    free_eta[:, :2] += 0.02 * np.arange(n)[:, None] * DT
    if stop is not None:
        reasons[stop:] = Reason.STOPPED
        free_nu[stop:] = np.nan
        free_eta[stop:] = np.nan
    names = vehicle.load(run.vehicle).thrusters
    speed = run.stack(tuple(f"n:{t}" for t in names))
    return SimResult(
        run_id=run.id,
        vehicle=run.vehicle,
        vehicle_hash=vehicle.load(run.vehicle).hash,
        model="fossen",
        effects=(),
        window_s=10.0,
        dt=DT,
        thrusters=names,
        input_source="measured thruster speed (n)",
        free=Trajectory(free_nu, free_eta, reasons, np.zeros(n, np.int64)),
        windowed=restarted(n, nu, eta, off),
        thruster_speed=speed,
        thrust=0.05 * speed * np.abs(speed),
        assumptions=("water at rest", "tether not modelled"),
        stops=() if stop is None else (f"free run: pitch beyond 80 deg at {stop * DT:.1f} s",),
    )
