"""Ridge regression: normal equations solved under a Gaussian prior (Hoerl and Kennard 1970), and what is left after the solution."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.normal_equations import NormalEquations

ROUNDING = 1e-20  # of the most informative column: a column that says less is rounding (those of a real log: from 1e-14, rounding up to 1e-30)


@dataclass(frozen=True, slots=True)
class Prior:
    """Gaussian prior of independent parameters: standard deviation ``sd`` of each about its nominal value, by column, in the parameter's unit. Columns not
    named are fixed."""

    sd: Mapping[int, float]

    def widened(self, other: Prior) -> Prior:
        """The columns of both priors, those in both with the larger standard deviation."""
        merged = dict(self.sd)
        for column, value in other.sd.items():
            merged[column] = max(value, merged.get(column, 0.0))
        return Prior(merged)


def ridge_step(data: NormalEquations, prior: Prior, design_effect: float) -> Array:
    """Ridge step (k,) of the columns of ``prior`` that fits all windows."""
    free, ridge, offset = free_columns(data, prior, design_effect)
    found = np.zeros(len(data.columns))
    found[free] = np.linalg.solve(data.A.sum(axis=0)[np.ix_(free, free)] + ridge, data.b.sum(axis=0)[free] - ridge @ offset)
    return found


def free_columns(data: NormalEquations, prior: Prior, design_effect: float) -> tuple[np.ndarray, Array, Array]:
    """Of the f columns that ``prior`` frees: places among ``data.columns`` (f,), ridge (f, f), and departure from the mean of the prior (f,)."""
    sd, free = np.array(list(prior.sd.values())), data.place(tuple(prior.sd))
    return free, np.diag(design_effect / sd**2), np.zeros(len(free)) if data.offset is None else data.offset[free]


def eliminated(A: Array, b: Array, free: np.ndarray, ridge: Array, pull: Array) -> tuple[Array, Array]:
    """Curvature (k, k) and descent (k,) of the cost in all columns once it is minimised over those that are ``free`` (Schur complement).

    ``A`` (k, k) and ``b`` (k,) are curvature and descent of the data alone, ``ridge`` (f, f) and ``pull`` (f,) curvature and gradient of the free columns'
    prior.
    """
    if not len(free):
        return A, b
    toward = np.linalg.solve(A[np.ix_(free, free)] + ridge, np.concatenate([A[free], (b[free] - pull)[:, None]], axis=1))
    return A - A[:, free] @ toward[:, :-1], b - A[:, free] @ toward[:, -1]


def losses(data: NormalEquations, free: np.ndarray, ridge_step: Array, which: np.ndarray) -> Array:
    """Weighted squared residual (w,) of the windows ``which`` after ``ridge_step`` (f,) in the columns ``free``."""
    A, b = data.A[which][:, free[:, None], free[None, :]], data.b[which][:, free]
    return np.asarray(data.c[which] - 2 * b @ ridge_step + np.einsum("i,wij,j->w", ridge_step, A, ridge_step))


def estimated_design_effect(data: NormalEquations, ridge_step: Array) -> float:
    """Design effect of autocorrelated residuals (Kish 1965): variance of the windows' scores after ``ridge_step`` (k,) over that of white residuals, median
    over the columns that have a sensitivity; never below 1."""
    score = data.b - np.einsum("wij,j->wi", data.A, ridge_step)
    spread = (score**2).mean(axis=0)
    white = np.einsum("wii->wi", data.A).mean(axis=0)
    usable = white > ROUNDING * white.max(initial=0.0)
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
