"""Held-out reduction of the prediction error by effects that are added ("shrinkage" in the document): in all and by axis.

Every window is scored with the parameters that the other folds give, in the model linearised about the fitted point, as the held-out
losses of `fit_hypothesis` are; intervals are 90 % block bootstraps over windows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from math import log1p
from typing import TypeVar

import numpy as np
from scipy.integrate import fixed_quad

from rovval.core.data import Array
from rovval.core.large_arrays import taken
from rovval.diagnose.criteria import FORM_ALIKE, FORM_LEAVES, FURTHER_CAUSE, MATERIAL
from rovval.diagnose.effort import MOST_REFITS
from rovval.diagnose.inference.bootstrap import shrinkage_interval
from rovval.diagnose.inference.gap import explainable_gap, floor_losses, squared_errors
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, held_out_linearisations, linearised_in_effects
from rovval.diagnose.inference.map_fit import effects_alone, map_fit
from rovval.diagnose.problem.cross_validation import Fold, make_folds
from rovval.diagnose.problem.problem import Problem, corrected_of, corrected_residuals, gap_equations_at, pose, whitened
from rovval.diagnose.residuals.perturbations import Columns

T = TypeVar("T")
NOTHING_LEFT = 1e-3  # share of the gap: rounding of a ratio to what is left
FALLS = np.array([1.0, 3.0, 10.0, 30.0])  # means of an exponential: where its integral is cut into parts
NODES = 40  # of the integral over each part


@dataclass(frozen=True, slots=True)
class AxisInterval:
    """90 % interval of an axis's reduction."""

    low: float
    high: float


@dataclass(frozen=True, slots=True)
class GapReduction:
    """Relative reduction of the squared prediction error by effects that are added: 1 - error after / error before, without unit.

    Attributes:
        total: over all axes, each residual weighted by its covariance; negative where the error grows.
        low, high: 90 % interval of ``total``.
        of_explainable: the same as a share of the error above the noise floor of the sensors, 1 at most.
        axes: reduction of each measured axis; empty where nothing was added.
        axes_interval: its interval.
        held_out: whether every window was scored with parameters that were fitted without it.
    """

    total: float = 0.0
    low: float = 0.0
    high: float = 0.0
    of_explainable: float = 0.0
    axes: Mapping[str, float] = field(default_factory=dict)
    axes_interval: Mapping[str, AxisInterval] = field(default_factory=dict)
    held_out: bool = True


def shrinkage(problem: Problem, fitted: HypothesisFit | None, before: list[Array], seed: int) -> GapReduction:
    """Held-out reduction of the squared prediction error by the effects of ``fitted``; zero where it is None.

    ``before`` are the nominal vehicle's residuals (m, n, c) of each run, as `problem.corrected_residuals` gives them; ``seed`` is the bootstrap's.
    """
    if fitted is None:
        return GapReduction()
    return shrinkage_of(problem, fitted.dynamics_loss, held_out_residuals(problem, fitted), before, seed)


def shrinkage_of(problem: Problem, loss: Array, after: list[Array], before: list[Array], seed: int) -> GapReduction:
    """The reduction from held-out losses (m,) and residuals ``after``, over the nominal vehicle's residuals ``before``: (m, n, c) of each run."""
    value, low, high = shrinkage_interval(problem.gap.dynamics.c, loss, seed)
    nominal, now = squared_errors(problem, before), squared_errors(problem, after)
    measured = {axis: square > 0 for axis, square in nominal.items() if square.sum() > 0}
    axes = {axis: shrinkage_interval(nominal[axis][seen], now[axis][seen], seed) for axis, seen in measured.items()}
    return GapReduction(
        total=value,
        low=low,
        high=high,
        of_explainable=_explainable(problem, loss),
        axes={axis: share for axis, (share, _, _) in axes.items()},
        axes_interval={axis: AxisInterval(bottom, top) for axis, (_, bottom, top) in axes.items()},
    )


def explainable_left(problem: Problem, losses: Sequence[Array]) -> list[Array]:
    """Share (2,) of the squared error above noise that each of ``losses`` (2,) is, above 1 where it is more than all: of the dynamics alone, and of these
    with the parity residuals; next to none (`NOTHING_LEFT`) at least. All of it where there is no error above noise that could be taken away."""
    before, floor = explainable_gap(problem), floor_losses(problem)
    return [np.maximum(np.divide(loss - floor, before, out=np.ones(2), where=before > 0.0), NOTHING_LEFT) for loss in losses]


def form_error(beyond: Array, tolerated: Array) -> float:
    """Probability that one more cause is the form error of others, by the shares (2,) that it leaves ``beyond`` them of what they leave of held-out windows,
    the less of both: beta distributed about `FORM_LEAVES` and densest at all of it, where a cause of its own leaves any share alike. Either leaves
    what a healthy vehicle shows by its tolerances, expected shares (2,) ``tolerated`` of what the others leave."""
    which = int(np.argmin(beyond))
    if beyond[which] >= 1.0:
        return 1.0
    freedom = FORM_LEAVES / (1.0 - FORM_LEAVES)  # Beta(a, 1), of mean a / (a + 1)
    odds = FORM_ALIKE / FURTHER_CAUSE * odds_of_left(float(beyond[which]), float(tolerated[which]), lambda share: freedom * share ** (freedom - 1.0))
    return odds / (odds + 1.0)


def odds_of_left(left: float, healthy: float, density: Callable[[Array], Array]) -> float:
    """Density of the share ``left`` of a gap where of what is at work a share of that ``density`` is left, over that where any share is, alike. The limit of
    it where all is left.

    A part h of the gap, exponential of mean ``healthy``, is no effect's; of the rest, 1 - h, a share (left - h) / (1 - h) is left. It is integrated over the
    logarithm of the rest, from all of the gap to what is not left (Gauss and Legendre's rule, in parts over which the exponential falls alike).
    """
    if left >= 1.0:
        return 0.0
    end = log1p(-left)
    parts = [0.0, *(float(fall) / -end for fall in healthy * FALLS if fall < -end), 1.0]  # as shares of the way to the end

    def both(way: Array) -> Array:
        part = -np.expm1(end * way)
        likely = np.exp(-part / healthy)
        return np.stack([likely * density(np.maximum(left - part, 0.0) / (1.0 - part)), likely])

    found, alike = sum(fixed_quad(both, low, high, n=NODES)[0] for low, high in pairwise(parts))
    return float(found / alike)


def worsened_axes(reduction: GapReduction) -> dict[str, float]:
    """Relative growth of the squared error on each axis where it grows by more than `MATERIAL` with the effects added."""
    return {axis: -share for axis, share in reduction.axes.items() if share < -MATERIAL}


def held_out_residuals(problem: Problem, fitted: HypothesisFit) -> list[Array]:
    """Residual (m, n, c) of each run's windows with the parameters that the other folds give, best initial states taken out."""
    return corrected_of(problem, held_out_linearisations(problem, fitted, linearised_in_effects(problem, fitted)))


def _explainable(problem: Problem, loss: Array) -> float:
    """Reduction on held-out windows as a share of the weighted squared error above the noise floor, 1 at most."""
    closed = float(problem.gap.dynamics.c.sum()) - float(loss.sum())
    return min(closed / max(float(explainable_gap(problem)[0]), 1e-12), 1.0)


def refitted_shrinkage(problem: Problem, fitted: HypothesisFit, before: Sequence[Array], tolerance: float, seed: int) -> GapReduction:
    """As `shrinkage`, each fold scored with the parameters that a fit by re-simulation without its windows gives, rather than one linear step.

    ``tolerance`` is relative: noise and disturbances of the remaining windows are estimated anew with it.
    """
    loss, now = np.zeros(problem.window_count), [residual.copy() for residual in before]
    for fold in _folds(problem):
        beta = _without(problem, fitted, fold, tolerance)
        loss[fold.test] = gap_equations_at(problem, beta, ())[0].c[fold.test]
        for own, (new, test) in zip(now, _by_run(problem, corrected_residuals(problem, beta), fold.test), strict=True):
            own[test] = new[test]
    return shrinkage_of(problem, loss, now, list(before), seed)


def _folds(problem: Problem) -> tuple[Fold, ...]:
    """The problem's own folds, or of many logs as many groups as may be refitted."""
    return problem.folds if len(problem.folds) <= MOST_REFITS else make_folds(problem.run_of_window * MOST_REFITS // len(problem.runs))


def _without(problem: Problem, fitted: HypothesisFit, fold: Fold, tolerance: float) -> Array:
    """Parameters (k,) with the fitted slots as the windows outside ``fold.test`` give them; the fit begins at the fit of all windows, whose sensitivities to
    coefficients within tolerance it keeps."""
    runs = [windows.some(which) for windows, which in _by_run(problem, problem.runs, fold.train) if which.any()]
    slopes = [(taken(one.S, which), one.columns) for one, which in _by_run(problem, fitted.posterior.linear, fold.train) if which.any()]
    less = pose(tuple(runs), Columns(), tolerance)
    near = [replace(one, S=S, columns=columns) for one, (S, columns) in zip(less.nominal, slopes, strict=True)]
    return effects_alone(less, map_fit(less, fitted.posterior.beta, fitted.slots, whitened(less, near)))


def _by_run(problem: Problem, items: Sequence[T], which: np.ndarray) -> Iterator[tuple[T, np.ndarray]]:
    """Each run's one of ``items``, with the part of ``which`` (all windows,) that is of its own windows (m,)."""
    ends = np.cumsum([windows.count for windows in problem.runs])[:-1]
    return zip(items, np.split(which, ends), strict=True)
