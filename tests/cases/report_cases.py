"""Made-up runs and simulations for the tests of comparing and reporting: smooth motion, no simulator involved."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from rovval import vehicle
from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array, ClockReport, Reason, Resampled, Run, SimResult, Trajectory
from rovval.core.errors import Finding
from rovval.core.frames import euler_rates, rotation_from_euler, wrap
from rovval.diagnose.result.diagnosis import Diagnosis

DT = 0.1


@cache
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


def diagnosis(**changes: Any) -> Diagnosis:
    """A full diagnosis with the keys ``changes`` of its document as they are given here."""
    return Diagnosis.read(make_diagnosis() | changes)


def detection(noise: float, tolerance: float, departure: float = 0.0) -> dict[str, float]:
    """What a verdict rests on, where noise and coefficients within their tolerances account for these shares of the gap."""
    zero = ("p_value", "last_p", "last_evidence", "null_evidence", "causes", "generic_instead", "generic_beside")
    return dict.fromkeys(zero, 0.0) | {"noise": noise, "tolerance_share": tolerance, "largest_departure": departure}


def make_diagnosis() -> dict[str, Any]:
    """A full diagnosis document: one cause in a group of two, every picture."""
    t = np.arange(0, 60, DT)
    real = 0.4 + 0.3 * np.sin(t / 8)
    effects = ["inflow_loss", "quadratic_drag[surge]", "linear_drag[surge]", "tether_drag", "thruster_degraded[HFP]", "rpm_scale"]
    unit = {"surge": "m/s", "sway": "m/s", "heave": "m/s", "roll": "rad/s", "pitch": "rad/s", "yaw": "rad/s"}
    shares = {"surge": 0.78, "sway": 0.04, "heave": 0.03, "roll": 0.01, "pitch": 0.01, "yaw": 0.13}
    gap = {
        a: {"unit": unit[a], "rms": 0.09 * s + 0.004, "iae": 16 * s + 1, "floor_rms": 0.004, "share": s} for a, s in shares.items()
    }
    regimes = ["u > 0.6 m/s", "u 0.3 to 0.6 m/s", "u < 0.3 m/s", "|r| > 8 deg/s", "depth > 15 m", "HFP forward", "HFP reverse", "transient"]
    grid = np.random.default_rng(5).uniform(0, 0.2, (6, len(regimes)))
    grid[0, 0], grid[0, 5], grid[5, 3] = 0.64, 0.41, 0.5
    alike = np.random.default_rng(6).uniform(0, 0.5, (6, 6))
    alike = np.round((alike + alike.T) / 2, 3)
    alike[0, 1] = alike[1, 0] = 0.97
    np.fill_diagonal(alike, 1.0)
    total = {"total": 0.66, "low": 0.58, "high": 0.72, "of_explainable": 0.86}
    where = [
        {"axis": "surge", "regime": "u > 0.6 m/s", "share": 0.64, "time_share": 0.22, "lift": 2.9},
        {"axis": "yaw", "regime": "|r| > 8 deg/s", "share": 0.5, "time_share": 0.3, "lift": 1.7},
    ]
    steps = [(0, 20, 400), (20, 20, 800), (40, 20, 1100), (60, 30, 0), (90, 20, -700)]
    return {
        "schema": "rovval.diagnosis/1",
        "run": "dive-0007",
        "vehicle": "merlin",
        "model": "fossen",
        "window_s": 10.0,
        "calibration_slop": 0.05,
        "verdict": "partly_explained",
        "gap": {"axes": gap, "where": where, "change_points_s": [412.3]},
        "causes": [
            {
                "effect": "inflow_loss",
                "group": ["inflow_loss", "quadratic_drag[surge]"],
                "probability": 0.71,
                "onset_s": None,
                "parameters": {
                    "loss": {"value": 0.31, "low": 0.26, "high": 0.36, "unit": "1"},
                    "lag": {"value": 0.12, "low": -0.02, "high": 0.24, "unit": "s"},
                },
                "shrinkage": {**total, "axes": {"surge": 0.71, "sway": 0.05, "yaw": -0.08}, "axes_interval": {"surge": {"low": 0.6, "high": 0.8}}},
            }
        ],
        "shrinkage": {**total, "held_out": True},
        "ranking": [{"effect": e, "score": s} for e, s in zip(effects, (0.66, 0.64, 0.41, 0.22, 0.05, -0.02), strict=True)],
        "not_testable": [{"effect": "ground_effect", "why": "no altitude below 3 m in this log"}],
        "next_experiment": {"manoeuvre": "surge staircase with a coast-down", "separates": ["inflow_loss", "quadratic_drag[surge]"]},
        "heatmap": {"axes": list(shares), "regimes": regimes, "share": grid.tolist(), "lift": (grid * 5).tolist()},
        "traces": [
            {
                "title": f"{axis}, {start} to {start + 60} s",
                "axis": axis,
                "unit": u,
                "t_s": (t + start).tolist(),
                "measured": real.tolist(),
                "nominal": (real * 1.2).tolist(),
                "corrected": (real * 1.04).tolist(),
            }
            for axis, u, start in (("surge", "m/s", 310), ("yaw", "rad/s", 122))
        ],
        "coherence": {"effects": effects, "matrix": alike.tolist()},
        "parity": [
            {
                "check": "yaw rate against heading",
                "fault": "gyro_bias",
                "value": 0.002,
                "low": 0.0015,
                "high": 0.0026,
                "unit": "rad/s",
                "significant": True,
                "note": "",
            },
            {
                "check": "depth rate against w",
                "fault": "dvl_scale",
                "value": 0.004,
                "low": -0.01,
                "high": 0.02,
                "unit": "1",
                "significant": False,
                "note": "little vertical motion",
            },
        ],
        "disturbance": {
            "surge": {"rms": 0.18, "unit": "N", "memory_s": 1.5},
            "sway": {"rms": 4.0, "unit": "N", "memory_s": 0.62},
            "heave": {"rms": 0.0, "unit": "N", "memory_s": 0.0},
            "yaw": {"rms": 0.012, "unit": "N m", "memory_s": 2.0},
        },
        "harm": [{"axis": "yaw", "change": 0.08}],
        "left": {"axes": ["yaw"], "depends_on": ["turn rate"], "text": "0.9 deg/s rms in yaw that grows with the turn rate"},
        "manoeuvre": {
            "name": "surge staircase with a coast-down",
            "text": "Three steps ahead at rising speed, thrusters off for 30 s, then astern.",
            "schedule": [
                {"t_s": float(t0), "duration_s": float(d), "thrusters": {"HFP": float(n), "HFS": float(n)}} for t0, d, n in steps
            ],
        },
    }
