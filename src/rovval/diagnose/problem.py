"""A diagnosis problem: the windows of one or several runs, the metric in which residuals are judged, and products at any point.

The metric's variance per channel and time in the window is noise (from the log), calibration slop (what coefficients that are a few
per cent off would do) and what no hypothesis of the library explains (model form, disturbance); never sensor noise alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.data import Array
from rovval.diagnose.contest import Fold, Prior, Ring, fit, folds_of, inflation_of
from rovval.diagnose.library import Hypothesis
from rovval.diagnose.linearise import Direction, Linear, linearise, residual, state_spread
from rovval.diagnose.parity import Parity, parity
from rovval.diagnose.products import Products, elsewhere, joined, products, start_corrected
from rovval.diagnose.steadied import discount, gains, loosened
from rovval.diagnose.stretches import BELIEVED, Stretches
from rovval.diagnose.tolerance import slop_prior
from rovval.plant import Plant, parse_settings
from rovval.simulate import carried_effects

SMOOTH = 11  # samples over which the unexplained variance is smoothed along the window (1 s at 10 Hz)


@dataclass(frozen=True, slots=True)
class Problem:
    """``parts`` one per run; ``origin`` (k,) the parameters it starts from; ``variance`` (n, c); ``at_null`` the linearisation
    and ``data`` the products (with parity) at the nominal vehicle; ``inflation`` the design effect of autocorrelated residuals."""

    parts: tuple[Stretches, ...]
    origin: Array
    variance: Array
    slop: Prior
    at_null: tuple[Linear, ...]
    dynamic: Products
    data: Products
    parity: tuple[Parity, ...]
    folds: tuple[Fold, ...]
    inflation: float
    run_of_window: np.ndarray

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
    first = _variance(parts, linear, prior)
    run_of_window = np.concatenate([np.full(part.count, i) for i, part in enumerate(parts)])
    folds = folds_of(run_of_window)
    checks = tuple(parity(part, columns) for part in parts)
    early = _joined(parts, linear, first)
    everything = Prior({c: plant.slots[c].parameter.typical for c in columns})
    inflation = inflation_of(early, fit(Ring.of(early, folds), everything, 10.0).step)
    best = fit(Ring.of(early, folds), everything, inflation).step
    variance = (first + _unexplained(parts, linear, first, best)) * discount(parts, gain)
    dynamic = _joined(parts, linear, variance)
    inflation = inflation_of(dynamic, fit(Ring.of(dynamic, folds), everything, inflation).step)
    data = dynamic + joined([check.moved(origin, dynamic.columns).products(inflation) for check in checks])
    return Problem(parts, origin, variance, prior, linear, dynamic, data, checks, folds, inflation, run_of_window)


def columns_of(library: Sequence[Hypothesis], slop: Prior) -> tuple[tuple[int, ...], tuple[Direction, ...]]:
    """Plant slots that the library and slop need as columns, and the directions of starting points."""
    directions = tuple(d for h in library for d in h.directions)
    plain = {c for h in library if not h.directions for c in h.columns}
    return tuple(sorted({*plain, *slop.sd})), directions


def at(problem: Problem, beta: Array, columns: tuple[int, ...], directions: Sequence[Direction] = ()) -> tuple[Products, Products]:
    """Products of every window about ``beta`` for the given columns: (dynamics alone, dynamics and parity)."""
    return products_about(problem, beta, tuple(linearise(part, beta, columns, directions) for part in problem.parts))


def beside(linear: Linear, other: Linear, columns: tuple[int, ...]) -> Linear:
    """The same linearisation with further columns, whose slopes are taken from another one."""
    place, k = [other.columns.index(c) for c in columns], len(linear.columns)
    S = np.empty((*linear.r.shape, k + len(columns)))
    S[..., :k] = linear.S
    np.take(other.S, place, axis=-1, out=S[..., k:])
    return replace(linear, S=S, columns=(*linear.columns, *columns))


def products_about(problem: Problem, beta: Array, linear: tuple[Linear, ...]) -> tuple[Products, Products]:
    """Products of linearisations about ``beta``: (dynamics alone, dynamics and parity)."""
    dynamic = _joined(problem.parts, linear, problem.variance)
    moved = joined([check.moved(beta, dynamic.columns).products(problem.inflation) for check in problem.parity])
    return dynamic, dynamic + moved


def carried(problem: Problem, beta: Array, linear: tuple[Linear, ...], there: Products) -> Products | None:
    """Products about ``beta``, parity with them, by one simulation: the slopes are those of ``linear``, whose products are ``there``. None
    where a window that ran there does not run here."""
    b, c = list[Array](), list[Array]()
    for part, one in zip(problem.parts, linear, strict=True):
        r, fine = residual(part, beta)
        if not fine[one.valid].all():
            return None
        for whole, share in zip((b, c), elsewhere(one, r, part.ok, problem.variance, state_spread(part)), strict=True):
            whole.append(share)
    moved = joined([check.moved(beta, there.columns).products(problem.inflation) for check in problem.parity])
    return replace(there, b=np.concatenate(b), c=np.concatenate(c)) + moved


def corrected_residuals(problem: Problem, beta: Array | None = None) -> list[Array]:
    """Residual of each run's windows (m, n, c), its best initial states taken out; at the nominal vehicle by default."""
    linear = problem.at_null if beta is None else tuple(linearise(part, beta, ()) for part in problem.parts)
    return [
        start_corrected(one, part.ok, problem.variance, state_spread(part)) for part, one in zip(problem.parts, linear, strict=True)
    ]


def _joined(parts: Sequence[Stretches], linear: Sequence[Linear], variance: Array) -> Products:
    return joined(
        [products(one, part.ok, variance, state_spread(part)) for part, one in zip(parts, linear, strict=True)]
    )


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
        rest = start_corrected(left, part.ok, variance, state_spread(part))
        total += (rest**2 * part.ok).sum(axis=0)
        count += part.ok.sum(axis=0)
    kernel = np.ones(SMOOTH) / SMOOTH
    mean = total / np.maximum(count, 1)
    padded = np.pad(mean, ((SMOOTH // 2, SMOOTH // 2), (0, 0)), mode="edge")
    return np.stack([np.convolve(padded[:, i], kernel, mode="valid") for i in range(mean.shape[1])], axis=1)
