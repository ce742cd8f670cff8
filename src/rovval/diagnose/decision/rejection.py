"""Rejection: causes that were found are named only if no reason speaks against them; none is named for being the least bad.

A true cause gives none of the `REASONS`; the nearest relative of an effect that the library lacks gives one of them. Evidence is twice the logarithm
of a Bayes factor.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import (
    BROKEN_DEPARTURE,
    BY_CHANCE,
    FEW_FORCES,
    FEW_FORCES_EVIDENCE,
    FEW_WINDOWS,
    GENERIC_BETTER,
    GENERIC_EVIDENCE,
    GENERIC_LEFT,
    HEALTHY_DEPARTURE,
    INCOMPLETE_EVIDENCE,
    LEAST_EVIDENCE,
    MOST_CAUSES,
    OUT_OF_TOLERANCE,
    SINGLE_FORCE_EVIDENCE,
    SINGLE_FORCE_SHARE,
    STRAINED_DEPARTURE,
    STRAINED_EVIDENCE,
    VARYING_EVIDENCE,
)
from rovval.diagnose.decision.benefit import (
    Benefit,
    acting_axes,
    beneficial,
    benefit_as_filed,
    benefit_beside,
    parity_isolates,
    parity_supports,
)
from rovval.diagnose.decision.consistency import inconsistencies
from rovval.diagnose.decision.constancy import drifting, variation
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.baseline import SelectedCause
from rovval.diagnose.search.confusion import form_share
from rovval.diagnose.search.discrepancy import GenericForces, generic_forces


@dataclass(frozen=True, slots=True)
class Case:
    """Causes and what speaks for and against them.

    Attributes:
        problem: what they were fitted to.
        causes: the causes found.
        fit: their joint fit.
        evidence: of that fit over the healthy one.
        instead_forces: generic forces on the healthy vehicle.
        beside_forces: generic forces beside the causes.
        held_out: whether those beside reduce the squared error on windows that they were not fitted on, too.
        axes: axes on which the causes act.
        generic_instead: evidence of generic forces on those axes in the causes' place.
        generic_beside: evidence of those beside the causes; 0 where not ``held_out``.
        benefits: of the causes; the first as the file has it, a second beside coefficients within tolerance where none of these is out of tolerance.
        variation: of each cause by name, the evidence that its value varies.
        sensors: whether they are faults of sensors that the parity residuals see, which a force may imitate.
    """

    problem: Problem
    causes: tuple[SelectedCause, ...]
    fit: HypothesisFit
    evidence: float
    instead_forces: GenericForces
    beside_forces: GenericForces
    held_out: bool
    axes: tuple[str, ...]
    generic_instead: float
    generic_beside: float
    benefits: tuple[Benefit, ...]
    variation: Mapping[str, float]
    sensors: bool

    @property
    def many(self) -> bool:
        """Whether there are windows enough to weigh evidence."""
        return self.problem.window_count >= FEW_WINDOWS

    @property
    def departure(self) -> float:
        """Largest standardised departure of a coefficient beside the causes, in standard deviations of its prior."""
        return self.fit.posterior.largest_departure()

    @property
    def best_evidence(self) -> float:
        """Evidence under the best names of the causes' groups: a simpler name that this log does not tell from it gave some of it up."""
        return self.evidence + sum(_given_up(n) for n in self.causes)


def generic_better(case: Case) -> bool:
    """Do generic forces do better in their place, all of them or a few single ones?"""
    if not case.many or case.sensors:
        return False
    few = case.instead_forces.single(case.axes, FEW_FORCES, case.fit.slots) - case.beside_forces.single(case.axes, FEW_FORCES)
    return case.generic_instead > GENERIC_BETTER * case.best_evidence or few > FEW_FORCES_EVIDENCE * case.best_evidence


def without_benefit(case: Case) -> bool:
    """Do they not surely reduce the gap, harm an axis, or act where the simulator does not follow the vehicle?"""
    own = [axis for n in case.causes for axis in n.hypothesis.axes]
    return not beneficial(case.benefits, case.sensors or not case.many, own)


def straining(case: Case) -> bool:
    """Do coefficients have to leave their tolerance so that they fit?"""
    far = case.departure > STRAINED_DEPARTURE and case.evidence < STRAINED_EVIDENCE * case.departure**2
    return case.departure > BROKEN_DEPARTURE or far


def varying(case: Case) -> bool:
    """Does the value of one vary more surely than they are there?"""
    return max(case.variation.values(), default=0.0) > max(VARYING_EVIDENCE * case.evidence, LEAST_EVIDENCE)


def single_force_left(case: Case) -> bool:
    """Is a single generic force left beside them that is as sure as a cause?"""
    if not case.many or case.sensors or any(benefit.complete for benefit in case.benefits):
        return False
    return case.beside_forces.single(case.axes) > max(SINGLE_FORCE_EVIDENCE, SINGLE_FORCE_SHARE * case.evidence)


def three_of_a_kind(case: Case) -> bool:
    """Are there as many causes as there may be, and all of axes or all of thrusters? A file that is off in so many coefficients is miscalibrated (which
    is asked where nothing is named), or they make up what its equations lack. Opened sets: none of 5 such answers was right."""
    return of_one_kind(case.causes)


def of_one_kind(causes: Sequence[SelectedCause]) -> bool:
    """Whether there are `MOST_CAUSES`, all of axes or all of thrusters."""
    return len(causes) == MOST_CAUSES and len({n.hypothesis.effect.per for n in causes}) == 1 and causes[0].hypothesis.effect.per != ""


def of_an_inconsistent_log(case: Case) -> bool:
    """Does the log contradict itself where causes that are no sensor's reduce most?"""
    most = max(case.benefits[0].reduced.items(), key=lambda item: item[1])
    return not all(of_sensor(n) for n in case.causes) and bool(inconsistencies(case.problem, dict([most])))


def incomplete(case: Case) -> bool:
    """Would a generic force still gain, or do coefficients leave their tolerance, by more than model-form error may cost?"""
    beyond = _prior_cost(case.problem, case.fit.posterior, case.axes)
    return max(case.generic_beside, beyond) > max(form_share(case.problem.window_count) * case.evidence, INCOMPLETE_EVIDENCE)


REASONS = (generic_better, without_benefit, straining, varying, single_force_left, three_of_a_kind, of_an_inconsistent_log, incomplete)


@dataclass(frozen=True, slots=True)
class Assessment:
    """What speaks for and against causes, weighed.

    Attributes:
        evidence: of the causes over the healthy vehicle.
        generic_instead: of generic forces in their place.
        generic_beside: of generic forces beside them.
        departure: largest standardised departure of a coefficient beside them.
        followed: whether the simulator follows the vehicle where they act.
        by_parity: whether parity residuals by themselves isolate those that are faults of sensors.
        rejected: whether a reason speaks against them.
        remainder: whether something remains beside them.
        inconstant: names of those whose value is not constant, the least constant first.
        forces: generic forces beside them.
    """

    evidence: float
    generic_instead: float
    generic_beside: float
    departure: float
    followed: bool
    by_parity: bool
    rejected: bool
    remainder: bool
    inconstant: tuple[str, ...]
    forces: GenericForces


def assess(
    problem: Problem, causes: tuple[SelectedCause, ...], fit: HypothesisFit, healthy: Posterior, general: GenericForces, residuals: list[Array]
) -> Assessment:
    """Weigh what speaks for and against causes.

    Args:
        problem: what they were fitted to.
        causes: the causes found.
        fit: their joint fit.
        healthy: the fit without causes.
        general: generic forces on the healthy vehicle.
        residuals: the nominal vehicle's.
    """
    case = _case(problem, causes, fit, healthy, general, residuals)
    left = case.held_out and case.beside_forces.evidence() > max(GENERIC_EVIDENCE, GENERIC_LEFT * case.evidence)
    return Assessment(
        evidence=case.evidence,
        generic_instead=case.generic_instead,
        generic_beside=case.generic_beside,
        departure=case.departure,
        followed=not case.many or case.sensors or any(benefit.followed for benefit in case.benefits),
        by_parity=any(of_sensor(n) for n in causes) and parity_isolates(problem, fit),
        rejected=any(reason(case) for reason in REASONS),
        remainder=not case.benefits[0].sure or case.departure > OUT_OF_TOLERANCE or left,
        inconstant=_inconstant(problem, causes, fit, case.variation) if case.many else (),
        forces=case.beside_forces,
    )


def _case(problem: Problem, causes: tuple[SelectedCause, ...], fit: HypothesisFit, healthy: Posterior, general: GenericForces, residuals: list[Array]) -> Case:
    """What speaks for the causes and against them."""
    evidence = laplace_evidence(problem, fit.posterior) - laplace_evidence(problem, healthy)
    filed = benefit_as_filed(problem, fit, residuals)
    beside = [benefit_beside(problem, fit, healthy, residuals)] if fit.posterior.largest_departure() <= OUT_OF_TOLERANCE else []
    sensors = all(of_sensor(n) for n in causes) and parity_supports(problem, fit)
    varies = variation(problem, fit, causes) if problem.window_count >= FEW_WINDOWS else {}
    rest = generic_forces(problem, fit.posterior)
    held_out = problem.window_count >= FEW_WINDOWS and rest.held_out_gain(problem.folds) > BY_CHANCE
    axes = acting_axes(filed.reduced)
    generic_instead, generic_beside = general.evidence(axes), rest.evidence(axes) if held_out else 0.0
    return Case(problem, causes, fit, evidence, general, rest, held_out, axes, generic_instead, generic_beside, (filed, *beside), varies, sensors)


def _inconstant(problem: Problem, causes: tuple[SelectedCause, ...], fit: HypothesisFit, varies: Mapping[str, float]) -> tuple[str, ...]:
    """Causes whose value varies more surely than a share of their own evidence, the worst first, and those that drift."""
    own = {n.hypothesis.name: max(VARYING_EVIDENCE * n.evidence, LEAST_EVIDENCE) for n in causes}
    worst = sorted((name for name, most in varies.items() if most > own[name]), key=lambda name: own[name] / varies[name])
    return tuple(dict.fromkeys((*worst, *drifting(problem, fit, causes))))


def of_sensor(cause: SelectedCause) -> bool:
    """Whether a cause is a fault of a sensor."""
    return cause.hypothesis.effect.place == "sensor"


def _given_up(cause: SelectedCause) -> float:
    """Evidence of the best of a cause's group over its own, as candidates."""
    group = {name for name, _ in cause.group}
    evidence = {c.hypothesis.name: c.evidence for c in cause.candidates if c.hypothesis.name in group}
    return max(evidence.values()) - evidence[cause.hypothesis.name] if cause.hypothesis.name in evidence else 0.0


def _prior_cost(problem: Problem, point: Posterior, axes: tuple[str, ...]) -> float:
    """What coefficients beyond tolerance cost, in twice the log of their prior density, each as far as it moves the motion on ``axes``."""
    moves = np.zeros((2, len(point.columns)))
    for part, one in zip(problem.runs, point.linear, strict=True):
        by_channel = np.einsum("wtck,tc->ck", np.where(part.ok[..., None], one.S, 0.0) ** 2, 1.0 / problem.likelihood.variance)
        here = np.array([axis in axes for axis in part.axes], dtype=bool)
        moves += by_channel[here].sum(axis=0), by_channel.sum(axis=0)
    share = moves[0] / np.maximum(moves[1], 1e-300)
    return float((np.maximum(point.standardised_departures() ** 2 - HEALTHY_DEPARTURE**2, 0.0) * share[point.effect_count :]).sum())
