"""Laplace approximation of the posterior of effects and coefficients within tolerance (MacKay 1992; Kass and Raftery 1995): cost, step, evidence."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special, stats
from scipy.optimize import nnls

from rovval.core.data import Array
from rovval.diagnose.criteria import PRIOR_FREEDOM, PRIOR_WIDTH
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.normal_equations import Linearisation, NormalEquations, Whitened
from rovval.diagnose.residuals.ridge import losses


@dataclass(frozen=True, slots=True)
class Posterior:
    """Quadratic expansion of the log posterior about ``beta``, effects and coefficients within tolerance (Laplace approximation: MacKay 1992).

    Cost is twice the negative log posterior times the tempering (`problem.Problem.tempering`): squared residuals plus precision times squared departures.

    Attributes:
        beta: parameters (p,) of the plant.
        columns: the k slots that move: first the ``effect_count`` of the effects, then those that have a tolerance.
        whitened: linearisation of each run in the metric of the likelihood; empty where it was dropped.
        dynamics, total: normal equations without and with parity.
        precision: of the columns' prior (k, k), times the tempering.
        tempering: what squared residuals are divided by (`problem.Problem.tempering`).
        departure: of each column from the mean of its prior (k,).
        bound_side: -1 and 1 for a column on its lower and upper bound, else 0 (k,).
        tangent_only: columns that are moved in the linearisation and not in the simulation (k,).
    """

    beta: Array
    columns: tuple[int, ...]
    effect_count: int
    whitened: tuple[Whitened, ...]
    dynamics: NormalEquations
    total: NormalEquations
    precision: Array
    tempering: float
    departure: Array
    bound_side: Array
    tangent_only: np.ndarray

    @property
    def linear(self) -> tuple[Linearisation, ...]:
        """The linearisation of each run."""
        return tuple(one.linear for one in self.whitened)

    @property
    def pull(self) -> Array:
        """Half the gradient of the prior's part of the cost (k,)."""
        return np.asarray(self.precision @ self.departure)

    @property
    def descent(self) -> Array:
        """Negative half gradient of the cost (k,)."""
        return np.asarray(self.total.b.sum(axis=0) - self.pull)

    @property
    def curvature(self) -> Array:
        """Half the Hessian of the cost (k, k), Gauss-Newton approximation."""
        return np.asarray(self.total.A.sum(axis=0) + self.precision)

    def cost(self) -> float:
        """Cost at the point, columns that are moved in the linearisation only at their optimum."""
        return self._below(self.tangent_only)

    def predicted_cost(self) -> float:
        """Cost that the linearisation predicts after one more step in every column."""
        return self._below(np.ones(len(self.columns), dtype=bool))

    def promised_gain(self) -> float:
        """By how much one more step lowers the cost, as the linearisation has it."""
        return self.cost() - self.predicted_cost()

    def step(self, which: np.ndarray) -> Array:
        """Gauss-Newton step (k,) of the windows ``which`` (m,)."""
        return self.solve(self.total.A[which].sum(axis=0) + self.precision, self.total.b[which].sum(axis=0) - self.pull)

    def simulated_step(self, damping: float = 0.0) -> tuple[Array, float]:
        """Gauss-Newton step (k,) in the columns that are moved in the simulation, zero in the others, and the cost that the linearisation predicts after it.
        With ``damping``, Levenberg's and Marquardt's step: by so many times the diagonal of the data's curvature (Marquardt 1963) and the whole of the prior's,
        so that numbers which the prior knows only together move together."""
        data, slope, moves = self.total.A.sum(axis=0), self.descent, ~self.tangent_only
        curvature = data + self.precision
        step = self.solve(curvature + damping * np.outer(moves, moves) * (np.diag(np.diag(data)) + self.precision), slope)
        return np.where(self.tangent_only, 0.0, step), self._here() - float(step @ (2.0 * slope - curvature @ step))

    def solve(self, H: Array, slope: Array, among: np.ndarray | None = None) -> Array:
        """The step (k,) in the columns ``among`` (all by default) to the least of step H step - 2 slope step at which no column leaves the bound that it is on:
        for these non-negative least squares (Lawson and Hanson 1974), the others at their best beside them."""
        open_now = np.ones(len(slope), dtype=bool) if among is None else among
        held, loose = open_now & (self.bound_side != 0), open_now & (self.bound_side == 0)
        step, beside = np.zeros(len(slope)), H[np.ix_(held, loose)]
        best = np.linalg.solve(H[np.ix_(loose, loose)], np.column_stack([beside.T, slope[loose]]))
        if held.any():
            root = np.linalg.cholesky(H[np.ix_(held, held)] - beside @ best[:, :-1])
            inward = -self.bound_side[held]
            step[held] = inward * nnls(root.T * inward, np.linalg.solve(root, slope[held] - beside @ best[:, -1]))[0]
        step[loose] = best[:, -1] - best[:, :-1] @ step[held]
        return step

    def predicted_departure(self) -> Array:
        """Departure (k,) of each column from the mean of its prior that the linearisation predicts after one more step in every column."""
        return np.asarray(self.departure + self.solve(self.curvature, self.descent))

    def standardised_departures(self) -> Array:
        """Standardised departure of each coefficient within tolerance, in standard deviations of its prior, one linear step ahead."""
        own = slice(self.effect_count, None)
        variance = self.tempering * np.diag(np.linalg.inv(self.precision))
        return np.asarray(self.predicted_departure()[own] / np.sqrt(variance[own]))

    def largest_departure(self) -> float:
        """Largest absolute standardised departure; 0 without tolerances."""
        return float(np.abs(self.standardised_departures()).max(initial=0.0))

    def dynamics_loss(self) -> Array:
        """Weighted squared residual (m,) of the dynamics in each window, columns that are moved in the linearisation only at their optimum."""
        step = self.solve(self.curvature, self.descent, self.tangent_only)
        return losses(self.dynamics, np.arange(len(step)), step, np.ones(len(self.dynamics.c), dtype=bool))

    def effects_given_others(self) -> Array:
        """What turns departures (k,) into those of the effects' parameters where all else is as the vehicle's file has it (effect_count, k): without what goes
        with the others' departures by the correlations of the prior; their own departures where it has none."""
        own = self.precision[: self.effect_count]
        return np.asarray(np.linalg.solve(own[:, : self.effect_count], own))

    def effect_sd(self) -> Array:
        """Standard deviation (effect_count,) of each of the effects' parameters, where all else is as the vehicle's file has it."""
        return np.asarray(np.sqrt(self.tempering * np.diag(self._effect_inverse())))

    def effect_beyond_tolerance(self, wide: Array) -> tuple[Array, Array]:
        """Mean and standard deviation (effect_count,) of what each of the effects' parameters is off by beyond its tolerance, the prior of which is normal with
        standard deviation ``wide`` (effect_count,)."""
        own, gain = self.precision[:, : self.effect_count], wide**2 / self.tempering
        known = np.diag(own) - np.einsum("ij,ij->j", own, np.linalg.solve(self.curvature, own))
        return np.asarray(gain * (own.T @ self.predicted_departure())), wide * np.sqrt(np.maximum(1.0 - gain * known, 0.0))

    def effect_correlation(self) -> Array:
        """Correlations (effect_count, effect_count) of the effects' parameters, where all else is as the vehicle's file has it."""
        inverse = self._effect_inverse()
        sd = np.sqrt(np.diag(inverse))
        return np.asarray(inverse / np.outer(sd, sd))

    def _effect_inverse(self) -> Array:
        """The inverse curvature of the effects' parameters (effect_count, effect_count), where all else is as the vehicle's file has it."""
        given = self.effects_given_others()
        return np.asarray(given @ np.linalg.solve(self.curvature, given.T))

    def _below(self, among: np.ndarray) -> float:
        """Cost after one linear step in the columns ``among`` (k,)."""
        slope = self.descent
        return self._here() - float(slope @ self.solve(self.curvature, slope, among))

    def _here(self) -> float:
        """Cost at the point as it is."""
        return float(self.total.c.sum()) + float(self.departure @ self.pull)


def resampled_evidence(problem: Problem, point: Posterior, counts: Array) -> Array:
    """Twice the log Bayes factor (d,) of the model fitted at ``point`` over the vehicle as its file has it, for d resamples in which each window occurs
    ``counts`` (d, m) times (Laplace approximation: Kass and Raftery 1995, section 4.1)."""
    found = np.empty(len(counts))
    k = len(point.columns)
    flat = point.total.A.reshape(len(point.total.A), -1)
    volume, pull = -float(np.linalg.slogdet(point.precision)[1]), point.pull
    for i, count in enumerate(counts):
        H = (count @ flat).reshape(k, k) + point.precision
        slope = count @ point.total.b - pull
        loss = float(count @ point.total.c) + float(pull @ point.departure) - float(slope @ point.solve(H, slope))
        found[i] = (float(count @ problem.likelihood.total.c) - loss) / problem.tempering - (np.linalg.slogdet(H)[1] + volume)
    return found


def laplace_evidence(problem: Problem, point: Posterior) -> float:
    """Twice the log Bayes factor of the model fitted at ``point`` over the vehicle as its file has it, on every window once: of the point, where what a further
    step promises by the linearisation is not there, since a fit that ended at it found none that keeps it."""
    return promised_evidence(problem, point) - point.promised_gain() / problem.tempering


def promised_evidence(problem: Problem, point: Posterior) -> float:
    """The same where a further step from ``point`` keeps what it promises: of a model that is only linearised there."""
    return float(resampled_evidence(problem, point, np.ones((1, problem.window_count)))[0]) + heavy_tails(problem, point)


def heavy_tails(problem: Problem, point: Posterior) -> float:
    """Twice the log of the mean ratio, over the posterior of what each of the effects' sized parameters is off by beyond its tolerance, of the prior in which
    effects are compared (Student's t, `PRIOR_FREEDOM`) to the wide normal one in which they are fitted (`PRIOR_WIDTH`): what the evidence gains by the other
    prior."""
    own = point.columns[: point.effect_count]
    parameters, wide = [problem.plant.slots[s].parameter for s in own], wide_sd(problem.plant, own)
    size, sd = point.effect_beyond_tolerance(np.array([wide[s] for s in own]))
    total, z = 0.0, np.linspace(-6.0, 6.0, 241)  # standard deviations of the posterior: finer than any feature of the ratio
    for i, p in ((i, p) for i, p in enumerate(parameters) if not p.places):
        at = (size[i] + sd[i] * z) / p.typical
        log_ratio = stats.t.logpdf(at, PRIOR_FREEDOM) - stats.norm.logpdf(at, scale=PRIOR_WIDTH)
        total += 2.0 * float(special.logsumexp(log_ratio + stats.norm.logpdf(z)) + np.log(z[1] - z[0]))
    return total
