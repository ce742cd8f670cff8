"""Cross-validation in the linearised model (Stone 1974): a hypothesis is fitted on some windows and scored on the others.

A hypothesis is a set of free parameters, each with a prior. Fits are ridge fits; the precision of priors is multiplied by ``design_effect``, since
autocorrelated residuals say less than independent ones.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import HELD_OUT_BLOCK, HELD_OUT_FOLDS, HELD_OUT_RUNS
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior, free_columns, losses


@dataclass(frozen=True, slots=True)
class Fold:
    """Windows to fit on, ``train`` (m,), and windows to score on, ``test`` (m,)."""

    train: np.ndarray
    test: np.ndarray


def make_folds(run_of_window: np.ndarray, count: int = HELD_OUT_FOLDS) -> tuple[Fold, ...]:
    """Folds of windows, of which ``run_of_window`` (m,) numbers the runs: one run is held out at a time where there are `HELD_OUT_RUNS` or more.

    Else ``count`` folds of neighbouring windows (`HELD_OUT_BLOCK`) in turn, so that a change along the log is interpolated rather than extrapolated; in short
    logs, contiguous ones.
    """
    runs, m = np.unique(run_of_window), len(run_of_window)
    if len(runs) >= HELD_OUT_RUNS:
        return tuple(Fold(run_of_window != r, run_of_window == r) for r in runs)
    fold = np.arange(m) // HELD_OUT_BLOCK % count if m >= HELD_OUT_BLOCK * count else np.arange(m) * count // m
    return tuple(Fold(fold != f, fold == f) for f in np.unique(fold))


@dataclass(frozen=True, slots=True)
class FoldSums:
    """Normal equations summed over the held-out windows of each of f folds; those of its training windows are the total less its own.

    Attributes:
        data: normal equations of every window.
        A, b, c: their sums over the windows that each fold holds out: (f, k, k), (f, k) and (f,).
    """


    data: NormalEquations
    A: Array
    b: Array
    c: Array

    @classmethod
    def of(cls, data: NormalEquations, folds: Sequence[Fold]) -> FoldSums:
        """Sum the normal equations over each fold's held-out windows."""
        held = by_fold(data, folds)
        return cls(data, held.A, held.b, held.c)


def by_fold(data: NormalEquations, folds: Sequence[Fold]) -> NormalEquations:
    """Normal equations of the windows that each of f folds holds out, as of one window (f, ...)."""
    return replace(
        data,
        A=np.stack([sum((data.A[w] for w in np.flatnonzero(f.test)), np.zeros(data.A.shape[1:])) for f in folds]),
        b=np.stack([data.b[f.test].sum(axis=0) for f in folds]),
        c=np.array([data.c[f.test].sum() for f in folds]),
    )


@dataclass(frozen=True, slots=True)
class CrossValidatedFit:
    """Held-out weighted squared residual ``loss``, summed over folds, and the ``step`` (k,) that fits all windows."""

    loss: float
    step: Array


def cross_validate(sums: FoldSums, prior: Prior, design_effect: float) -> CrossValidatedFit:
    """Ridge fit of the columns of ``prior``: scored on each fold with what the other folds give, and fitted on all."""
    step = np.zeros(sums.b.shape[1])
    if not prior.sd:
        return CrossValidatedFit(float(sums.c.sum()), step)
    free, ridge, offset = free_columns(sums.data, prior, design_effect)
    block = np.ix_(free, free)
    A, b = sums.A.sum(axis=0)[block], sums.b.sum(axis=0)[free] - ridge @ offset
    loss = 0.0
    for own_A, own_b, own_c in zip(sums.A, sums.b, sums.c, strict=True):
        mine_A, mine_b = own_A[block], own_b[free]
        held = np.linalg.solve(A - mine_A + ridge, b - mine_b)
        loss += float(own_c - 2 * mine_b @ held + held @ mine_A @ held)
    step[free] = np.linalg.solve(A + ridge, b)
    return CrossValidatedFit(loss, step)


def compare_held_out(
    sums: FoldSums, base: Prior, hypotheses: Mapping[str, Prior], design_effect: float
) -> tuple[CrossValidatedFit, dict[str, CrossValidatedFit]]:
    """Cross-validated fits of the ``base``, and of the base with each hypothesis's columns free as well."""
    fits = {name: cross_validate(sums, base.widened(prior), design_effect) for name, prior in hypotheses.items()}
    return cross_validate(sums, base, design_effect), fits


def held_out_losses(data: NormalEquations, folds: Sequence[Fold], prior: Prior, design_effect: float) -> Array:
    """Weighted squared residual (m,) of every window after the fit of the windows that its fold trains on."""
    sums, out = FoldSums.of(data, folds), data.c.copy()
    if not prior.sd:
        return out
    free, ridge, offset = free_columns(data, prior, design_effect)
    A, b = sums.A.sum(axis=0)[np.ix_(free, free)], sums.b.sum(axis=0)[free] - ridge @ offset
    for i, fold in enumerate(folds):
        step = np.linalg.solve(A - sums.A[i][np.ix_(free, free)] + ridge, b - sums.b[i][free])
        out[fold.test] = losses(data, free, step, fold.test)
    return out
