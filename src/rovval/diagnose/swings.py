"""Periods at which what is left of a log swings: where the search for waves and for currents that come and go begins.

A force of a period that is a little off is out of step with the true one after a few hundred seconds, and no slope leads there. So every
period is tried on a body of one time constant, which needs no simulation: its velocity after a window's start, as a share of the
residual velocities (north, east, down) of all windows (least squares; Lomb 1976 for samples with gaps).
"""

from __future__ import annotations

import numpy as np

from rovval.data import Array, Flags
from rovval.diagnose.linearise import Linear
from rovval.diagnose.point import Point
from rovval.diagnose.problem import Problem
from rovval.diagnose.stretches import Stretches

VELOCITY = ("u", "v", "w")
SETTLES_S = 3.0  # time constant of the body: a third of a window of 10 s (`stretches`)
FINE = 3.0  # rates tried in one turn over the log: neighbours are a third of a turn apart at its end
SHORTEST_S = 2.0  # the shortest period of an effect; ten samples of it are enough


def lines(problem: Problem, point: Point) -> tuple[tuple[float, float], ...]:
    """(period in s, share of the residual velocities) of every local maximum, the largest share first."""
    if not all(set(VELOCITY) <= set(part.channels) for part in problem.parts):
        return ()
    swung = [_windows(part, one) for part, one in zip(problem.parts, point.linear, strict=True)]
    seconds = max(float(t.max() - t.min()) for t, _, _ in swung)
    rates = np.arange(1.0 / (2.0 * seconds), 1.0 / SHORTEST_S, 1.0 / (FINE * seconds))
    share = np.array([_share(swung, 2.0 * np.pi * rate) for rate in rates])
    tops = [i for i in range(1, len(rates) - 1) if share[i - 1] < share[i] >= share[i + 1]]
    return tuple((1.0 / float(rates[i]), float(share[i])) for i in sorted(tops, key=lambda i: -share[i]))


def _windows(part: Stretches, linear: Linear) -> tuple[Array, Array, Flags]:
    """Times (m, n), residual velocities north, east and down (m, n, 3) with their start errors taken out, and where they are known (m, n)."""
    at, every = [part.channels.index(c) for c in VELOCITY], max(round(SHORTEST_S / 10.0 / part.run.dt), 1)
    ok: Flags = np.asarray(part.ok[:, ::every, at].all(axis=-1) & linear.valid[:, None])
    t = part.time()[:, ::every]
    psi = np.zeros(t.shape)
    if part.run.measured("psi"):
        psi = np.nan_to_num(part.run.get("psi")[np.minimum(np.round(t / part.run.dt).astype(int), len(part.run) - 1)])
    u, v, w = np.moveaxis(np.where(ok[..., None], linear.r[:, ::every, at], 0.0), -1, 0)
    world = np.stack([np.cos(psi) * u - np.sin(psi) * v, np.sin(psi) * u + np.cos(psi) * v, w], axis=-1)
    return t, _started(t, ok, world), ok


def _started(t: Array, ok: Flags, x: Array) -> Array:
    """Values (m, n, c) without the best multiple of what a wrong start velocity of each window leaves of itself."""
    fades = np.where(ok, np.exp(-(t - t[:, :1]) / SETTLES_S), 0.0)[..., None]
    much = (fades * x).sum(axis=1, keepdims=True) / np.maximum((fades**2).sum(axis=1, keepdims=True), 1e-12)
    return np.where(ok[..., None], x - fades * much, 0.0)


def _share(swung: list[tuple[Array, Array, Flags]], omega: float) -> float:
    """Share of the residual velocities that a force of angular frequency ``omega`` explains."""
    gram, cross, total = np.zeros((2, 2)), np.zeros((2, 3)), 0.0
    for t, left, ok in swung:
        begun = np.exp(1j * omega * t[:, :1] - (t - t[:, :1]) / SETTLES_S)
        answer = (np.exp(1j * omega * t) - begun) / (1.0 / SETTLES_S + 1j * omega)
        x = _started(t, ok, np.stack([answer.real, answer.imag], axis=-1)).reshape(-1, 2)
        y = left.reshape(-1, 3)
        gram, cross, total = gram + x.T @ x, cross + x.T @ y, total + float((y**2).sum())
    return float((cross * np.linalg.solve(gram + 1e-12 * np.eye(2), cross)).sum()) / max(total, 1e-300)
