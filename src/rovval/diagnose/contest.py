"""Held-out contest of hypotheses in the linearised model: each is fitted on some windows and scored on the others.

A hypothesis is a set of parameters set free on top of a base. The base may hold calibration slop: nominal coefficients that move within
a stated relative prior. Fits are ridge fits; the data is discounted by ``inflation``, since residuals are autocorrelated.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.products import Products


@dataclass(frozen=True, slots=True)
class Prior:
    """Standard deviation of the departure of plant slots from where the model stands; slots not named do not move."""

    sd: Mapping[int, float]

    def widened(self, other: Prior) -> Prior:
        """Both sets free; a slot in both takes the wider prior."""
        merged = dict(self.sd)
        for slot, value in other.sd.items():
            merged[slot] = max(value, merged.get(slot, 0.0))
        return Prior(merged)


@dataclass(frozen=True, slots=True)
class Fold:
    """Windows to fit on and windows to score on."""

    train: np.ndarray
    test: np.ndarray


def folds_of(run_of_window: np.ndarray, count: int = 5) -> tuple[Fold, ...]:
    """One log held out at a time where there are three logs or more, else contiguous fifths of the windows."""
    runs = np.unique(run_of_window)
    if len(runs) >= 3:
        return tuple(Fold(run_of_window != r, run_of_window == r) for r in runs)
    part = np.arange(len(run_of_window)) * count // len(run_of_window)
    return tuple(Fold(part != p, part == p) for p in np.unique(part))


@dataclass(frozen=True, slots=True)
class Fit:
    """A hypothesis after the contest: held-out loss per window (m,), and its step (k,) over the product columns on all windows."""

    loss: Array
    step: Array


def contest(
    data: Products, folds: Sequence[Fold], base: Prior, hypotheses: Mapping[str, Prior], inflation: float
) -> tuple[Fit, dict[str, Fit]]:
    """Held-out losses of the base and of the base with each hypothesis set free."""
    return fit(data, folds, base, inflation), {
        name: fit(data, folds, base.widened(prior), inflation) for name, prior in hypotheses.items()
    }


def fit(data: Products, folds: Sequence[Fold], prior: Prior, inflation: float) -> Fit:
    """Ridge fit of the slots of ``prior``: held-out loss of every window, and the step on all windows."""
    if not prior.sd:
        return Fit(data.c.copy(), np.zeros(len(data.columns)))
    free = data.place(tuple(prior.sd))
    ridge = np.diag(inflation / np.array(list(prior.sd.values())) ** 2)
    loss = np.empty(len(data.c))
    for fold in folds:
        step = _solve(data, free, ridge, fold.train)
        loss[fold.test] = losses(data, free, step, fold.test)
    full = np.zeros(len(data.columns))
    full[free] = _solve(data, free, ridge, np.ones(len(data.c), dtype=bool))
    return Fit(loss, full)


def losses(data: Products, free: np.ndarray, step: Array, which: np.ndarray) -> Array:
    """Weighted squared residual of windows after a step of the free parameters."""
    A, b = data.A[which][:, free[:, None], free[None, :]], data.b[which][:, free]
    return np.asarray(data.c[which] - 2 * b @ step + np.einsum("i,wij,j->w", step, A, step))


def _solve(data: Products, free: np.ndarray, ridge: Array, which: np.ndarray) -> Array:
    A = data.A[which][:, free[:, None], free[None, :]].sum(axis=0)
    return np.asarray(np.linalg.solve(A + ridge, data.b[which][:, free].sum(axis=0)))


def inflation_of(data: Products, step: Array) -> float:
    """How far residuals are from white: variance of the per-window score over its variance for white residuals, median over
    parameters (the design effect of cluster sampling); never below 1."""
    score = data.b - np.einsum("wij,j->wi", data.A, step)
    spread = (score**2).mean(axis=0)
    white = np.einsum("wii->wi", data.A).mean(axis=0)
    usable = white > 0
    return float(max(1.0, np.median(spread[usable] / white[usable]))) if usable.any() else 1.0
