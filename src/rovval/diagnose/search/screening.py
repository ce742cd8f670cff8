"""The screen: what each hypothesis of the library adds to a baseline, in the model linearised there."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.effort import SCREENED_WITHIN
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of, prior_of
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem, equations_at
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior, free_columns


def linearised(problem: Problem, library: Iterable[Hypothesis], base: Posterior, near: NormalEquations | None = None) -> NormalEquations:
    """Normal equations of a library about the baseline ``base``, with how far each column is from the mean of its prior there: those about a baseline ``near``
    it, moved there, where they still hold (`moved_to`), else made anew."""
    if near and (there := moved_to(problem, near, base)):
        return there
    asked = columns_of(list(library))
    data = equations_at(problem, base.beta, tuple(sorted({*asked.slots, *problem.tolerance.sd, *base.columns})), asked.displaced)
    return replace(data, offset=_offset(problem, data, base))


def moved_to(problem: Problem, data: NormalEquations, base: Posterior) -> NormalEquations | None:
    """Normal equations of a library at the baseline ``base``, by the linearisation ``data`` about another; None where it does not hold there: the cost that it
    predicts, or what a step from there would gain, is not that of the simulation at ``base`` (`SCREENED_WITHIN`)."""
    if not set(base.columns) <= set(data.columns) or data.offset is None:
        return None
    offset = _offset(problem, data, base)
    there = data.after(offset - data.offset)
    slope = there.b.sum(axis=0)[there.place(base.columns)] - base.total.b.sum(axis=0)
    off = abs(float(there.c.sum() - base.total.c.sum())) + float(slope @ base.solve(base.curvature, slope))
    return replace(there, offset=offset) if off <= SCREENED_WITHIN * problem.tempering else None


def _offset(problem: Problem, data: NormalEquations, base: Posterior) -> Array:
    """How far each column (k,) is from the mean of its prior at ``base``; those that are taken at another point are at it."""
    return np.array([base.beta[c] - problem.origin[c] if c < len(base.beta) else 0.0 for c in data.columns])


def screened(problem: Problem, data: NormalEquations, library: Iterable[Hypothesis], chosen: tuple[int, ...]) -> dict[str, float]:
    """Twice the log Bayes factor of each initial point of a library, by label, over coefficients within tolerance and the slots ``chosen`` before.

    A column that no window shows anything of adds nothing, to the last bit: its rounding must not decide.
    """
    base = problem.tolerance.plus(wide_sd(problem.plant, chosen))
    A, b = data.A.sum(axis=0), data.b.sum(axis=0)
    shown = {column for column, information in zip(data.columns, np.diag(A), strict=True) if information > 0.0}
    ground = _evidence(data, A, b, base, problem.tempering)
    own = {h.label: Prior({c: sd for c, sd in prior_of(problem, h).sd.items() if c in shown}) for h in library}
    return {label: _evidence(data, A, b, base.plus(prior.sd), problem.tempering) - ground for label, prior in own.items()}


def _evidence(data: NormalEquations, A: Array, b: Array, prior: Prior, tempering: float) -> float:
    """Twice the log marginal likelihood up to a constant: explained sum of squares less the log volume that the data takes from the prior (MacKay 1992,
    section 2.7)."""
    if not prior.sd:
        return 0.0
    free, ridge, offset = free_columns(data, prior, tempering)
    H, pull = A[np.ix_(free, free)] + ridge, ridge @ offset
    slope = b[free] - pull
    explained = (slope @ np.linalg.solve(H, slope) - pull @ offset) / tempering
    return float(explained - np.linalg.slogdet(H)[1] + np.linalg.slogdet(ridge)[1])
