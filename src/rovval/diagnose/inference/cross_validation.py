"""Held-out contest of hypotheses in the linearised model: each is fitted on some windows and scored on the others.

A hypothesis is a set of parameters set free on top of a base. The base may hold calibration slop: nominal coefficients that move within
a stated relative prior. Fits are ridge fits; the data is discounted by ``inflation``, since residuals are autocorrelated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.residuals.normal_equations import Products

PAIR = 2  # neighbouring windows that are held out together: 20 s, beyond the memory of hull and thrusters
ROUNDING = 1e-20  # of the most informative column: a column that says less is rounding (those of a real log: from 1e-14, rounding up to 1e-30)




@dataclass(frozen=True, slots=True)
class Fold:
    """Windows to fit on and windows to score on."""

    train: np.ndarray
    test: np.ndarray


def folds_of(run_of_window: np.ndarray, count: int = 5) -> tuple[Fold, ...]:
    """One log held out at a time where there are three logs or more, else fifths of the windows: pairs of neighbours in turn, so that what
    changes along the log is not extrapolated beyond what was seen; in short logs, contiguous."""
    runs, m = np.unique(run_of_window), len(run_of_window)
    if len(runs) >= 3:
        return tuple(Fold(run_of_window != r, run_of_window == r) for r in runs)
    part = np.arange(m) // PAIR % count if m >= PAIR * count else np.arange(m) * count // m
    return tuple(Fold(part != p, part == p) for p in np.unique(part))


@dataclass(frozen=True, slots=True)
class Ring:
    """Products summed over the windows of each fold: ``A`` (f, k, k), ``b`` (f, k), ``c`` (f,) of the held-out parts; what a fold is
    fitted on is the total less its own part."""

    data: Products
    A: Array
    b: Array
    c: Array

    @classmethod
    def of(cls, data: Products, folds: Sequence[Fold]) -> Ring:
        """Sum products over each fold's held-out windows."""
        return cls(
            data,
            np.stack([data.A[f.test].sum(axis=0) for f in folds]),
            np.stack([data.b[f.test].sum(axis=0) for f in folds]),
            np.array([data.c[f.test].sum() for f in folds]),
        )


@dataclass(frozen=True, slots=True)
class Fit:
    """Held-out loss, summed over folds, and the step (k,) over the product columns that fits all windows."""

    loss: float
    step: Array


def fit(ring: Ring, prior: Prior, inflation: float) -> Fit:
    """Ridge fit of the columns of ``prior``: scored on each fold with what the other folds give, and fitted on all."""
    step = np.zeros(ring.b.shape[1])
    if not prior.sd:
        return Fit(float(ring.c.sum()), step)
    free, ridge, offset = free_of(ring.data, prior, inflation)
    block = np.ix_(free, free)
    A, b = ring.A.sum(axis=0)[block], ring.b.sum(axis=0)[free] - ridge @ offset
    loss = 0.0
    for own_A, own_b, own_c in zip(ring.A, ring.b, ring.c, strict=True):
        mine_A, mine_b = own_A[block], own_b[free]
        held = np.linalg.solve(A - mine_A + ridge, b - mine_b)
        loss += float(own_c - 2 * mine_b @ held + held @ mine_A @ held)
    step[free] = np.linalg.solve(A + ridge, b)
    return Fit(loss, step)


def step(data: Products, prior: Prior, inflation: float) -> Array:
    """Ridge step (k,) of the columns of ``prior`` that fits all windows."""
    free, ridge, offset = free_of(data, prior, inflation)
    found = np.zeros(len(data.columns))
    found[free] = np.linalg.solve(data.A.sum(axis=0)[np.ix_(free, free)] + ridge, data.b.sum(axis=0)[free] - ridge @ offset)
    return found


def free_of(data: Products, prior: Prior, inflation: float) -> tuple[np.ndarray, Array, Array]:
    """Places of the free columns, their ridge, and how far each already is from where its prior stands."""
    sd, free = np.array(list(prior.sd.values())), data.place(tuple(prior.sd))
    return free, np.diag(inflation / sd**2), np.zeros(len(free)) if data.offset is None else data.offset[free]


def settled(A: Array, b: Array, free: np.ndarray, ridge: Array, pull: Array) -> tuple[Array, Array]:
    """Curvature (k, k) and descent (k,) of what is left to all columns once those that are ``free``, with priors of curvature ``ridge`` and gradient
    ``pull``, have settled beside each of them (Schur complement)."""
    if not len(free):
        return A, b
    toward = np.linalg.solve(A[np.ix_(free, free)] + ridge, np.concatenate([A[free], (b[free] - pull)[:, None]], axis=1))
    return A - A[:, free] @ toward[:, :-1], b - A[:, free] @ toward[:, -1]


def contest(ring: Ring, base: Prior, hypotheses: Mapping[str, Prior], inflation: float) -> tuple[Fit, dict[str, Fit]]:
    """Fits of the base and of the base with each hypothesis set free."""
    return fit(ring, base, inflation), {name: fit(ring, base.widened(prior), inflation) for name, prior in hypotheses.items()}


def heldout(data: Products, folds: Sequence[Fold], prior: Prior, inflation: float) -> Array:
    """Held-out loss of every window (m,)."""
    ring, out = Ring.of(data, folds), data.c.copy()
    if not prior.sd:
        return out
    free, ridge, offset = free_of(data, prior, inflation)
    A, b = ring.A.sum(axis=0)[np.ix_(free, free)], ring.b.sum(axis=0)[free] - ridge @ offset
    for i, fold in enumerate(folds):
        step = np.linalg.solve(A - ring.A[i][np.ix_(free, free)] + ridge, b - ring.b[i][free])
        out[fold.test] = losses(data, free, step, fold.test)
    return out


def losses(data: Products, free: np.ndarray, step: Array, which: np.ndarray) -> Array:
    """Weighted squared residual of windows after a step of the free columns."""
    A, b = data.A[which][:, free[:, None], free[None, :]], data.b[which][:, free]
    return np.asarray(data.c[which] - 2 * b @ step + np.einsum("i,wij,j->w", step, A, step))


def inflation_of(data: Products, step: Array) -> float:
    """How far residuals are from white: variance of the per-window score over its variance for white residuals, median over
    columns that do anything (the design effect of cluster sampling); never below 1."""
    score = data.b - np.einsum("wij,j->wi", data.A, step)
    spread = (score**2).mean(axis=0)
    white = np.einsum("wii->wi", data.A).mean(axis=0)
    usable = white > ROUNDING * white.max(initial=0.0)
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
