"""Logs of a motion that no dynamics made, as faulty sensors log it: pose and velocity agree exactly but for the faults."""

from __future__ import annotations

import functools

import numpy as np
from diagnose_case import NOISE, bare, merlin

from rovval.core.data import Array, Run
from rovval.core.frames import euler_rates, rotation_from_euler


@functools.cache
def kinematic(seed: int, seconds: float = 300.0) -> dict[str, Array]:
    """Motion that no vehicle's dynamics made: smooth random velocities, integrated in numpy at 10 ms, pose and velocity exact."""
    n, fine, rng = round(10 * seconds), 100, np.random.default_rng(seed)
    t = np.arange(n * fine) * 0.1 / fine
    size = np.array([0.6, 0.3, 0.15, 0.02, 0.02, 0.15])
    waves = [(rng.uniform(0.05, 0.6, 6), rng.uniform(0, 6.28, 6)) for _ in size]
    nu: Array = np.stack([a * np.sin(np.outer(t, f) + p).sum(axis=1) / 2 for a, (f, p) in zip(size, waves, strict=True)], axis=1)
    eta = np.empty((n, 6))
    state: Array = np.array([0, 0, 30.0, 0, 0, 0.5])
    for i in range(len(t)):
        if i % fine == 0:
            eta[i // fine] = state
        if i % 10 == 0:  # Euler steps of 10 ms are ample for pose over a window of 10 s
            middle = np.asarray(nu[min(i + 5, len(t) - 1)])
            world = np.einsum("ij,j->i", rotation_from_euler(state[None, 3:])[0], middle[:3])
            state = np.asarray(state + 0.1 / fine * 10 * np.concatenate([world, euler_rates(state[None, 3:], middle[None, 3:]).ravel()]))
    return dict(zip((*"uvwpqr", "x", "y", "z", "phi", "theta", "psi"), np.concatenate([nu[::fine], eta], axis=1).T, strict=True))


def spoilt(fault: dict[str, float]) -> Run:
    """The motion as sensors with ``fault`` log it, in plain numpy, with noise."""
    log = {c: np.array(x) for c, x in kinematic(8).items()}
    if "dvl_scale.scale" in fault:
        for c in "uvw":
            log[c] = log[c] * (1 + fault["dvl_scale.scale"])
    log["u"] = log["u"] * (1 + fault.get("dvl_scale.surge", 0.0))
    if "dvl_misalignment.yaw" in fault:
        a = fault["dvl_misalignment.yaw"]
        log["u"], log["v"] = np.cos(a) * log["u"] + np.sin(a) * log["v"], np.cos(a) * log["v"] - np.sin(a) * log["u"]
    if "dvl_lever_arm.x" in fault:
        log["v"], log["w"] = log["v"] + fault["dvl_lever_arm.x"] * log["r"], log["w"] - fault["dvl_lever_arm.x"] * log["q"]
    for c in "uvw":
        t = np.arange(len(log[c])) * 0.1
        log[c] = np.interp(t - fault.get("time_offset[velocity].delay", 0.0), t, log[c])
    for c in ("p", "q", "r", "phi", "theta", "psi"):
        log[c] = np.interp(t - fault.get("time_offset[attitude].delay", 0.0), t, log[c])
    for c in "pqr":
        log[c] = log[c] + fault.get(f"gyro_bias.{c}", 0.0)
    for c in ("phi", "theta"):
        log[c] = log[c] + fault.get(f"attitude_bias.{c}", 0.0)
    log["psi"] = log["psi"] + fault.get("compass_deviation.offset", 0.0)
    rng = np.random.default_rng(9)
    seen = {c: x + NOISE[c] * rng.normal(size=len(x)) for c, x in log.items()}
    idle = {f"n:{name}": np.zeros(len(log["u"])) for name in merlin().thrusters}
    return bare(idle | seen, merlin(), "kinematic")
