"""Maximum a posteriori over the unknowns: robust, each channel over its own scale, by damped and projected Gauss-Newton steps
from several starting points (Bertsekas 1982, of the projection).

Residuals of each channel are Student-t about 0 with a scale of their own that is estimated along with the unknowns (Lange, Little and
Taylor 1989): an axis that the model fits badly counts for little, one that it fits well for much, an outlier hardly at all. Residuals are
correlated in time; they count as one independent sample a second.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags

FREEDOM = 8.0  # degrees of freedom of the Student-t (chosen; Lange, Little and Taylor 1989 use 4 for gross outliers, a normal has infinitely many)
INDEPENDENT_S = 1.0  # seconds a residual is remembered: time constant of surge and of an ROV's attitude (chosen)
STEPS = 40  # of a fit: far more than any takes; one that needs them has not converged, and is said to
CONVERGED = 0.01  # change of twice the log posterior below which nothing is gained
FINE = 1e-3  # of a prior's standard deviation: step of the forward differences
LARGEST = 2.0  # standard deviations of the prior: a longer step is cut to this, the tangent says nothing there
DAMPED, HARDER, EASIER, TRIES = 1e-2, 6.0, 0.2, 8  # damping at first, after a step that fails, after one that succeeds (Marquardt 1963), and tries

Residuals = Callable[[Array], Sequence[Array]]


@dataclass(frozen=True, slots=True)
class Quadratic:
    """A log likelihood that is quadratic in the values: its ``curvature`` (k, k), turned positive, and its ``slope`` (k,) where all values are 0."""

    curvature: Array
    slope: Array

    def cost(self, values: Array) -> float:
        """Minus the log likelihood of ``values`` (k,), up to a constant."""
        return float(0.5 * values @ self.curvature @ values - self.slope @ values)

    def downhill(self, values: Array) -> Array:
        """Slope (k,) of that cost."""
        return self.curvature @ values - self.slope


@dataclass(frozen=True, slots=True)
class Problem:
    """``residuals`` of values (k,): one array (..., channels) a run, NaN where the simulation stopped or the values are none that a vehicle may have;
    ``ok`` of the same shapes; ``dt`` s a sample; ``floor`` (channels,) noise of the sensors; ``mean`` and ``sd`` (k,) of the prior; ``low`` and ``high``
    (k,) bounds of the values; ``besides``, what each run says without any simulation."""

    residuals: Residuals
    ok: Sequence[Flags]
    dt: float
    floor: Array
    mean: Array
    sd: Array
    low: Array
    high: Array
    besides: Sequence[Quadratic]

    def log_likelihood(self, values: Array, scale: Array) -> float:
        """Log likelihood at ``values`` (k,) and a ``scale`` (channels,), up to a constant; minus infinity where the simulation stops."""
        residuals = self.residuals(values)
        return -_misfit(self, values, residuals, scale) if _finite(residuals) else -np.inf


@dataclass(frozen=True, slots=True)
class Estimate:
    """``values`` (k,) at the posterior's maximum, their ``covariance`` (k, k) by Laplace's method, ``cost`` (minus the log posterior, up to a
    constant), ``scale`` (channels,) of the residuals, and whether it ``converged``."""

    values: Array
    covariance: Array
    cost: float
    scale: Array
    converged: bool

    @property
    def error(self) -> Array:
        """Standard errors (k,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))

    @property
    def correlation(self) -> Array:
        """Of the posterior (k, k)."""
        return np.asarray(self.covariance / np.outer(self.error, self.error))


def maximum(problem: Problem, starts: Sequence[Array]) -> Estimate:
    """The best of the maxima that are reached from ``starts``, each (k,).

    Raises:
        ValueError: the simulation stops at every starting point.
    """
    found = [one for start in starts if (one := _climb(problem, start)) is not None]
    if not found:
        raise ValueError("the simulation stops at every starting point")
    return min(found, key=lambda one: one.cost)


def _climb(problem: Problem, start: Array) -> Estimate | None:
    """The maximum that is reached from ``start``: with the scales that the residuals have there, which a bad start makes wide and the surface smooth, and
    from there with those that they take on (graduated: Blake and Zisserman 1987)."""
    residuals = problem.residuals(start)
    if not _finite(residuals):
        return None
    values, residuals, _ = _descend(problem, start.copy(), residuals, _scale(problem, residuals))
    values, residuals, converged = _descend(problem, values, residuals, None)
    scale = _scale(problem, residuals)
    curvature, _ = _normal_equations(problem, values, residuals, scale)
    return Estimate(values, np.asarray(np.linalg.inv(curvature), dtype=np.float64), _cost(problem, values, residuals, scale), scale, converged)


def _descend(problem: Problem, values: Array, residuals: Sequence[Array], fixed: Array | None) -> tuple[Array, Sequence[Array], bool]:
    """``values`` and their residuals after damped steps, with ``fixed`` scales or with those of the residuals, and whether the last step gained nothing."""
    damping = DAMPED
    for _ in range(STEPS):
        scale = _scale(problem, residuals) if fixed is None else fixed
        curvature, slope = _normal_equations(problem, values, residuals, scale)
        cost = _cost(problem, values, residuals, scale)
        free = ~((values <= problem.low) & (slope > 0.0) | (values >= problem.high) & (slope < 0.0))  # what would leave its bounds rests there
        for _ in range(TRIES):
            step, damped = np.zeros(len(values)), curvature + damping * np.diag(np.diag(curvature))
            step[free] = np.linalg.solve(damped[np.ix_(free, free)], -slope[free])
            ahead = np.clip(values + np.clip(step, -LARGEST * problem.sd, LARGEST * problem.sd), problem.low, problem.high)
            there = problem.residuals(ahead)
            if _finite(there) and (new := _cost(problem, ahead, there, scale)) < cost:
                break
            damping *= HARDER
        else:
            return values, residuals, True  # no step along the slope lowers the cost: this is the bottom, to rounding
        values, residuals, damping = ahead, there, damping * EASIER
        if cost - new < CONVERGED / 2:
            return values, residuals, True
    return values, residuals, False


def _finite(residuals: Sequence[Array]) -> bool:
    return all(bool(np.isfinite(r).all()) for r in residuals)


def _scale(problem: Problem, residuals: Sequence[Array]) -> Array:
    """Scale (channels,) of the Student-t of each channel by expectation maximisation (Lange, Little and Taylor 1989), noise of the sensors at least."""
    scale = np.ones(len(problem.floor))
    for i in range(len(scale)):
        r = np.concatenate([r[..., i][ok[..., i]] for r, ok in zip(residuals, problem.ok, strict=True)])
        if len(r):
            variance = float(np.mean(r**2)) + problem.floor[i] ** 2
            for _ in range(20):  # settled to four digits after ten
                variance = float(np.mean((FREEDOM + 1) / (FREEDOM + r**2 / variance) * r**2)) + 1e-300
            scale[i] = np.hypot(np.sqrt(variance), problem.floor[i])
    return scale


def _cost(problem: Problem, values: Array, residuals: Sequence[Array], scale: Array) -> float:
    """Minus the log posterior at a scale of each channel, up to a constant."""
    return 0.5 * float((((values - problem.mean) / problem.sd) ** 2).sum()) + _misfit(problem, values, residuals, scale)


def _misfit(problem: Problem, values: Array, residuals: Sequence[Array], scale: Array) -> float:
    """Minus the log likelihood of Student-t residuals, correlated in time, and of what the runs say besides, up to a constant."""
    total = 0.0
    for r, ok in zip(residuals, problem.ok, strict=True):
        z = np.where(ok, r / scale, 0.0)
        total += float((FREEDOM + 1) / 2 * np.log1p(z**2 / FREEDOM).sum() + (ok * np.log(scale)).sum())
    return total * min(problem.dt / INDEPENDENT_S, 1.0) + sum(one.cost(values) for one in problem.besides)


def _beside(problem: Problem, values: Array, j: int) -> tuple[Sequence[Array], float]:
    """Residuals a fine step of the ``j``-th value away, and the step: ahead, or back from a bound or where the simulation stops ahead."""
    ahead = FINE * problem.sd[j]
    for step in (ahead, -ahead) if values[j] + ahead <= problem.high[j] else (-ahead,):
        found = problem.residuals(values + step * np.eye(len(values))[j])
        if _finite(found):
            break
    return found, float(step)


def held_out_gain(problem: Problem, values: Array, before: Flags) -> Array:
    """What the prediction of every run (m,) by the others gains, in twice its log likelihood, with all of ``values`` (k,) free over those ``before`` (k,)
    alone, in the model linearised there."""
    residuals = problem.residuals(values)
    curvature, slope = _by_run(problem, values, residuals, _scale(problem, residuals))
    prior = (values - problem.mean) / problem.sd**2

    def change(i: int, free: Flags) -> float:
        """Of twice the log likelihood of a run, from ``values`` to where the others would have them."""
        H, down = curvature.sum(axis=0) - curvature[i] + np.diag(1.0 / problem.sd**2), slope.sum(axis=0) - slope[i] + prior
        step = np.zeros(len(values))
        step[free] = np.linalg.solve(H[np.ix_(free, free)], -down[free])
        step = np.clip(values + step, problem.low, problem.high) - values
        return -2.0 * float(slope[i] @ step) - float(step @ curvature[i] @ step)

    return np.array([change(i, np.ones_like(before)) - change(i, before) for i in range(len(slope))])


def _normal_equations(problem: Problem, values: Array, residuals: Sequence[Array], scale: Array) -> tuple[Array, Array]:
    """Curvature (k, k) and slope (k,) of the cost, sensitivities by forward differences."""
    curvature, slope = _by_run(problem, values, residuals, scale)
    return curvature.sum(axis=0) + np.diag(1.0 / problem.sd**2), slope.sum(axis=0) + (values - problem.mean) / problem.sd**2


def _by_run(problem: Problem, values: Array, residuals: Sequence[Array], scale: Array) -> tuple[Array, Array]:
    """The likelihood's part of both, of each run: (m, k, k) and (m, k)."""
    beside, step = zip(*(_beside(problem, values, j) for j in range(len(values))), strict=True)
    share, found = min(problem.dt / INDEPENDENT_S, 1.0), []
    for i, (r, ok, known) in enumerate(zip(residuals, problem.ok, problem.besides, strict=True)):
        J = np.stack([(np.nan_to_num(one[i]) - r) / step[j] for j, one in enumerate(beside)], axis=-1)
        weight = share * (FREEDOM + 1) / (FREEDOM + (r / scale) ** 2) / scale**2 * ok
        flat, w = J.reshape(-1, J.shape[-1]), weight.reshape(-1)
        found.append((flat.T @ (w[:, None] * flat) + known.curvature, flat.T @ (w * r.reshape(-1)) + known.downhill(values)))
    return np.stack([A for A, _ in found]), np.stack([b for _, b in found])
