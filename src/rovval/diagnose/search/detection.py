"""Detection: is there anything to explain, beyond coefficients within tolerance? A maximum statistic over the whole library.

The statistic of a hypothesis is its evidence: twice the log Bayes factor of the baseline with it over the baseline alone, in the linearised model with
Gaussian priors, which is what it explains less what its freedom costs. A coefficient that would have to be eight standard deviations off its tolerance
is so not explained by tolerance. Null logs are drawn in the same model: coefficients off by their tolerances, plus what the whole library leaves of
this log with random signs of blocks of windows (wild cluster bootstrap; Cameron, Gelbach and Miller 2008). The best hypothesis of a real log has to beat
the best of those, which holds the family-wise error rate (Westfall and Young 1993).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior, free_columns

DRAWS = 200  # null logs: resolve a family-wise error rate of 0.05
BLOCK = 2  # windows that keep one sign: 20 s, beyond the memory of hull and thrusters


@dataclass(frozen=True, slots=True)
class Detection:
    """What a screen of the library shows.

    Attributes:
        evidence: twice the log Bayes factor of each hypothesis over the baseline, linearised, by label.
        null: (d,) the largest over the library in each of d null logs.
    """

    evidence: Mapping[str, float]
    null: Array

    def p_value(self, label: str) -> float:
        """Family-wise probability that the best hypothesis of a healthy log reaches what ``label`` has."""
        return float((1 + (self.null >= self.evidence[label]).sum()) / (1 + len(self.null)))

    @property
    def best(self) -> str:
        """Label of the hypothesis with the largest evidence."""
        return max(self.evidence, key=lambda label: self.evidence[label])

    @property
    def largest(self) -> float:
        """The largest evidence."""
        return self.evidence[self.best]


def detect(
    data: NormalEquations, base: Prior, tolerance: Prior, hypotheses: Mapping[str, Prior], design_effect: float, everything: Array, seed: int
) -> Detection:
    """Evidence of every hypothesis, in the log and in null logs.

    Args:
        data: normal equations of the library, linearised at the baseline.
        base: prior of what is free in the baseline.
        tolerance: prior of healthy coefficients, by which those of null logs are off.
        hypotheses: prior of what each hypothesis sets free, by label.
        design_effect: design effect of autocorrelated residuals.
        everything: (k,) step that fits the whole library: what it leaves is the disturbance of the null logs.
        seed: of their draws.
    """
    b = np.concatenate([data.b.sum(axis=0)[None], _draws(data, tolerance, everything, np.random.default_rng(seed))])
    A, real = data.A.sum(axis=0), np.array([1.0, *np.zeros(DRAWS)])[:, None]
    ground = _evidence(data, A, b, real, base, design_effect)
    evidence, best = dict[str, float](), np.full(DRAWS, -np.inf)
    for label, prior in hypotheses.items():
        gain = _evidence(data, A, b, real, base.widened(prior), design_effect) - ground
        evidence[label] = float(gain[0])
        best = np.maximum(best, gain[1:])
    return Detection(evidence, best)


def _evidence(data: NormalEquations, A: Array, b: Array, real: Array, prior: Prior, design_effect: float) -> Array:
    """Twice the log marginal likelihood (d,) of each right-hand side ``b`` (d, k), up to a constant: explained sum of squares less the log volume
    that the data takes from the prior (MacKay 1992, section 2.7). ``real`` (d, 1) is 1 where the columns are as far from their priors as the
    log's fit has taken them, 0 for null draws, which begin at them."""
    if not prior.sd:
        return np.zeros(len(b))
    free, ridge, offset = free_columns(data, prior, design_effect)
    H, pull = A[np.ix_(free, free)] + ridge, real * (ridge @ offset)
    slope = b[:, free] - pull
    explained = ((slope * np.linalg.solve(H, slope.T).T).sum(axis=1) - pull @ offset) / design_effect
    volume = np.linalg.slogdet(H)[1] - np.log(np.diag(ridge)).sum()
    return np.asarray(explained - volume)


def _draws(data: NormalEquations, tolerance: Prior, everything: Array, rng: np.random.Generator) -> Array:
    """Right-hand sides (d, k) of null logs, summed over windows."""
    m = len(data.c)
    left = data.b - np.einsum("wij,j->wi", data.A, everything)
    sign = rng.choice([-1.0, 1.0], size=(DRAWS, m // BLOCK + 1)).repeat(BLOCK, axis=1)[:, :m]
    delta = np.zeros((DRAWS, len(data.columns)))
    if tolerance.sd:
        free = data.place(tuple(tolerance.sd))
        delta[:, free] = rng.normal(size=(DRAWS, len(free))) * np.array(list(tolerance.sd.values()))
    return np.asarray(delta @ data.A.sum(axis=0) + sign @ left)
