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
from rovval.diagnose.residuals.ridge import Prior, free_columns


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


def cross_validate(held: NormalEquations, prior: Prior, design_effect: float) -> CrossValidatedFit:
    """Ridge fit of the columns of ``prior``: scored on each fold, of which ``held`` has the held-out windows (`by_fold`), with what the others give, and fitted
    on all."""
    step = np.zeros(held.b.shape[1])
    if not prior.sd:
        return CrossValidatedFit(float(held.c.sum()), step)
    free, ridge, offset = free_columns(held, prior, design_effect)
    block = np.ix_(free, free)
    A, b = held.A.sum(axis=0)[block], held.b.sum(axis=0)[free] - ridge @ offset
    loss = 0.0
    for own_A, own_b, own_c in zip(held.A, held.b, held.c, strict=True):
        mine_A, mine_b = own_A[block], own_b[free]
        others = np.linalg.solve(A - mine_A + ridge, b - mine_b)
        loss += float(own_c - 2 * mine_b @ others + others @ mine_A @ others)
    step[free] = np.linalg.solve(A + ridge, b)
    return CrossValidatedFit(loss, step)


def compare_held_out(
    held: NormalEquations, base: Prior, hypotheses: Mapping[str, Prior], design_effect: float
) -> tuple[CrossValidatedFit, dict[str, CrossValidatedFit]]:
    """Cross-validated fits of the ``base``, and of the base with each hypothesis's columns free as well."""
    fits = {name: cross_validate(held, base.plus(prior.sd), design_effect) for name, prior in hypotheses.items()}
    return cross_validate(held, base, design_effect), fits
