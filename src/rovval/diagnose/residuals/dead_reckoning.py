"""Dead reckoning of the windows: measured velocities through the measured attitude, less the measured pose."""

from __future__ import annotations

import numpy as np

from rovval.core.data import Array, Flags
from rovval.core.frames import euler_rates, rotation_from_euler, wrap
from rovval.diagnose.criteria import PARITY_MEASURED_SHARE
from rovval.diagnose.windows.windows import Windows

ROW_EVERY = 10  # samples between rows of a window: poses 1 s apart, whose errors are nearly independent
RELATIONS = ("x", "y", "z", "phi", "theta", "psi")
MARGIN = 15  # samples before and after a window that a sensor's memory needs: the longest delay of the library, 1.5 s


def measured_motion(windows: Windows) -> tuple[Array, Array, Flags]:
    """Velocities and poses of the windows and the `MARGIN` before and after them (m, MARGIN + n + MARGIN, 6), gaps bridged linearly, and which relations
    the log can serve (6,). Beyond the log's ends the vehicle moves on as it does there."""
    run = windows.run
    nu = np.stack([_bridged(run.get(c)) for c in ("u", "v", "w", "p", "q", "r")], axis=-1)
    eta = np.stack([_bridged(run.get(c), angle=c in RELATIONS[3:]) for c in RELATIONS], axis=-1)
    nu, eta = _gone_on(nu, eta, run.dt)
    at = windows.start[:, None] + np.arange(windows.steps + 1 + 2 * MARGIN)[None, :]
    nu, eta = nu[at], eta[at]
    attitude = all(run.measured(c) for c in RELATIONS[3:])
    linear = attitude and all(run.measured(c) for c in ("u", "v", "w"))
    angular = attitude and all(run.measured(c) for c in ("p", "q", "r"))
    return nu, eta, np.array([(linear if i < 3 else angular) and run.measured(c) for i, c in enumerate(RELATIONS)])


def without_margin(samples: Array) -> Array:
    """The windows themselves of `measured` samples."""
    return samples[:, MARGIN:-MARGIN]


def fully_measured(windows: Windows) -> Flags:
    """Windows (m,) in which velocity and attitude were measured nearly throughout (bridged gaps would look like faults)."""
    run = windows.run
    at = windows.start[:, None] + np.arange(windows.steps + 1)[None, :]
    needed = [c for c in ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi") if run.measured(c)]
    return np.asarray(np.all([run.ok(c)[at].mean(axis=1) > PARITY_MEASURED_SHARE for c in needed], axis=0))


def pose_drift(nu: Array, eta: Array, dt: float) -> Array:
    """Dead-reckoned less measured pose (m, rows, 6) at every row, mean of the window taken out. Trapezoidal rule."""
    world = np.einsum("mnij,mnj->mni", rotation_from_euler(eta[..., 3:]), nu[..., :3])
    rates = np.concatenate([world, euler_rates(eta[..., 3:], nu[..., 3:])], axis=-1)
    path = np.concatenate([np.zeros_like(rates[:, :1]), np.cumsum(0.5 * dt * (rates[:, 1:] + rates[:, :-1]), axis=1)], axis=1)
    off = wrap_angles(eta[:, :1] + path - eta)
    off[..., 3:] = np.unwrap(off[..., 3:], axis=1)
    rows = off[:, ::ROW_EVERY]
    return np.asarray(rows - rows.mean(axis=1, keepdims=True))


def wrap_angles(rows: Array) -> Array:
    """Differences of the last three relations (angles) wrapped; rows (..., 6 relations)."""
    out = np.array(rows)
    out[..., 3:] = wrap(out[..., 3:])
    return out


def _gone_on(nu: Array, eta: Array, dt: float) -> tuple[Array, Array]:
    """The log with `MARGIN` samples more at both ends, at the mean velocities of as many samples there."""
    steps = np.arange(1, MARGIN + 1)[:, None] * dt
    ahead, after = nu[:MARGIN].mean(axis=0), nu[-MARGIN:].mean(axis=0)
    before = eta[0] - steps[::-1] * _rates(ahead, eta[0])
    behind = eta[-1] + steps * _rates(after, eta[-1])
    return np.concatenate([np.tile(ahead, (MARGIN, 1)), nu, np.tile(after, (MARGIN, 1))]), np.concatenate([before, eta, behind])


def _rates(nu: Array, eta: Array) -> Array:
    """Change of one pose (6,) per second."""
    world = rotation_from_euler(eta[None, 3:])[0] @ nu[:3]
    return np.concatenate([world, euler_rates(eta[None, 3:], nu[None, 3:])[0]])


def _bridged(values: Array, angle: bool = False) -> Array:
    good = np.isfinite(values)
    if not good.any():
        return np.zeros_like(values)
    line = np.interp(np.arange(len(values)), np.flatnonzero(good), np.unwrap(values[good]) if angle else values[good])
    return np.asarray(line)
