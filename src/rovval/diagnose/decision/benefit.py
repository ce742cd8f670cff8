"""The benefit of causes: whether they surely reduce the gap, harm no axis by much, and do so where the simulator follows the vehicle.

Asked in two ways, of which one has to do: with every other coefficient as the file has it, and with coefficients fitted within their tolerance beside
the causes; a vehicle that rolls freely answers to each of them. Of faults of sensors the parity residuals are asked instead, where these see them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.diagnose.criteria import (
    ACTING_SHARE,
    COUNTED_REDUCTION,
    FOLLOWED_ANYWAY,
    FOLLOWED_AXES,
    FOLLOWED_MOTION,
    HARMFUL,
    LEAST_EVIDENCE,
    OWN_AXIS_WORSE,
    PARITY_ISOLATES_EVIDENCE,
    PARITY_ISOLATES_SHARE,
    RELIEVED_DEPARTURE,
    ROUNDING_SHARE,
    SURE_REDUCTION,
    UNEXPLAINED_NOTHING,
)
from rovval.diagnose.inference.gap import weighted_errors
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.inference.shrinkage import shrinkage
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.search.baseline import healthy_without, reduction_beside


@dataclass(frozen=True, slots=True)
class Benefit:
    """What causes do to the gap, in one of the two ways.

    Attributes:
        before: weighted squared error of each axis without the causes.
        after: the same with them.
        sure: whether they surely reduce the gap.
        followed: whether the simulator follows the vehicle on the axes where they do.
    """

    before: Mapping[str, float]
    after: Mapping[str, float]
    sure: bool
    followed: bool

    @property
    def reduced(self) -> dict[str, float]:
        """By how much each axis's squared error falls; 0 where it does not."""
        return _reduced(self.before, self.after)

    @property
    def complete(self) -> bool:
        """Whether the causes leave next to nothing."""
        return sum(self.after.values()) <= UNEXPLAINED_NOTHING * sum(self.before.values())

    def harms(self, own: Sequence[str] = ()) -> bool:
        """Whether an axis gets worse by a good part of the whole reduction, or one of the axes ``own`` that the causes are said to be of by more than a
        little."""
        before, after = sum(self.before.values()), sum(self.after.values())
        worse = {axis: self.after[axis] - self.before[axis] for axis in self.before}
        return max(worse.values()) > max(HARMFUL * (before - after), ROUNDING_SHARE * before) or any(worse[axis] > OWN_AXIS_WORSE * before for axis in own)


def benefit_as_filed(problem: Problem, fit: HypothesisFit, residuals: list[Array]) -> Benefit:
    """With every other coefficient as the file has it; ``residuals`` are the nominal vehicle's."""
    before, after = weighted_errors(problem, residuals), weighted_errors(problem, corrected_residuals(problem, fit.beta))
    shrunk = shrinkage(problem, fit, residuals, 0)
    return Benefit(before, after, shrunk.low > 0, followed(problem, before, after))


def benefit_beside(problem: Problem, fit: HypothesisFit, healthy: Posterior, residuals: list[Array]) -> Benefit:
    """Beside coefficients within tolerance, which by themselves are fitted at ``healthy``.

    It is sure where the causes reduce what those that are not their own leave of the gap by a share that counts, and by some of it surely, or where
    they bring a coefficient back towards its tolerance by much.
    """
    before, after = weighted_errors(problem, residuals), weighted_errors(problem, corrected_residuals(problem, fit.posterior.beta))
    value, low, _ = reduction_beside(problem, fit, healthy_without(problem, healthy, fit.slots), 0)
    sure = (value > COUNTED_REDUCTION and low > SURE_REDUCTION) or healthy.largest_departure() - fit.posterior.largest_departure() > RELIEVED_DEPARTURE
    return Benefit(before, after, sure, followed(problem, before, after))


def acting_axes(reduced: Mapping[str, float], share: float = ACTING_SHARE) -> tuple[str, ...]:
    """Axes on which the causes make more than a ``share`` of their reduction."""
    return tuple(axis for axis in AXES if reduced.get(axis, 0.0) > share * max(sum(reduced.values()), 1e-300))


def followed(problem: Problem, before: Mapping[str, float], after: Mapping[str, float]) -> bool:
    """Whether on the axes where the causes reduce much the simulator with them errs well less than the vehicle moves, or hardly errs any more.
    Where it does neither, it replays an autopilot's answers to disturbances that nobody logged, which says nothing about the vehicle."""
    moved = [np.where(part.ok, part.y - (part.y * part.ok).sum((0, 1)) / np.maximum(part.ok.sum((0, 1)), 1), 0.0) for part in problem.runs]
    motion = weighted_errors(problem, moved)
    reduced = _reduced(before, after)
    asked = {max(reduced, key=lambda axis: reduced[axis]), *acting_axes(reduced, FOLLOWED_AXES)}
    return all(after[axis] <= max(FOLLOWED_ANYWAY * before[axis], FOLLOWED_MOTION * motion[axis]) for axis in asked)


def _reduced(before: Mapping[str, float], after: Mapping[str, float]) -> dict[str, float]:
    return {axis: max(before[axis] - after[axis], 0.0) for axis in before}


def beneficial(ways: Sequence[Benefit], seen: bool, own: Sequence[str] = ()) -> bool:
    """Whether one of the ways shows a benefit; ``seen``: parity residuals do, and motion need not; ``own``: axes that the causes are said to be of."""
    return any(not way.harms(own) and (seen or (way.sure and way.followed)) for way in ways)


def parity_supports(problem: Problem, fit: HypothesisFit) -> bool:
    """Whether the parity residuals see faults of sensors: there are none to ask, or they fall with evidence."""
    return not _parity_losses(problem).any() or float(_parity_evidence(problem, fit)) > LEAST_EVIDENCE


def parity_isolates(problem: Problem, fit: HypothesisFit) -> bool:
    """Whether the parity residuals by themselves isolate faults of sensors: no error of the dynamics leaves a trace in them."""
    evidence = _parity_evidence(problem, fit)
    return evidence * problem.design_effect > PARITY_ISOLATES_SHARE * float(_parity_losses(problem).sum()) and evidence > PARITY_ISOLATES_EVIDENCE


def _parity_evidence(problem: Problem, fit: HypothesisFit) -> float:
    """By how much the weighted squared parity residuals fall on held-out windows: twice a log-likelihood ratio, divided by the design effect."""
    return float((_parity_losses(problem) - (fit.loss - fit.dynamics_loss)).sum()) / problem.design_effect


def _parity_losses(problem: Problem) -> Array:
    """Weighted squared parity residuals (m,) of each window at the nominal vehicle."""
    return np.asarray(problem.gap.total.c - problem.gap.dynamics.c)
