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
    """Standard deviation of the departure of columns from where the model stands; columns not named do not move."""

    sd: Mapping[int, float]

    def widened(self, other: Prior) -> Prior:
        """Both sets free; a column in both takes the wider prior."""
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
    """Places of the free columns, their ridge, and how far each already is from where its prior stands."""
    sd, free = np.array(list(prior.sd.values())), data.place(tuple(prior.sd))
    return free, np.diag(design_effect / sd**2), np.zeros(len(free)) if data.offset is None else data.offset[free]


def eliminated(A: Array, b: Array, free: np.ndarray, ridge: Array, pull: Array) -> tuple[Array, Array]:
    """Curvature (k, k) and descent (k,) of what is left to all columns once those that are ``free``, with priors of curvature ``ridge`` and gradient
    ``pull``, have settled beside each of them (Schur complement)."""
    if not len(free):
        return A, b
    toward = np.linalg.solve(A[np.ix_(free, free)] + ridge, np.concatenate([A[free], (b[free] - pull)[:, None]], axis=1))
    return A - A[:, free] @ toward[:, :-1], b - A[:, free] @ toward[:, -1]


def losses(data: NormalEquations, free: np.ndarray, ridge_step: Array, which: np.ndarray) -> Array:
    """Weighted squared residual of windows after a step of the free columns."""
    A, b = data.A[which][:, free[:, None], free[None, :]], data.b[which][:, free]
    return np.asarray(data.c[which] - 2 * b @ ridge_step + np.einsum("i,wij,j->w", ridge_step, A, ridge_step))


def estimated_design_effect(data: NormalEquations, ridge_step: Array) -> float:
    """How far residuals are from white: variance of the per-window score over its variance for white residuals, median over
    columns that do anything (the design effect of cluster sampling); never below 1."""
    score = data.b - np.einsum("wij,j->wi", data.A, ridge_step)
    spread = (score**2).mean(axis=0)
    white = np.einsum("wii->wi", data.A).mean(axis=0)
    usable = white > ROUNDING * white.max(initial=0.0)
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
