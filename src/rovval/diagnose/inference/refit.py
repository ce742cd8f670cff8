"""How far the gap shrinks on windows left out, by fitting anew without them.

`shrinkage` moves the parameters of a fold along the tangent of the joint fit, in the metric of all windows, which is enough for a cause
or two. Many coefficients that move far leave that tangent and lean on that metric (tank runs: 71 % that way, 58 % on a run that neither
the fit nor its metric has seen), so here every fold is posed and re-simulated without what is left out.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.cross_validation import Fold, folds_of
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.map_fit import settle
from rovval.diagnose.inference.problem import Problem, corrected_residuals, gap_at, in_metric, pose
from rovval.diagnose.inference.shrinkage import told
from rovval.diagnose.residuals.perturbations import Columns
from rovval.diagnose.windows.shooting import Stretches

T = TypeVar("T")
MOST = 5  # refits: of more logs than that, a fifth is left out at a time


def shrinkage_refitted(problem: Problem, fitted: Confirmed, before: Sequence[Array], slop: float, seed: int) -> dict[str, Any]:
    """As `shrinkage.shrinkage`, each fold scored with the parameters that a fit without its windows gives; the gap is told in ``problem``'s
    metric, as every other shrinkage is."""
    loss, now = np.zeros(problem.blocks), [residual.copy() for residual in before]
    for fold in _folds(problem):
        beta = _without(problem, fitted, fold, slop)
        loss[fold.test] = gap_at(problem, beta, ())[0].c[fold.test]
        for own, (new, test) in zip(now, _by_run(problem, corrected_residuals(problem, beta), fold.test), strict=True):
            own[test] = new[test]
    return told(problem, loss, now, list(before), seed)


def _folds(problem: Problem) -> tuple[Fold, ...]:
    """The problem's own folds, or of many logs as many groups as may be refitted."""
    return problem.folds if len(problem.folds) <= MOST else folds_of(problem.run_of_window * MOST // len(problem.parts))


def _without(problem: Problem, fitted: Confirmed, fold: Fold, slop: float) -> Array:
    """Parameters (k,) of the fitted slots that the other windows give, from where all of them stood; slop's slopes stay."""
    parts = [_some(part, which) for part, which in _by_run(problem, problem.parts, fold.train) if which.any()]
    slopes = [(one.S[which], one.columns) for one, which in _by_run(problem, fitted.point.linear, fold.train) if which.any()]
    less = pose(tuple(parts), Columns(), slop)
    near = [replace(one, S=S, columns=columns) for one, (S, columns) in zip(less.at_null, slopes, strict=True)]
    point = settle(less, fitted.point.beta, fitted.slots, in_metric(less, near))
    beta = problem.origin.copy()
    beta[list(fitted.slots)] = point.beta[list(fitted.slots)]
    return beta


def _some(part: Stretches, which: np.ndarray) -> Stretches:
    """The windows ``which`` (m,) of a run, the disturbances of which nobody knows yet."""
    kept = {name: getattr(part, name)[which] for name in ("start", "nu0", "eta0", "y", "ok")}
    return replace(part, pushed=None, **kept)


def _by_run(problem: Problem, items: Sequence[T], which: np.ndarray) -> Iterator[tuple[T, np.ndarray]]:
    """What belongs to each run, with which (m,) of its windows are meant."""
    ends = np.cumsum([part.count for part in problem.parts])[:-1]
    return zip(items, np.split(which, ends), strict=True)
