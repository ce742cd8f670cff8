"""A diagnosis problem: the windows of one or several runs, the metric in which residuals are judged, and products at any point.

The metric's variance per channel and time in the window is noise (from the log), calibration slop (what coefficients that are a few
per cent off would do) and what no hypothesis of the library explains (model form, disturbance); never sensor noise alone.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.data import Array
from rovval.diagnose.contest import Fold, Prior, Ring, fit, folds_of, inflation_of
from rovval.diagnose.disturbance import Disturbance, answers, disturbance, shown, undisturbed
from rovval.diagnose.library import Hypothesis
from rovval.diagnose.linearise import Direction, Linear, linearise, residual, spread, state_spread
from rovval.diagnose.parity import Parity, parity
from rovval.diagnose.products import Products, elsewhere, joined, products, start_corrected
from rovval.diagnose.steadied import discount, gains, loosened
from rovval.diagnose.stretches import BELIEVED, Stretches
from rovval.diagnose.tolerance import slop_prior
from rovval.plant import Plant, parse_settings
from rovval.simulate import carried_effects

PASSES = 5  # disturbances are found in what the whole library leaves, and that again in the metric that knows them
SMOOTH = 11  # samples over which the unexplained variance is smoothed along the window (1 s at 10 Hz)


@dataclass(frozen=True, slots=True)
class Problem:
    """``parts`` one per run; ``origin`` (k,) the parameters it starts from; ``variance`` (n, c); ``at_null`` the linearisation
    and ``dynamic`` and ``data`` the products (without and with parity) at the nominal vehicle, ``gap`` and ``gap_data`` the same in the metric
    in which the gap is told, with no disturbance taken out; ``inflation`` the design effect of autocorrelated residuals; ``disturbance``
    what pushed the vehicle that nobody logged."""

    parts: tuple[Stretches, ...]
    origin: Array
    variance: Array
    white: Array
    slop: Prior
    at_null: tuple[Linear, ...]
    dynamic: Products
    data: Products
    gap: Products
    gap_data: Products
    parity: tuple[Parity, ...]
    folds: tuple[Fold, ...]
    inflation: float
    run_of_window: np.ndarray
    disturbance: Disturbance

    @property
    def plant(self) -> Plant:
        """The plant that all runs share."""
        return self.parts[0].plant

    @property
    def blocks(self) -> int:
        """Number of windows of all runs."""
        return len(self.run_of_window)


def pose(parts: tuple[Stretches, ...], library: Sequence[Hypothesis], slop: float) -> Problem:
    """Set the problem up about the vehicle as it is (with the effects that its file carries)."""
    plant = parts[0].plant
    origin = parse_settings(plant, carried_effects(plant.vehicle))
    gain = gains(parts)
    prior = loosened(slop_prior(plant, slop), plant, gain)
    columns, directions = columns_of(library, prior)
    linear = tuple(linearise(part, origin, columns, directions) for part in parts)
    first, floor = _variance(parts, linear, prior), _variance(parts, linear, Prior({}))
    run_of_window = np.concatenate([np.full(part.count, i) for i, part in enumerate(parts)])
    folds = folds_of(run_of_window)
    checks = tuple(parity(part, columns) for part in parts)
    everything = Prior({c: plant.slots[c].parameter.typical for c in columns})
    early = _joined(parts, linear, first, state_spread)
    inflation = inflation_of(early, fit(Ring.of(early, folds), everything, 10.0).step)
    best = fit(Ring.of(early, folds), everything, inflation).step
    white, steady = first + _unexplained(parts, linear, first, best), discount(parts, gain)
    variance, to = white * steady, answers(parts, origin)
    pushed = undisturbed(to)
    plain = tuple(replace(one, S=one.S[..., : len(columns)], columns=columns) for one in linear)
    for _ in range(PASSES):
        left = [replace(one, r=np.where(part.ok, one.r - one.S @ best[: len(columns)], 0.0)) for part, one in zip(parts, plain, strict=True)]
        pushed = disturbance(parts, to, left, white, inflation, pushed)
        swayed = tuple(replace(part, pushed=one) for part, one in zip(parts, pushed.pushed, strict=True))
        loose = tuple(replace(one, J=np.concatenate([one.J, part.pushed], axis=-1)) for one, part in zip(plain, swayed, strict=True))
        white = floor + _unexplained(swayed, loose, first, best[: len(columns)])
        seen = _joined(swayed, loose, white * steady, spread)
        best = fit(Ring.of(seen, folds), everything, inflation).step
        inflation = inflation_of(seen, best)
    parts = tuple(replace(part, pushed=one) for part, one in zip(parts, shown(parts, pushed.pushed, white), strict=True))
    linear = tuple(replace(one, J=np.concatenate([one.J, part.pushed], axis=-1)) for one, part in zip(linear, parts, strict=True))
    dynamic = _joined(parts, linear, white * steady, spread)
    kinematic = joined([check.moved(origin, dynamic.columns).products(inflation) for check in checks])
    gap = _joined(parts, linear, variance, state_spread)
    return Problem(
        parts, origin, variance, white * steady, prior, linear, dynamic, dynamic + kinematic, gap, gap + kinematic, checks, folds, inflation,
        run_of_window, pushed,
    )  # fmt: skip


def columns_of(library: Sequence[Hypothesis], slop: Prior) -> tuple[tuple[int, ...], tuple[Direction, ...]]:
    """Plant slots that the library and slop need as columns, and the directions of starting points."""
    directions = tuple(d for h in library for d in h.directions)
    plain = {c for h in library if not h.directions for c in h.columns}
    return tuple(sorted({*plain, *slop.sd})), directions


def at(problem: Problem, beta: Array, columns: tuple[int, ...], directions: Sequence[Direction] = ()) -> Products:
    """Products of every window about ``beta`` for the given columns, parity with them."""
    return products_about(problem, beta, tuple(linearise(part, beta, columns, directions) for part in problem.parts))[1]


def gap_at(problem: Problem, beta: Array, columns: tuple[int, ...]) -> tuple[Products, Products]:
    """(Dynamics alone, dynamics and parity) about ``beta`` in the metric in which the gap is told."""
    dynamic = _joined(problem.parts, [linearise(part, beta, columns) for part in problem.parts], problem.variance, state_spread)
    return dynamic, dynamic + _kinematic(problem, beta, columns)


def beside(linear: Linear, other: Linear, columns: tuple[int, ...]) -> Linear:
    """The same linearisation with further columns, whose slopes are taken from another one."""
    place, k = [other.columns.index(c) for c in columns], len(linear.columns)
    S = np.empty((*linear.r.shape, k + len(columns)))
    S[..., :k] = linear.S
    np.take(other.S, place, axis=-1, out=S[..., k:])
    return replace(linear, S=S, columns=(*linear.columns, *columns))


def products_about(problem: Problem, beta: Array, linear: tuple[Linear, ...]) -> tuple[Products, Products]:
    """Products of linearisations about ``beta``: (dynamics alone, dynamics and parity)."""
    dynamic = _joined(problem.parts, linear, problem.white, spread)
    return dynamic, dynamic + _kinematic(problem, beta, dynamic.columns)


def carried(problem: Problem, beta: Array, linear: tuple[Linear, ...], there: Products) -> Products | None:
    """Products about ``beta``, parity with them, by one simulation: the slopes are those of ``linear``, whose products are ``there``. None
    where a window that ran there does not run here."""
    b, c = list[Array](), list[Array]()
    for part, one in zip(problem.parts, linear, strict=True):
        r, fine = residual(part, beta)
        if not fine[one.valid].all():
            return None
        for whole, share in zip((b, c), elsewhere(one, r, part.ok, problem.white, spread(part)), strict=True):
            whole.append(share)
    return replace(there, b=np.concatenate(b), c=np.concatenate(c)) + _kinematic(problem, beta, there.columns)


def corrected_residuals(problem: Problem, beta: Array | None = None) -> list[Array]:
    """Residual of each run's windows (m, n, c), its best initial states taken out; at the nominal vehicle by default."""
    linear = problem.at_null if beta is None else tuple(linearise(part, beta, ()) for part in problem.parts)
    return [
        start_corrected(one, part.ok, problem.variance, state_spread(part)) for part, one in zip(problem.parts, linear, strict=True)
    ]


def _kinematic(problem: Problem, beta: Array, columns: tuple[int, ...]) -> Products:
    return joined([check.moved(beta, columns).products(problem.inflation) for check in problem.parity])


def _joined(parts: Sequence[Stretches], linear: Sequence[Linear], variance: Array, nuisances: Callable[[Stretches], Array]) -> Products:
    return joined([products(one, part.ok, variance, nuisances(part)) for part, one in zip(parts, linear, strict=True)])


def _variance(parts: Sequence[Stretches], linear: Sequence[Linear], slop: Prior) -> Array:
    """Noise and slop of each channel at each time in the window (n, c)."""
    least = np.array([BELIEVED[c] for c in parts[0].channels])
    noise = np.maximum(np.mean([part.noise for part in parts], axis=0), least)
    total = np.tile(noise**2, (parts[0].steps + 1, 1))
    windows = sum(part.count for part in parts)
    for one in linear:
        place = [one.columns.index(c) for c in slop.sd]
        sd = np.array(list(slop.sd.values()))
        total = total + np.einsum("wtck,k->tc", one.S[..., place] ** 2, sd**2) / windows
    return total


def _unexplained(parts: Sequence[Stretches], linear: Sequence[Linear], variance: Array, step: Array) -> Array:
    """Mean square (n, c) of what the whole library leaves, smoothed along the window."""
    total, count = np.zeros_like(variance), np.zeros_like(variance)
    for part, one in zip(parts, linear, strict=True):
        left = replace(one, r=np.where(part.ok, one.r - one.S @ step, 0.0))
        rest = start_corrected(left, part.ok, variance, spread(part))
        total += (rest**2 * part.ok).sum(axis=0)
        count += part.ok.sum(axis=0)
    kernel = np.ones(SMOOTH) / SMOOTH
    mean = total / np.maximum(count, 1)
    padded = np.pad(mean, ((SMOOTH // 2, SMOOTH // 2), (0, 0)), mode="edge")
    return np.stack([np.convolve(padded[:, i], kernel, mode="valid") for i in range(mean.shape[1])], axis=1)
