"""Is there anything to explain, on top of calibration slop? A max-statistic over the whole library, calibrated on this log.

Null logs are drawn in the linearised model: coefficients off by slop, plus what the whole library leaves of this log with random signs
per block of windows (wild cluster bootstrap). The best hypothesis of a real log must beat the best of such logs.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.contest import Fold, Prior
from rovval.diagnose.products import Products

DRAWS = 200
BLOCK = 2  # windows that keep one sign: 20 s, beyond the memory of hull and thrusters


@dataclass(frozen=True, slots=True)
class Null:
    """Largest held-out gain over the library, as a share of the loss, in each null draw (d,)."""

    best: Array

    def p_value(self, share: float) -> float:
        """Family-wise probability of a best gain at least this large on a healthy log."""
        return float((1 + (self.best >= share).sum()) / (1 + len(self.best)))


def null_gains(
    data: Products, folds: Sequence[Fold], base: Prior, slop: Prior, hypotheses: Mapping[str, Prior], inflation: float, everything: Array, seed: int
) -> Null:
    """Draw null logs and contest each: ``everything`` (k,) is the fit of the whole library, whose leftover is the disturbance."""
    rng = np.random.default_rng(seed)
    b, c = _draws(data, slop, everything, rng)
    base_loss = _heldout(data, folds, base, inflation, b, c)
    best = np.full(DRAWS, -np.inf)
    for prior in hypotheses.values():
        gain = base_loss - _heldout(data, folds, base.widened(prior), inflation, b, c)
        best = np.maximum(best, gain / base_loss)
    return Null(best)


def _draws(data: Products, slop: Prior, everything: Array, rng: np.random.Generator) -> tuple[Array, Array]:
    """Products b (d, m, k) and c (d, m) of null logs; A is the log's own."""
    m = len(data.c)
    left_b = data.b - np.einsum("wij,j->wi", data.A, everything)
    left_c = data.c - 2 * data.b @ everything + np.einsum("i,wij,j->w", everything, data.A, everything)
    sign = rng.choice([-1.0, 1.0], size=(DRAWS, m // BLOCK + 1)).repeat(BLOCK, axis=1)[:, :m]
    free = data.place(tuple(slop.sd))
    delta = np.zeros((DRAWS, len(data.columns)))
    delta[:, free] = rng.normal(size=(DRAWS, len(free))) * np.array(list(slop.sd.values()))
    moved = np.einsum("wij,dj->dwi", data.A, delta)
    b = moved + sign[..., None] * left_b
    c = left_c + 2 * sign * np.einsum("wi,di->dw", left_b, delta) + np.einsum("dwi,di->dw", moved, delta)
    return b, c


def _heldout(data: Products, folds: Sequence[Fold], prior: Prior, inflation: float, b: Array, c: Array) -> Array:
    """Held-out loss (d,) of each draw under ridge fits of the prior's slots."""
    if not prior.sd:
        return np.asarray(c.sum(axis=1))
    free = data.place(tuple(prior.sd))
    ridge = np.diag(inflation / np.array(list(prior.sd.values())) ** 2)
    total = np.zeros(len(b))
    for fold in folds:
        A = data.A[:, free[:, None], free[None, :]]
        gain = np.linalg.inv(A[fold.train].sum(axis=0) + ridge)
        step = b[:, fold.train][..., free].sum(axis=1) @ gain
        test_b = b[:, fold.test][..., free].sum(axis=1)
        total += c[:, fold.test].sum(axis=1) - 2 * (test_b * step).sum(axis=1) + ((step @ A[fold.test].sum(axis=0)) * step).sum(axis=1)
    return total
