"""Held-out contest of hypotheses in the linearised model: each is fitted on some windows and scored on the others.

A hypothesis is a set of parameters set free on top of a base. The base may hold coefficients within tolerance: nominal coefficients that move within
a stated relative prior. Fits are ridge fits; the data is discounted by ``design_effect``, since residuals are autocorrelated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import HELD_OUT_BLOCK, HELD_OUT_FOLDS, HELD_OUT_RUNS
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior, free_columns, losses


@dataclass(frozen=True, slots=True)
class Fold:
    """Windows to fit on and windows to score on."""

    train: np.ndarray
    test: np.ndarray


def make_folds(run_of_window: np.ndarray, count: int = HELD_OUT_FOLDS) -> tuple[Fold, ...]:
    """One log held out at a time where there are three logs or more, else fifths of the windows: pairs of neighbours in turn, so that what
    changes along the log is not extrapolated beyond what was seen; in short logs, contiguous."""
    runs, m = np.unique(run_of_window), len(run_of_window)
    if len(runs) >= HELD_OUT_RUNS:
        return tuple(Fold(run_of_window != r, run_of_window == r) for r in runs)
    part = np.arange(m) // HELD_OUT_BLOCK % count if m >= HELD_OUT_BLOCK * count else np.arange(m) * count // m
    return tuple(Fold(part != p, part == p) for p in np.unique(part))


@dataclass(frozen=True, slots=True)
class FoldSums:
    """Products summed over the windows of each fold: ``A`` (f, k, k), ``b`` (f, k), ``c`` (f,) of the held-out parts; what a fold is
    fitted on is the total less its own part."""

    data: NormalEquations
    A: Array
    b: Array
    c: Array

    @classmethod
    def of(cls, data: NormalEquations, folds: Sequence[Fold]) -> FoldSums:
        """Sum products over each fold's held-out windows."""
        return cls(
            data,
            np.stack([data.A[f.test].sum(axis=0) for f in folds]),
            np.stack([data.b[f.test].sum(axis=0) for f in folds]),
            np.array([data.c[f.test].sum() for f in folds]),
        )


@dataclass(frozen=True, slots=True)
class CrossValidatedFit:
    """Held-out loss, summed over folds, and the step (k,) over the product columns that fits all windows."""

    loss: float
    step: Array


def cross_validate(ring: FoldSums, prior: Prior, design_effect: float) -> CrossValidatedFit:
    """Ridge fit of the columns of ``prior``: scored on each fold with what the other folds give, and fitted on all."""
    step = np.zeros(ring.b.shape[1])
    if not prior.sd:
        return CrossValidatedFit(float(ring.c.sum()), step)
    free, ridge, offset = free_columns(ring.data, prior, design_effect)
    block = np.ix_(free, free)
    A, b = ring.A.sum(axis=0)[block], ring.b.sum(axis=0)[free] - ridge @ offset
    loss = 0.0
    for own_A, own_b, own_c in zip(ring.A, ring.b, ring.c, strict=True):
        mine_A, mine_b = own_A[block], own_b[free]
        held = np.linalg.solve(A - mine_A + ridge, b - mine_b)
        loss += float(own_c - 2 * mine_b @ held + held @ mine_A @ held)
    step[free] = np.linalg.solve(A + ridge, b)
    return CrossValidatedFit(loss, step)








def contest(ring: FoldSums, base: Prior, hypotheses: Mapping[str, Prior], design_effect: float) -> tuple[CrossValidatedFit, dict[str, CrossValidatedFit]]:
    """Fits of the base and of the base with each hypothesis set free."""
    return cross_validate(ring, base, design_effect), {name: cross_validate(ring, base.widened(prior), design_effect) for name, prior in hypotheses.items()}


def held_out_losses(data: NormalEquations, folds: Sequence[Fold], prior: Prior, design_effect: float) -> Array:
    """Held-out loss of every window (m,)."""
    ring, out = FoldSums.of(data, folds), data.c.copy()
    if not prior.sd:
        return out
    free, ridge, offset = free_columns(data, prior, design_effect)
    A, b = ring.A.sum(axis=0)[np.ix_(free, free)], ring.b.sum(axis=0)[free] - ridge @ offset
    for i, fold in enumerate(folds):
        step = np.linalg.solve(A - ring.A[i][np.ix_(free, free)] + ridge, b - ring.b[i][free])
        out[fold.test] = losses(data, free, step, fold.test)
    return out




