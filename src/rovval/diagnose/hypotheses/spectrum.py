"""Periods at which the residual of a log oscillates: initial points of waves and of currents that come and go.

A force of a period that is a little off is out of step with the true one after a few hundred seconds, and no slope leads there. So every period is
tried on a body of one time constant, which needs no simulation: its velocity after a window's start is regressed on the residual velocities
(north, east, down) of all windows, a least-squares periodogram for samples with gaps (Lomb 1976). A vehicle that is under way sees
waves at their period of encounter (Doppler): for those the phase is taken where the vehicle was, with the dispersion relation of
deep water, k = omega^2 / g (Faltinsen 1990, table 2.1).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags
from rovval.diagnose.criteria import MATERIAL, SHORTEST_PERIOD_S
from rovval.diagnose.effort import WAVE_DOPPLER
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.normal_equations import Linearisation
from rovval.diagnose.windows.windows import Windows, interpolated

VELOCITY = ("u", "v", "w")
TIME_CONSTANT_S = 3.0  # s, of the body: a third of a window of 10 s (`windows`)
PER_TURN = 3.0  # frequencies tried for each one turn over the log: neighbours are a third of a turn apart at its end
PER_PERIOD = 10.0  # samples of the shortest period
BAND = 1.3  # times a frequency, and the same below it: most of a seaway (JONSWAP, DNV 2010, 3.5.5), and of white noise 41 % at the highest frequency


@dataclass(frozen=True, slots=True)
class _Velocities:
    """Residual velocities of a run's m windows at n times each.

    Attributes:
        t: (m, n) s since the run's start.
        residual: (m, n, 3) north, east, down (m/s), the best error of the window's initial velocity taken out; 0 where unknown.
        ok: (m, n) where they are known.
        place: (m, n, 3) where the vehicle was (m; north, east, down).
        fades: (m, n, 1) what a wrong initial velocity of the window leaves of itself, of unit length; 0 where residuals are unknown.
    """

    t: Array
    residual: Array
    ok: Flags
    place: Array
    fades: Array


def spectral_lines(problem: Problem, point: Posterior) -> tuple[tuple[float, float], ...]:
    """(Period in s, share of the squared residual velocities that it explains) of every local maximum, the largest share first; ``point`` is the fit that
    leaves the residual. Empty where a log lacks a velocity."""
    runs = _velocities(problem, point)
    if not runs:
        return ()
    seconds = _duration(runs)
    rates = np.arange(1.0 / (2.0 * seconds), 1.0 / SHORTEST_PERIOD_S, 1.0 / (PER_TURN * seconds))
    share = _periodogram(runs, rates)
    tops = [i for i in range(1, len(rates) - 1) if share[i - 1] < share[i] >= share[i + 1]]
    return tuple((1.0 / float(rates[i]), float(share[i])) for i in sorted(tops, key=lambda i: -share[i]))


@dataclass(frozen=True, slots=True)
class Oscillation:
    """What comes and goes: the middle ``period`` (s) of the narrow `BAND` that holds most of the squared residual velocities, and its ``share`` (1) of them."""

    period: float
    share: float


def oscillation(problem: Problem, point: Posterior) -> Oscillation | None:
    """The narrow band in which most of the squared residual velocities at ``point`` lie, as in a seaway (Longuet-Higgins 1984) and not of a slow or a sudden
    force; None where they do not, or where a log lacks a velocity.

    Frequencies are whole turns over the log, which are independent, from half a turn a window on: what is slower is a steady force there.
    """
    runs = _velocities(problem, point)
    if not runs:
        return None
    seconds, window = _duration(runs), problem.runs[0].steps * problem.runs[0].run.dt
    rates = np.arange(1.0, seconds / SHORTEST_PERIOD_S) / seconds
    summed = np.concatenate([[0.0], np.cumsum(_periodogram(runs, rates))])
    middle = rates[(rates > 0.5 / window) & (BAND * rates < rates[-1])]
    if not len(middle) or summed[-1] <= 0.0:
        return None
    share = (summed[np.searchsorted(rates, BAND * middle, side="right")] - summed[np.searchsorted(rates, middle / BAND)]) / summed[-1]
    best = int(np.argmax(share))
    return Oscillation(1.0 / float(middle[best]), float(share[best])) if share[best] > 0.5 else None


def wave_periods(
    problem: Problem, point: Posterior, encounter: Sequence[float], bounds: tuple[float, float], directions: Iterable[float], most: int
) -> dict[float | None, Sequence[float]]:
    """Periods of the waves that explain most of the residual at ``point``, by the direction towards which they run.

    Args:
        encounter: periods of encounter (s), at which the moving vehicle saw them, the strongest first; theirs are looked for close by.
        bounds: shortest and longest period (s).
        directions: tried, in rad from north.
        most: trains of waves in one direction.

    Returns:
        Periods (s) for each direction, the strongest first, as many as explain a `MATERIAL` share of what those before them leave; nothing where a log does
        not say where the vehicle was.
    """
    runs, placed = _velocities(problem, point), all(part.run.measured(c) for part in problem.runs for c in ("x", "y", "z"))
    seen = [period for period in encounter if bounds[0] <= period <= bounds[1]][:most]
    if not runs or not placed or not seen:
        return {}
    step, gravity = 1.0 / (PER_TURN * _duration(runs)), problem.plant.vehicle.water.gravity
    about = np.concatenate([np.arange((1.0 - WAVE_DOPPLER) / period, (1.0 + WAVE_DOPPLER) / period, step) for period in seen])
    rates = np.unique(np.clip(about, 1.0 / bounds[1], 1.0 / bounds[0]))
    found = dict[float | None, Sequence[float]]()
    for direction in directions:
        ahead = np.array([np.cos(direction), np.sin(direction)])
        waves = {float(rate): ahead * (2.0 * np.pi * rate) ** 2 / gravity for rate in rates}
        found[direction] = tuple(1.0 / rate for rate in _lines(runs, waves, 1.5 * PER_TURN * step, most))
    return found


def _lines(runs: Sequence[_Velocities], waves: Mapping[float, Array], distance: float, most: int) -> list[float]:
    """The frequencies (Hz), ``most`` at most, of the waves (given with their wave vectors) that explain most of the residual velocities together. Of the local
    maxima the one that explains most beside those before it is next (orthogonal matching pursuit: Pati et al. 1993), since a strong line has side lobes in
    a log of finite length. None is nearer to another than ``distance`` (Hz): one line is no wider."""
    y, rates = _residual(runs), list(waves)
    share = np.array([_share(y, _answers(runs, 2.0 * np.pi * rate, wave)) for rate, wave in waves.items()])
    tops = np.flatnonzero((share >= np.roll(share, 1)) & (share >= np.roll(share, -1)))
    some = [rates[i] for i in tops[np.argsort(-share[tops])][: 2 * most]]
    X = np.concatenate([_answers(runs, 2.0 * np.pi * rate, waves[rate]) for rate in some], axis=1)
    gram, cross, whole = X.T @ X, X.T @ y, float((y**2).sum())
    chosen, explained = list[int](), 0.0
    while len(chosen) < most:
        open_now = [i for i in range(len(some)) if all(abs(some[i] - some[j]) > distance for j in chosen)]
        more = {i: _explained(gram, cross, [*chosen, i]) for i in open_now}
        best = max(more, key=lambda i: more[i], default=None)
        if best is None or (chosen and more[best] - explained < MATERIAL * (whole - explained)):
            break
        chosen, explained = [*chosen, best], more[best]
    return [some[i] for i in chosen]


def _velocities(problem: Problem, point: Posterior) -> list[_Velocities]:
    """Every run's residual velocities; none where a velocity is missing."""
    if not all(set(VELOCITY) <= set(part.channels) for part in problem.runs):
        return []
    return [_of_run(part, one) for part, one in zip(problem.runs, point.linear, strict=True)]


def _duration(runs: Sequence[_Velocities]) -> float:
    return max(float(one.t.max() - one.t.min()) for one in runs)


def _of_run(windows: Windows, linear: Linearisation) -> _Velocities:
    at, every = [windows.channels.index(c) for c in VELOCITY], max(round(SHORTEST_PERIOD_S / PER_PERIOD / windows.run.dt), 1)
    ok: Flags = np.asarray(windows.ok[:, ::every, at].all(axis=-1) & linear.valid[:, None])
    t = windows.time()[:, ::every]
    psi, x, y, z = (interpolated(windows, c, t) for c in ("psi", "x", "y", "z"))
    u, v, w = np.moveaxis(np.where(ok[..., None], linear.r[:, ::every, at], 0.0), -1, 0)
    world = np.stack([np.cos(psi) * u - np.sin(psi) * v, np.sin(psi) * u + np.cos(psi) * v, w], axis=-1)
    fades = np.where(ok, np.exp(-(t - t[:, :1]) / TIME_CONSTANT_S), 0.0)[..., None]
    fades /= np.sqrt(np.maximum((fades**2).sum(axis=1, keepdims=True), 1e-12))
    return _Velocities(t, _start_eliminated(fades, ok, world), ok, np.stack([x, y, z], axis=-1), fades)


def _start_eliminated(fades: Array, ok: Flags, x: Array) -> Array:
    """Values (m, n, c) without the best multiple of what a wrong initial velocity of each window leaves of itself, ``fades``."""
    return np.where(ok[..., None], x - fades * (np.swapaxes(fades, 1, 2) @ x), 0.0)


def _periodogram(runs: Sequence[_Velocities], rates: Array) -> Array:
    """Share of the squared residual velocities that a force of each of the frequencies ``rates`` (f,) Hz explains (f,)."""
    y = _residual(runs)
    return np.array([_share(y, _answers(runs, 2.0 * np.pi * rate)) for rate in rates])


def _share(residual: Array, answer: Array) -> float:
    """Share of squared ``residual`` velocities (samples, 3) that a force with this ``answer`` (samples, 2) explains."""
    return _explained(answer.T @ answer, answer.T @ residual, [0]) / max(float((residual**2).sum()), 1e-300)


def _explained(gram: Array, cross: Array, lines: Sequence[int]) -> float:
    """Squared residual velocities that lines explain together, of whose answers, two columns each, ``gram`` and ``cross`` are the products."""
    at = np.array([2 * i + part for i in lines for part in (0, 1)])
    return float((cross[at] * np.linalg.solve(gram[np.ix_(at, at)] + 1e-12 * np.eye(len(at)), cross[at])).sum())


def _residual(runs: Sequence[_Velocities]) -> Array:
    """Residual velocities (samples, 3) of all runs."""
    return np.concatenate([one.residual.reshape(-1, 3) for one in runs])


def _answers(runs: Sequence[_Velocities], omega: float, wave: Array | None = None) -> Array:
    """Velocity (samples, 2) of a body of one time constant by a force of angular frequency ``omega`` (rad/s), in two phases a quarter apart, of a size of its
    own: what the force does not begin with fades as a wrong initial velocity does, and goes with it. Of waves, with their wave vector (2,) (1/m), the phase is
    taken, and their amplitude decays with depth, where the vehicle was."""
    found = list[Array]()
    for one in runs:
        phase = omega * one.t if wave is None else omega * one.t - one.place[..., :2] @ wave
        carrier = np.stack([np.cos(phase), np.sin(phase)], axis=-1)
        if wave is not None:
            carrier *= np.exp(-np.linalg.norm(wave) * np.maximum(one.place[..., 2:], 0.0))
        found.append(_start_eliminated(one.fades, one.ok, carrier).reshape(-1, 2))
    return np.concatenate(found)
