"""Is there anything to explain, on top of calibration slop? A max-statistic over the whole library, calibrated on this log.

The statistic of a hypothesis is twice the log Bayes factor of slop with it against slop alone, in the linearised model with Gaussian
priors: what it explains, less what its freedom costs (Laplace). A coefficient that would have to be eight sigma off its tolerance is
so not "explained by slop". Null logs are drawn in the same model: coefficients off by slop, plus what the whole library leaves of this
log with random signs per block of windows (wild cluster bootstrap). The best hypothesis of a real log must beat the best of those.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.cross_validation import free_of
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.residuals.normal_equations import Products

DRAWS = 200
BLOCK = 2  # windows that keep one sign: 20 s, beyond the memory of hull and thrusters


@dataclass(frozen=True, slots=True)
class Detection:
    """Twice the log Bayes factor of each hypothesis over slop, and the largest over the library in each null draw (d,)."""

    evidence: Mapping[str, float]
    null: Array

    def p_value(self, name: str) -> float:
        """Family-wise probability that the best hypothesis of a healthy log reaches what ``name`` has."""
        return float((1 + (self.null >= self.evidence[name]).sum()) / (1 + len(self.null)))

    @property
    def best(self) -> str:
        """Label of the hypothesis with the largest evidence."""
        return max(self.evidence, key=lambda name: self.evidence[name])


def detect(data: Products, base: Prior, slop: Prior, hypotheses: Mapping[str, Prior], inflation: float, everything: Array, seed: int) -> Detection:
    """Evidence of every hypothesis, real and in null draws; ``everything`` (k,) fits the whole library: its leftover is the disturbance."""
    b = np.concatenate([data.b.sum(axis=0)[None], _draws(data, slop, everything, np.random.default_rng(seed))])
    A, real = data.A.sum(axis=0), np.array([1.0, *np.zeros(DRAWS)])[:, None]
    ground = _evidence(data, A, b, real, base, inflation)
    evidence, best = dict[str, float](), np.full(DRAWS, -np.inf)
    for name, prior in hypotheses.items():
        gain = _evidence(data, A, b, real, base.widened(prior), inflation) - ground
        evidence[name] = float(gain[0])
        best = np.maximum(best, gain[1:])
    return Detection(evidence, best)


def _evidence(data: Products, A: Array, b: Array, real: Array, prior: Prior, inflation: float) -> Array:
    """Twice the log evidence (d,) of each right-hand side ``b`` (d, k), up to a constant: explained sum of squares less the log volume
    that the data takes from the prior (MacKay 1992, 2.7). ``real`` (d, 1) is 1 where the columns are as far from their priors as the
    log's fit has taken them, 0 for null draws, which begin at them."""
    if not prior.sd:
        return np.zeros(len(b))
    free, ridge, offset = free_of(data, prior, inflation)
    H, pull = A[np.ix_(free, free)] + ridge, real * (ridge @ offset)
    slope = b[:, free] - pull
    explained = ((slope * np.linalg.solve(H, slope.T).T).sum(axis=1) - pull @ offset) / inflation
    volume = np.linalg.slogdet(H)[1] - np.log(np.diag(ridge)).sum()
    return np.asarray(explained - volume)


def _draws(data: Products, slop: Prior, everything: Array, rng: np.random.Generator) -> Array:
    """Right-hand sides (d, k) of null logs, summed over windows."""
    m = len(data.c)
    left = data.b - np.einsum("wij,j->wi", data.A, everything)
    sign = rng.choice([-1.0, 1.0], size=(DRAWS, m // BLOCK + 1)).repeat(BLOCK, axis=1)[:, :m]
    delta = np.zeros((DRAWS, len(data.columns)))
    if slop.sd:
        free = data.place(tuple(slop.sd))
        delta[:, free] = rng.normal(size=(DRAWS, len(free))) * np.array(list(slop.sd.values()))
    return np.asarray(delta @ data.A.sum(axis=0) + sign @ left)
