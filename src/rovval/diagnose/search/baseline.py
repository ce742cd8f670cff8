"""The model that a cause is added to, and what a candidate for the cause adds to it.

Evidence is twice the logarithm of a Bayes factor (Kass and Raftery 1995): of a fit over the vehicle as its file has it, or of a candidate over its
baseline, as is said.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from rovval.core.data import Array
from rovval.diagnose.effort import QUICK_STEPS
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.bootstrap import shrinkage_interval
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.problem.problem import Problem, gap_equations_at

Losses = tuple[Array, Array]  # (m,) held-out weighted squared error of every window, with and without the parity residuals


@dataclass(frozen=True, slots=True)
class Baseline:
    """The model that a cause is added to.

    Attributes:
        point: where effects and coefficients within tolerance were fitted.
        evidence: twice the log Bayes factor of that over the nominal vehicle.
        losses: its held-out losses.
    """

    posterior: Posterior
    evidence: float
    losses: Losses


@dataclass(frozen=True, slots=True)
class Candidate:
    """A hypothesis fitted by re-simulation, and what it adds to a baseline.

    Attributes:
        hypothesis: what was set free.
        fit: its fit together with the causes of the baseline.
        evidence: twice the log Bayes factor over the baseline.
        gain: share by which the squared error on held-out windows falls, every coefficient that is no cause's as the file has it.
    """

    hypothesis: Hypothesis
    fit: HypothesisFit
    evidence: float
    gain: float


def healthy_baseline(problem: Problem, healthy: Posterior) -> Baseline:
    """No cause: coefficients within tolerance alone, fitted at ``healthy``."""
    return Baseline(healthy, laplace_evidence(problem, healthy), (problem.gap.total.c, problem.gap.dynamics.c))


def baseline_of(fit: HypothesisFit) -> Baseline:
    """The causes that were fitted, beside coefficients within tolerance."""
    return Baseline(fit.posterior, fit.evidence, (fit.loss, fit.dynamics_loss))


def compared(h: Hypothesis, fit: HypothesisFit, baseline: Baseline) -> Candidate:
    """A fitted hypothesis as a candidate: what it adds to a baseline."""
    return Candidate(h, fit, fit.evidence - baseline.evidence, reduction(baseline.losses, (fit.loss, fit.dynamics_loss)))


def reduction(before: Losses, after: Losses) -> float:
    """Share by which held-out losses fall: the larger of those with and without the parity residuals."""
    return max(float((a - b).sum() / a.sum()) for a, b in zip(before, after, strict=True))


def healthy_without(problem: Problem, healthy: Posterior, slots: Sequence[int]) -> Posterior:
    """The fit ``healthy`` again with the coefficients ``slots`` as the file has them: no tolerance is to imitate the departure that a cause is."""
    own = [s for s in slots if s in problem.tolerance.sd]
    if not own:
        return healthy
    start = healthy.beta.copy()
    start[own] = problem.origin[own]
    others = replace(problem, tolerance=problem.tolerance.without(own))
    return map_fit(others, start, healthy.columns[: healthy.effect_count], healthy.whitened, QUICK_STEPS)


def reduction_beside(problem: Problem, fit: HypothesisFit, others: Posterior, seed: int) -> tuple[float, float, float]:
    """Share by which causes, beside coefficients within tolerance, reduce what these leave of the gap by themselves: (value, low, high) of the 90 % block
    bootstrap over windows.

    ``others`` is the fit of the coefficients that are not the causes' own. All windows were fitted: a step of the causes that a fold would take
    goes with one of the coefficients, and evidence has paid for the causes' freedom.
    """
    return shrinkage_interval(_losses(problem, others)[1], _losses(problem, fit.posterior)[1], seed)


def _losses(problem: Problem, point: Posterior) -> Losses:
    """Losses of every window at a point, its coefficients within tolerance where they were fitted."""
    dynamic, data = gap_equations_at(problem, point.beta, ())
    return data.c, dynamic.c
