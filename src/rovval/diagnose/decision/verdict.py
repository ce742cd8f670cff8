"""The verdict: explained, partly explained, unknown, or no gap. It is decided here and nowhere else.

What was found is named if no reason speaks against it (`rejection`). Causes whose value is not constant along the log are left out and reported as what is
left; faults of sensors that the parity residuals isolate by themselves stay, whatever speaks against the others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from rovval.core.data import Array
from rovval.diagnose.criteria import (
    BROKEN_DEPARTURE,
    BY_CHANCE,
    FALSE_ALARM,
    FURTHER_CAUSE_BELIEF,
    GENERIC_EVIDENCE,
    NEAR_GAIN,
    NEAR_LITTLE,
    OUT_OF_TOLERANCE,
)
from rovval.diagnose.decision.indications import Indications, indications
from rovval.diagnose.decision.rejection import Assessment, assess, of_sensor
from rovval.diagnose.decision.unexplained import Accounted, Unexplained, accounted, open_gap, unexplained
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.sensor_faults import FittedFault
from rovval.diagnose.search.baseline import SelectedCause
from rovval.diagnose.search.discrepancy import GenericForces, generic_forces, nominal_forces
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.joint import joint_fit

Verdict = Literal["no_gap", "explained", "partly_explained", "unknown"]


@dataclass(frozen=True, slots=True)
class Decision:
    """What a diagnosis decides.

    Attributes:
        verdict: ``no_gap``, ``explained``, ``partly_explained`` or ``unknown``.
        causes: the causes that are isolated, in the order found; empty for ``no_gap`` and ``unknown``.
        fit: their joint fit; None without causes.
        groups: of each cause the names that this log does not tell from it (itself first) with their probabilities.
        probability: of each cause.
        evidence: twice the log Bayes factor of the causes over the healthy vehicle; of ``unknown`` and ``no_gap`` of those that were rejected.
        generic_instead: the same of generic forces in the causes' place.
        generic_beside: the same of generic forces beside the causes, over the causes.
        departure: largest standardised departure of a coefficient that is no cause's, in standard deviations of its prior.
        accounted: what of the gap needs no cause.
        unexplained: what is left; None where nothing is.
        indications: what points to a cause where none is named; None where causes are.
    """

    verdict: Verdict
    causes: tuple[SelectedCause, ...]
    fit: HypothesisFit | None
    groups: Mapping[str, tuple[tuple[str, float], ...]]
    probability: Mapping[str, float]
    evidence: float
    generic_instead: float
    generic_beside: float
    departure: float
    accounted: Accounted
    unexplained: Unexplained | None
    indications: Indications | None = None


def decide(problem: Problem, selection: Selection, residuals: list[Array], faults: Sequence[FittedFault]) -> Decision:
    """The verdict on what a search found; ``residuals`` are the nominal vehicle's, ``faults`` of sensors those that parity residuals show."""
    general = generic_forces(problem, selection.healthy)
    assessed = _assessed(problem, selection, general, residuals)
    if assessed and assessed.inconstant and not assessed.rejected:
        selection, assessed = _constant(problem, selection, assessed, general, residuals)
    if assessed and assessed.by_parity and assessed.rejected:
        selection = _reduced_to(problem, selection, tuple(n for n in selection.causes if of_sensor(n)))
        assessed = replace(assessed, remainder=True)
    if selection.fit and assessed and (assessed.by_parity or not assessed.rejected):
        return _isolated(problem, selection, selection.fit, assessed)
    decision = _not_isolated(problem, selection, assessed, general, residuals)
    first = selection.steps[0] if selection.steps else ()
    return replace(decision, indications=indications(first, decision.accounted, faults))


def _assessed(problem: Problem, selection: Selection, general: GenericForces, residuals: list[Array]) -> Assessment | None:
    """What speaks for and against the causes found; None where there are none."""
    return assess(problem, selection.causes, selection.fit, selection.healthy, general, residuals) if selection.fit else None


def _isolated(problem: Problem, selection: Selection, fit: HypothesisFit, assessed: Assessment) -> Decision:
    """The causes are named."""
    groups = {n.hypothesis.name: n.group for n in selection.causes}
    gone = [name for name in assessed.inconstant if name not in groups]
    rest = unexplained(problem, assessed.forces, fit.posterior, gone) if assessed.remainder else None
    surest = max(selection.causes, key=lambda n: n.evidence)
    probability = {n.hypothesis.name: _probability(n) * (1.0 if n is surest or of_sensor(n) else FURTHER_CAUSE_BELIEF) for n in selection.causes}
    verdict: Verdict = "partly_explained" if assessed.remainder else "explained"
    figures = assessed.evidence, assessed.generic_instead, assessed.generic_beside, assessed.departure
    return Decision(verdict, selection.causes, fit, groups, probability, *figures, accounted(problem, selection.healthy), rest)


def _not_isolated(problem: Problem, selection: Selection, assessed: Assessment | None, general: GenericForces, residuals: list[Array]) -> Decision:
    """An unknown cause where something is surely at work (a force, a coefficient far beyond tolerance, an effect that nearly fits) or where the gap stays
    open; else no gap."""
    evidence, followed, inconstant = (assessed.evidence, assessed.followed, assessed.inconstant) if assessed else (0.0, True, ())
    anything, departure = general.evidence(), selection.healthy.largest_departure()
    first = selection.steps[0] if selection.steps else ()
    tried = max((worth if gain > NEAR_GAIN else worth / NEAR_LITTLE for _, worth, gain in first), default=0.0)
    nearly = followed and (max(evidence, tried) > GENERIC_EVIDENCE or bool(inconstant))
    sure = nearly or (anything > GENERIC_EVIDENCE and general.held_out_gain(problem.folds) > BY_CHANCE) or departure > BROKEN_DEPARTURE
    known = accounted(problem, selection.healthy)
    rest = unexplained(problem, nominal_forces(problem), selection.healthy, inconstant) if sure else open_gap(problem, known, residuals)
    return Decision("unknown" if rest else "no_gap", (), None, {}, {}, evidence, anything, anything, departure, known, rest)


def _constant(
    problem: Problem, selection: Selection, assessed: Assessment, general: GenericForces, residuals: list[Array]
) -> tuple[Selection, Assessment]:
    """The causes without those that are not constant, which are reported as what is left."""
    kept = tuple(n for n in selection.causes if n.hypothesis.name not in assessed.inconstant)
    if not kept:
        return selection, replace(assessed, rejected=True)
    selection = _reduced_to(problem, selection, kept)
    again = _assessed(problem, selection, general, residuals)
    assert again is not None
    return selection, without_inconstant(again, assessed.inconstant)


def without_inconstant(again: Assessment, inconstant: tuple[str, ...]) -> Assessment:
    """The assessment ``again`` of causes after those named ``inconstant`` went. They are rejected as well where another is inconstant now, or where what went
    had kept a coefficient within its tolerance: another cause is there."""
    rejected = again.rejected or bool(again.inconstant) or again.departure > OUT_OF_TOLERANCE
    return replace(again, remainder=True, rejected=rejected, inconstant=inconstant)


def _reduced_to(problem: Problem, selection: Selection, kept: tuple[SelectedCause, ...]) -> Selection:
    """The selection with the causes ``kept`` alone, fitted again."""
    fit = selection.fit
    if fit is None or not kept or len(kept) == len(selection.causes):
        return selection
    return replace(selection, causes=kept, fit=joint_fit(problem, fit, [n.hypothesis for n in kept]))


def _probability(cause: SelectedCause) -> float:
    """Probability of the cause's name in its group, less the chance that detection itself was false."""
    return float(cause.group[0][1] * (1.0 - min(cause.p_value, FALSE_ALARM)))
