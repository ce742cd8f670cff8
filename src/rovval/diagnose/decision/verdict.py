"""The verdict: explained, partly explained, unknown, or no gap: the most probable of the models that were compared. It is decided here and nowhere else."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import FILE_WIDTH, MOST_CAUSES
from rovval.diagnose.decision.consistency import inconsistencies
from rovval.diagnose.decision.constancy import variation
from rovval.diagnose.decision.indications import Indications, indications
from rovval.diagnose.decision.posterior import Names, Probabilities, probabilities
from rovval.diagnose.decision.unexplained import Accounted, Unexplained, accounted, open_gap, unexplained
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.gap import weighted_errors
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.laplace import Posterior, laplace_evidence
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.sensor_faults import FittedFault
from rovval.diagnose.search.discrepancy import GenericForces, generic_forces, nominal_forces
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.model import Model

Verdict = Literal["no_gap", "explained", "partly_explained", "unknown"]


@dataclass(frozen=True, slots=True)
class Decision:
    """What a diagnosis decides.

    Attributes:
        verdict: ``no_gap``, ``explained``, ``partly_explained`` or ``unknown``.
        probabilities: of all models.
        causes: those of the most probable set, the surest first; empty for ``no_gap`` and ``unknown``.
        fit: their joint fit; None without causes.
        groups: of each cause the names that this log does not tell from it (itself first) with their probabilities.
        probability: that each cause is at work.
        added: of each cause, twice the log Bayes factor of the set over the set without it.
        evidence: twice the log Bayes factor of the best set of causes over the healthy vehicle, named or not.
        generic_instead: the same of something else in the causes' place, its prior among generic forces paid; 0 where no force gains.
        generic_beside: the same of something else beside the causes, over the causes.
        departure: largest standardised departure of a coefficient that is no cause's, in standard deviations of its prior.
        accounted: what of the gap needs no cause.
        unexplained: what is left; None where nothing is.
        indications: what points to a cause where none is named; None where causes are.
    """

    verdict: Verdict
    probabilities: Probabilities
    causes: tuple[Hypothesis, ...]
    fit: HypothesisFit | None
    groups: Mapping[str, tuple[tuple[str, float], ...]]
    probability: Mapping[str, float]
    added: Mapping[str, float]
    evidence: float
    generic_instead: float
    generic_beside: float
    departure: float
    accounted: Accounted
    unexplained: Unexplained | None
    indications: Indications | None = None


def decide(problem: Problem, selection: Selection, residuals: list[Array], faults: Sequence[FittedFault]) -> Decision:
    """The verdict on what a search met; ``residuals`` are the nominal vehicle's, ``faults`` of sensors those that parity residuals show."""
    instead = generic_forces(problem, selection.healthy)
    best = selection.best
    beside = generic_forces(problem, best.fit.posterior) if best.fit else instead
    evidence, more = instead.sparse()[0], beside.sparse()[0] if best.fit else 0.0
    varies = variation(problem, best.fit.posterior, best.causes) if best.fit else 0.0
    belief = probabilities(selection, _file_evidence(problem, selection), evidence, {best.names: more} if best.fit else {}, varies)
    known = accounted(problem, selection.healthy)
    over = best.evidence - selection.models[0].evidence
    found = Decision("no_gap", belief, (), None, {}, {}, {}, over, max(evidence, 0.0), max(more, 0.0), selection.healthy.largest_departure(), known, None)
    contradicted = any(h.effect.place != "sensor" for h in best.causes) and _contradicted(problem, residuals)
    if best.fit and belief.causes > max(belief.healthy, belief.file, belief.something_else) and not contradicted:
        return _named(problem, selection, found, best, best.fit, beside)
    first = selection.steps[0] if selection.steps else ()
    found = replace(found, indications=indications(first, known, faults))
    if belief.healthy > max(belief.file, belief.something_else, belief.causes):
        rest = open_gap(problem, replace(known, departure=0.0), residuals)  # it is believed, so what its coefficients account for counts
        return replace(found, verdict="unknown" if rest else "no_gap", unexplained=rest)
    inconstant = [h.name for h in best.causes] if belief.varying > 0.5 * belief.something_else else []
    return replace(found, verdict="unknown", unexplained=unexplained(problem, nominal_forces(problem), selection.healthy, inconstant))


def _named(problem: Problem, selection: Selection, found: Decision, best: Model, fit: HypothesisFit, beside: GenericForces) -> Decision:
    """The causes of the most probable set are named."""
    belief = found.probabilities
    probability = {h.name: belief.of(h.name) for h in best.causes}
    partly = belief.partly(best.names)
    return replace(
        found,
        verdict="partly_explained" if partly else "explained",
        causes=tuple(sorted(best.causes, key=lambda h: -probability[h.name])),
        fit=fit,
        groups={h.name: belief.group(h.name) for h in best.causes},
        probability=probability,
        added={h.name: best.evidence - _evidence_without(selection, best.names - {h.name}) for h in best.causes},
        departure=fit.posterior.largest_departure(),
        unexplained=unexplained(problem, beside, fit.posterior) if partly else None,
    )


def _contradicted(problem: Problem, residuals: list[Array]) -> bool:
    """Whether the log contradicts itself on the axis of the largest gap: a fault of a sensor that the library lacks, whatever explains the gap."""
    weight = weighted_errors(problem, residuals)
    return bool(inconsistencies(problem, dict([max(weight.items(), key=lambda item: item[1])])))


def _evidence_without(selection: Selection, rest: Names) -> float:
    """Evidence of a set of causes; of the healthy vehicle where it was not fitted."""
    return max((m.evidence for m in selection.models if m.names == rest), default=selection.models[0].evidence)


def _file_evidence(problem: Problem, selection: Selection) -> float:
    """Twice the log Bayes factor, over the file as it is, of one that is off (`FILE_WIDTH`) in more numbers than there may be causes, or in a few that no
    effect which competes is about."""
    plant = problem.plant
    of_file = [s for s in problem.tolerance.sd if (own := plant.slots[s].parameter.tolerance) and own.calibrated]
    compete = {s for name, _ in selection.ranking for s in plant.hypotheses[name]}
    many = departures(problem, selection.healthy, of_file)[MOST_CAUSES:]
    few = departures(problem, selection.healthy, [s for s in of_file if s not in compete])
    return max((*many, *few), default=-np.inf)


def departures(problem: Problem, healthy: Posterior, among: Sequence[int]) -> list[float]:
    """Twice the log Bayes factor, over the file as it is, of one of which one, two, three ... of the numbers ``among`` (slots) are off by as much as
    `FILE_WIDTH` has it: those that explain most, and which they are is paid for. It ends where one more explains no more. One step from the ``healthy``
    fit (automatic relevance determination; MacKay 1992)."""
    columns, found = [healthy.columns.index(s) for s in among], list[float]()
    while columns:
        freed = {i: replace(healthy, precision=_divided(healthy.precision, i)) for i in columns}
        worth = {i: laplace_evidence(problem, one) - 2.0 * (len(found) + 1) * float(np.log(len(among))) for i, one in freed.items()}
        best = max(worth, key=lambda i: worth[i])
        if len(found) > MOST_CAUSES and worth[best] <= found[-1]:
            break
        found.append(worth[best])
        healthy = freed[best]
        columns.remove(best)
    return found


def _divided(precision: Array, i: int) -> Array:
    """The precision of priors with the ``i``-th number as wide as a file that is off has it."""
    return np.where(np.arange(len(precision)) == i, precision / FILE_WIDTH**2, precision)
