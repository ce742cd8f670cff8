"""The model that a cause is added to, and what a candidate for the cause gains over it.

The gain is asked in two ways: with every other coefficient as the file has it, and with coefficients fitted within their tolerance beside the
candidate. A vehicle that rolls freely answers to each of its coefficients: with those of the file a true cause may even open the gap; beside fitted
ones it closes what they leave, which the nearest relative of something else does not.

Evidence in this room is twice the logarithm of a Bayes factor (Kass and Raftery 1995): of a fit over the nominal vehicle, or of a candidate over its
baseline, as is said.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import (
    COUNTED_REDUCTION,
    HEALTHY_DEPARTURE,
    ONSET_LEAST_WINDOWS,
    OUT_OF_TOLERANCE,
    PARITY_CONTRADICTED,
    QUICK_STEPS,
    STRONG_EVIDENCE,
)
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.bootstrap import shrinkage_interval
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence
from rovval.diagnose.inference.map_fit import map_fit
from rovval.diagnose.problem.problem import Problem, gap_equations_at
from rovval.diagnose.residuals.ridge import Prior

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
    """A hypothesis fitted by re-simulation, and what it adds to a baseline. Reductions are shares of a squared error, held out.

    Attributes:
        hypothesis: what was set free.
        fit: its fit together with the causes of the baseline.
        evidence: twice the log Bayes factor over the baseline.
        gain: reduction of the gap, every coefficient that is no cause's as the file has it.
        parity_gain: reduction of the parity residuals alone.
        gain_beside: reduction of what coefficients within tolerance leave of the gap, these fitted beside it; 0 where `gain` is enough.
        restores: whether without it a coefficient has to leave its tolerance, and with it none. A drag may be surely wrong and yet be little of a gap that
            is mostly heave's.
        gain_since: of what begins during the log, the reduction from its onset on; else 0.
    """

    hypothesis: Hypothesis
    fit: HypothesisFit
    evidence: float
    gain: float
    parity_gain: float
    gain_beside: float = 0.0
    restores: bool = False
    gain_since: float = 0.0

    @property
    def best_gain(self) -> float:
        """The larger reduction of the gap of the two ways, as far as the second counts."""
        return max(self.gain, self.gain_beside) if self.gain_beside >= COUNTED_REDUCTION else self.gain

    @property
    def contradicted(self) -> bool:
        """Whether it is a fault of a sensor that makes the parity residuals worse, which no error of the dynamics touches."""
        return self.hypothesis.effect.place == "sensor" and self.parity_gain < -PARITY_CONTRADICTED


@dataclass(frozen=True, slots=True)
class SelectedCause:
    """A cause that the search has found.

    Attributes:
        hypothesis: what it is.
        group: names that this log does not tell from it, itself first, with their probabilities.
        fit: the joint fit after it was added.
        p_value: of the detection that let it in (`detection`).
        evidence: twice the log Bayes factor over the baseline that it was added to.
        candidates: those that it was chosen from, best evidence first.
    """

    hypothesis: Hypothesis
    group: tuple[tuple[str, float], ...]
    fit: HypothesisFit
    p_value: float
    evidence: float
    candidates: tuple[Candidate, ...]


def healthy_baseline(problem: Problem, healthy: Posterior) -> Baseline:
    """No cause: coefficients within tolerance alone, fitted at ``healthy``."""
    return Baseline(healthy, laplace_evidence(problem, healthy), (problem.gap.total.c, problem.gap.dynamics.c))


def baseline_of(fit: HypothesisFit) -> Baseline:
    """The causes that were fitted, beside coefficients within tolerance."""
    return Baseline(fit.posterior, fit.evidence, (fit.loss, fit.dynamics_loss))


def compared(problem: Problem, h: Hypothesis, fit: HypothesisFit, baseline: Baseline) -> Candidate:
    """A fitted hypothesis as a candidate: what it adds to a baseline; beside coefficients within tolerance only where its evidence is strong."""
    evidence = fit.evidence - baseline.evidence
    gain, parity_gain = reduction(baseline.losses, (fit.loss, fit.dynamics_loss))
    since = _gain_since(problem, h, fit, baseline) if evidence >= STRONG_EVIDENCE else 0.0
    beside = 0.0
    if evidence >= STRONG_EVIDENCE and gain < COUNTED_REDUCTION:
        others = healthy_without(problem, baseline.posterior, h.slots)
        beside = reduction(_losses(problem, others), _losses(problem, fit.posterior))[0]
    before, after = baseline.posterior.largest_departure(), fit.posterior.largest_departure()
    restores = evidence >= STRONG_EVIDENCE and gain > 0.0 and before > OUT_OF_TOLERANCE and after <= HEALTHY_DEPARTURE
    return Candidate(h, fit, evidence, gain, parity_gain, beside, restores, since)


def reduction(before: Losses, after: Losses) -> tuple[float, float]:
    """Shares by which held-out losses fall: the larger of those with and without the parity residuals, and that of the parity residuals alone."""
    checks = float((before[0] - before[1]).sum())
    parity = 1.0 - float((after[0] - after[1]).sum()) / checks if checks > 0 else 0.0
    return max(float((a - b).sum() / a.sum()) for a, b in zip(before, after, strict=True)), parity


def _gain_since(problem: Problem, h: Hypothesis, fit: HypothesisFit, baseline: Baseline) -> float:
    """Reduction by what begins in mid-log in the windows in which it acts: those before say nothing of it. 0 for another hypothesis."""
    onset = [float(fit.beta[s]) for s in h.slots if problem.plant.slots[s].parameter.role == "onset"]
    if not onset:
        return 0.0
    ends = np.concatenate([(part.start + part.steps) * part.run.dt for part in problem.runs])
    acts = np.flatnonzero(ends > onset[0])
    (before, moved), (after, still) = baseline.losses, (fit.loss, fit.dynamics_loss)
    return reduction((before[acts], moved[acts]), (after[acts], still[acts]))[0] if len(acts) >= ONSET_LEAST_WINDOWS else 0.0


def healthy_without(problem: Problem, healthy: Posterior, slots: Sequence[int]) -> Posterior:
    """The fit ``healthy`` again with the coefficients ``slots`` as the file has them: no tolerance is to imitate the departure that a cause is."""
    own = [s for s in slots if s in problem.tolerance.sd]
    if not own:
        return healthy
    start = healthy.beta.copy()
    start[own] = problem.origin[own]
    others = replace(problem, tolerance=Prior({s: sd for s, sd in problem.tolerance.sd.items() if s not in own}))
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
