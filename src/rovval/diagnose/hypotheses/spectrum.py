"""Periods at which what is left of a log swings: where the search for waves and for currents that come and go begins.

A force of a period that is a little off is out of step with the true one after a few hundred seconds, and no slope leads there. So every
period is tried on a body of one time constant, which needs no simulation: its velocity after a window's start, as a share of the
residual velocities (north, east, down) of all windows (least squares; Lomb 1976 for samples with gaps). A vehicle that is under way meets
waves at another period than theirs (Doppler): for those the phase is taken where the vehicle was, k = omega^2 / g in deep water.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.sensitivities import Linear
from rovval.diagnose.windows.shooting import Stretches

VELOCITY = ("u", "v", "w")
SETTLES_S = 3.0  # time constant of the body: a third of a window of 10 s (`stretches`)
FINE = 3.0  # rates tried in one turn over the log: neighbours are a third of a turn apart at its end
SHORTEST_S = 2.0  # the shortest period of an effect; ten samples of it are enough
MET, SHIFT = 3, 0.15  # lines about which waves are looked for, and how far: omega v / g is 0.14 at 0.9 m/s and 4 s


@dataclass(frozen=True, slots=True)
class _Swung:
    """Of a run's windows: times (m, n), residual velocities north, east and down (m, n, 3) with their start errors taken out, where they are known
    (m, n), and where the vehicle was (m, n, 3)."""

    t: Array
    left: Array
    ok: Flags
    place: Array


def lines(problem: Problem, point: Point) -> tuple[tuple[float, float], ...]:
    """(period in s, share of the residual velocities) of every local maximum, the largest share first."""
    swung = _all(problem, point)
    if not swung:
        return ()
    seconds = _seconds(swung)
    rates = np.arange(1.0 / (2.0 * seconds), 1.0 / SHORTEST_S, 1.0 / (FINE * seconds))
    share = np.array([_share(swung, 2.0 * np.pi * rate) for rate in rates])
    tops = [i for i in range(1, len(rates) - 1) if share[i - 1] < share[i] >= share[i + 1]]
    return tuple((1.0 / float(rates[i]), float(share[i])) for i in sorted(tops, key=lambda i: -share[i]))


def waves(
    problem: Problem, point: Point, met: Sequence[float], bounds: tuple[float, float], directions: Iterable[float]
) -> dict[float | None, Sequence[float]]:
    """For each of ``directions`` (rad from north) the period (s, within ``bounds``) of the waves towards there that explain most of the residual, close
    to the periods at which they were ``met``; nothing where the log does not say where the vehicle was."""
    swung, placed = _all(problem, point), all(part.run.measured(c) for part in problem.parts for c in ("x", "y", "z"))
    met = [period for period in met if bounds[0] <= period <= bounds[1]][:MET]
    if not swung or not placed or not met:
        return {}
    step, gravity = 1.0 / (FINE * _seconds(swung)), problem.plant.vehicle.water.gravity
    about = np.concatenate([np.arange((1.0 - SHIFT) / period, (1.0 + SHIFT) / period, step) for period in met])
    rates = np.unique(np.clip(about, 1.0 / bounds[1], 1.0 / bounds[0]))
    found = dict[float | None, Sequence[float]]()
    for direction in directions:
        ahead = np.array([np.cos(direction), np.sin(direction)])
        share = [_share(swung, 2.0 * np.pi * rate, ahead * (2.0 * np.pi * rate) ** 2 / gravity) for rate in rates]
        found[direction] = (1.0 / float(rates[int(np.argmax(share))]),)
    return found


def _all(problem: Problem, point: Point) -> list[_Swung]:
    """Every run's windows; none where a velocity is missing."""
    if not all(set(VELOCITY) <= set(part.channels) for part in problem.parts):
        return []
    return [_windows(part, one) for part, one in zip(problem.parts, point.linear, strict=True)]


def _seconds(swung: Sequence[_Swung]) -> float:
    return max(float(one.t.max() - one.t.min()) for one in swung)


def _windows(part: Stretches, linear: Linear) -> _Swung:
    at, every = [part.channels.index(c) for c in VELOCITY], max(round(SHORTEST_S / 10.0 / part.run.dt), 1)
    ok: Flags = np.asarray(part.ok[:, ::every, at].all(axis=-1) & linear.valid[:, None])
    t = part.time()[:, ::every]
    psi, x, y, z = (known(part, c, t) for c in ("psi", "x", "y", "z"))
    u, v, w = np.moveaxis(np.where(ok[..., None], linear.r[:, ::every, at], 0.0), -1, 0)
    world = np.stack([np.cos(psi) * u - np.sin(psi) * v, np.sin(psi) * u + np.cos(psi) * v, w], axis=-1)
    return _Swung(t, _started(t, ok, world), ok, np.stack([x, y, z], axis=-1))


def known(part: Stretches, channel: str, t: Array) -> Array:
    """A channel at times ``t``, gaps bridged; nothing where it was not measured."""
    good = np.flatnonzero(part.run.ok(channel)) if part.run.measured(channel) else np.zeros(0, dtype=int)
    if not len(good):
        return np.zeros(t.shape)
    values = part.run.get(channel)[good]
    return np.asarray(np.interp(t / part.run.dt, good, np.unwrap(values) if channel == "psi" else values))


def _started(t: Array, ok: Flags, x: Array) -> Array:
    """Values (m, n, c) without the best multiple of what a wrong start velocity of each window leaves of itself."""
    fades = np.where(ok, np.exp(-(t - t[:, :1]) / SETTLES_S), 0.0)[..., None]
    much = (fades * x).sum(axis=1, keepdims=True) / np.maximum((fades**2).sum(axis=1, keepdims=True), 1e-12)
    return np.where(ok[..., None], x - fades * much, 0.0)


def _share(swung: Sequence[_Swung], omega: float, wave: Array | None = None) -> float:
    """Share of the residual velocities that a force of angular frequency ``omega`` explains, of waves with the wave vector ``wave`` (2,), 1/m."""
    gram, cross, total = np.zeros((2, 2)), np.zeros((2, 3)), 0.0
    for one in swung:
        phase, size = omega * one.t, np.ones_like(one.t)
        if wave is not None:
            phase, size = phase - one.place[..., :2] @ wave, np.exp(-np.linalg.norm(wave) * np.maximum(one.place[..., 2], 0.0))
        carrier = size * np.exp(1j * phase)
        begun = carrier[:, :1] * np.exp(-(one.t - one.t[:, :1]) / SETTLES_S)
        answer = (carrier - begun) / (1.0 / SETTLES_S + 1j * omega)
        x = _started(one.t, one.ok, np.stack([answer.real, answer.imag], axis=-1)).reshape(-1, 2)
        y = one.left.reshape(-1, 3)
        gram, cross, total = gram + x.T @ x, cross + x.T @ y, total + float((y**2).sum())
    return float((cross * np.linalg.solve(gram + 1e-12 * np.eye(2), cross)).sum()) / max(total, 1e-300)
