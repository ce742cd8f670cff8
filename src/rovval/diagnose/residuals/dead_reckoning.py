"""Dead reckoning: measured velocities integrated through the measured attitude (Fossen 2021, 2.2: eta' = J(eta) nu), less the measured pose."""

from __future__ import annotations

import numpy as np
from scipy import signal

from rovval.core.data import Array, Flags, Run
from rovval.core.frames import (
    attitude_difference,
    euler_from_quaternion,
    euler_rates,
    rotation_from_euler,
    smooth_quaternions,
    tumbles,
    turned,
    wrap,
)
from rovval.diagnose.criteria import PARITY_MEASURED_SHARE, SMOOTHING
from rovval.diagnose.windows.attitude import tumbling
from rovval.diagnose.windows.windows import Windows

ROW_EVERY = 10  # samples between the poses that are compared: 1 s apart, their errors are nearly independent
RELATIONS = ("x", "y", "z", "phi", "theta", "psi")
MARGIN = 15  # samples before and after a window that a sensor's memory needs: the longest delay of the library, 1.5 s


def measured_motion(windows: Windows) -> tuple[Array, Array, Flags]:
    """Measured motion of the windows with a margin before and after each: (velocities, poses, checkable).

    Velocities and poses are (m, MARGIN + n + MARGIN, 6), SI units and radians, gaps bridged linearly; beyond the log's ends the vehicle goes on at its mean
    velocity there. ``checkable`` (6,) says which components of the pose the log holds with the velocities that they follow from.
    """
    run = windows.run
    nu = np.stack([_bridged(run.get(c)) for c in ("u", "v", "w", "p", "q", "r")], axis=-1)
    eta = np.stack([_bridged(run.get(c), angle=c in RELATIONS[3:]) for c in RELATIONS], axis=-1)
    nu, eta = _extended(nu, eta, run.dt)
    at = windows.start[:, None] + np.arange(windows.steps + 1 + 2 * MARGIN)[None, :]
    nu, eta = nu[at], eta[at]
    attitude = all(run.measured(c) for c in RELATIONS[3:])
    linear = attitude and all(run.measured(c) for c in ("u", "v", "w"))
    angular = attitude and all(run.measured(c) for c in ("p", "q", "r"))
    return nu, eta, np.array([(linear if i < 3 else angular) and run.measured(c) for i, c in enumerate(RELATIONS)])


def without_margin(samples: Array) -> Array:
    """The samples (m, n, 6) of the windows themselves."""
    return samples[:, MARGIN:-MARGIN]


def fully_measured(windows: Windows) -> Flags:
    """Windows (m,) in which velocities and attitude were measured nearly throughout; in others bridged gaps would look like faults."""
    run = windows.run
    at = windows.samples()
    needed = [c for c in ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi") if run.measured(c)]
    return np.asarray(np.all([run.ok(c)[at].mean(axis=1) > PARITY_MEASURED_SHARE for c in needed], axis=0))


def heading_from_start(run: Run) -> bool:
    """Whether the heading counts from where the vehicle began, so that its zero in the position's axes was found from the velocities, if at all."""
    return any(finding.code == "heading_zero" for finding in run.findings)


def pose_drift(nu: Array, eta: Array, run: Run, usable: Flags) -> Array:
    """Dead-reckoned less measured pose (m, rows, 6), m and rad, every `ROW_EVERY` samples of ``nu`` and ``eta`` (m, n, 6); the mean over the window taken
    out, and zero where a window is not ``usable`` (m,). Trapezoidal rule. Of a vehicle that tumbles the attitude's three are turns in body axes, summed up.
    Of a heading that counts from the start the zero is taken out too: a velocity log that is turned in its mount turns all ways as much."""
    dt, over = run.dt, tumbling(run)
    world = np.einsum("mnij,mnj->mni", rotation_from_euler(eta[..., 3:]), nu[..., :3])
    turn = nu[..., 3:] if over else euler_rates(eta[..., 3:], nu[..., 3:])
    rates = np.concatenate([world, turn], axis=-1)
    path = np.concatenate([np.zeros_like(rates[:, :1]), np.cumsum(0.5 * dt * (rates[:, 1:] + rates[:, :-1]), axis=1)], axis=1)
    moved = eta - eta[:, :1]
    if over:
        moved[:, 1:, 3:] = np.cumsum(attitude_difference(eta[:, 1:, 3:], eta[:, :-1, 3:]), axis=1)
    off = wrap_angles(path - moved)
    off[..., 3:] = np.unwrap(off[..., 3:], axis=1)
    rows = off[:, ::ROW_EVERY]
    if heading_from_start(run):
        rows[..., :2] = _turned_onto(path[:, ::ROW_EVERY, :2], moved[:, ::ROW_EVERY, :2], usable)
    return np.where(usable[:, None, None], rows - rows.mean(axis=1, keepdims=True), 0.0)


def _turned_onto(path: Array, moved: Array, usable: Flags) -> Array:
    """Ways (m, rows, 2) in the horizontal plane, all turned by the one angle that brings the ``usable`` ones nearest to the ways ``moved``, less these: least
    squares (Kabsch 1976)."""
    way, to = (a[..., 0] + 1j * a[..., 1] for a in (path, moved))
    way, to = (a - a.mean(axis=1, keepdims=True) for a in (way, to))
    off = way * np.exp(1j * np.angle(np.sum((way.conj() * to)[usable]))) - to
    return np.stack([off.real, off.imag], axis=-1)


def smoothed(nu: Array, eta: Array, over: bool) -> tuple[Array, Array]:
    """Motion (m, n, 6) of windows under a smoothing filter (Savitzky and Golay 1964); of one that goes ``over`` the attitude as quaternions."""
    smooth, still = (signal.savgol_filter(a, SMOOTHING, 2, axis=1) for a in (nu, eta))
    if over:
        q = signal.savgol_filter(smooth_quaternions(eta[..., 3:]), SMOOTHING, 2, axis=1)
        still[..., 3:] = euler_from_quaternion(q / np.linalg.norm(q, axis=-1, keepdims=True))
    return smooth, still


def wrap_angles(rows: Array) -> Array:
    """Pose differences (..., 6) with the three angles wrapped to (-pi, pi]."""
    out = np.array(rows)
    out[..., 3:] = wrap(out[..., 3:])
    return out


def _extended(nu: Array, eta: Array, dt: float) -> tuple[Array, Array]:
    """Velocities and poses (run, 6) with `MARGIN` more samples at both ends, at the mean velocities of as many samples there."""
    steps = np.arange(1, MARGIN + 1)[:, None] * dt
    ahead, after = nu[:MARGIN].mean(axis=0), nu[-MARGIN:].mean(axis=0)
    before = eta[0] - steps[::-1] * _rates(ahead, eta[0])
    behind = eta[-1] + steps * _rates(after, eta[-1])
    if tumbles(eta[:, 4]):
        before[:, 3:], behind[:, 3:] = turned(eta[0, 3:], -steps[::-1] * ahead[3:]), turned(eta[-1, 3:], steps * after[3:])
    return np.concatenate([np.tile(ahead, (MARGIN, 1)), nu, np.tile(after, (MARGIN, 1))]), np.concatenate([before, eta, behind])


def _rates(nu: Array, eta: Array) -> Array:
    """Time derivative (6,) of one pose ``eta`` (6,) at velocities ``nu`` (6,)."""
    world = rotation_from_euler(eta[None, 3:])[0] @ nu[:3]
    return np.concatenate([world, euler_rates(eta[None, 3:], nu[None, 3:])[0]])


def _bridged(values: Array, angle: bool = False) -> Array:
    """A channel (run,) with gaps filled linearly and angles unwrapped; zeros where it was never measured."""
    good = np.isfinite(values)
    if not good.any():
        return np.zeros_like(values)
    line = np.interp(np.arange(len(values)), np.flatnonzero(good), np.unwrap(values[good]) if angle else values[good])
    return np.asarray(line)
