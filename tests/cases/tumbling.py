"""A BlueROV2 that its thrusters turn over and over: logs of the project's own plant through pitch of +-90 degrees and upside down."""

from __future__ import annotations

import functools

import numpy as np
from diagnose_case import NOISE, bare

from rovval import vehicle
from rovval.core.channels import POSE, VELOCITIES
from rovval.core.data import Array, Run
from rovval.core.frames import turned
from rovval.simulation import simulate
from rovval.vehicle.model import Vehicle, allocation

PITCH_N_M, ROLL_N_M, YAW_N_M, PUSH_N = 6.0, 4.0, 1.5, 8.0  # beyond the righting moment of a BlueROV2, so that it goes over


@functools.cache
def bluerov2() -> Vehicle:
    return vehicle.load("bluerov2_heavy")


def commands(v: Vehicle, seed: int, seconds: float) -> Array:
    """Thruster speeds (n, k) rev/s: torque in pitch and roll and pushes ahead and down, each held for 1 to 4 s, with pauses."""
    rng, n = np.random.default_rng(seed), round(seconds * 10)
    wrench = np.zeros((n, 6))
    for axis, size in ((0, PUSH_N), (1, PUSH_N), (2, PUSH_N), (3, ROLL_N_M), (4, PITCH_N_M), (5, YAW_N_M)):
        at = 0
        while at < n:
            length = int(rng.integers(10, 40))
            wrench[at : at + length, axis] = size * rng.choice([-1.0, -0.5, 0.0, 0.5, 1.0])
            at += length
    thrust = wrench @ np.linalg.pinv(allocation(v)).T
    gain = np.where(thrust >= 0, [t.k_pos for t in v.thruster], [t.k_neg for t in v.thruster])
    return np.asarray(np.sign(thrust) * np.sqrt(np.abs(thrust) / gain) / 60.0)


@functools.cache
def tumbling(effects: tuple[str, ...] = (), seed: int = 0, seconds: float = 120.0, noise: float = 1.0) -> Run:
    """A log with ``effects`` in it; the attitude's noise is a turn about the body's axes, as a sensor that is fixed to it has."""
    v = bluerov2()
    speed = commands(v, seed, seconds)
    start = np.full(len(speed), np.nan)
    start[0] = 0.0
    channels = {f"n:{t}": speed[:, j] for j, t in enumerate(v.thrusters)}
    sim = simulate(bare(channels | dict.fromkeys((*VELOCITIES, *POSE), start), v, f"tumbling{seed}"), v, "fossen", effects)
    assert sim.free.ok.all(), sim.stops
    rng = np.random.default_rng([seed, 1])
    nu = sim.free.nu + noise * rng.normal(size=sim.free.nu.shape) * [NOISE[c] for c in VELOCITIES]
    eta = sim.free.eta + noise * rng.normal(size=nu.shape) * [NOISE[c] for c in POSE]
    eta[:, 3:] = turned(sim.free.eta[:, 3:], noise * NOISE["phi"] * rng.normal(size=(len(nu), 3)))
    return bare(channels | dict(zip((*VELOCITIES, *POSE), np.concatenate([nu, eta], axis=1).T, strict=True)), v, f"tumbling{seed}")
