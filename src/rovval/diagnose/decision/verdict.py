"""The verdict: explained, partly explained, unknown, or no gap. It is decided here and nowhere else.

What is said is as probable as `NAMED_FROM`: causes, or a healthy vehicle, that are only the most probable of several answers are not (unknown).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import log
from typing import Literal

from rovval.core.data import Array
from rovval.diagnose.decision.consistency import inconsistencies
from rovval.diagnose.decision.constancy import Variation, variation
from rovval.diagnose.decision.indications import Indications, indications
from rovval.diagnose.decision.miscalibration import file_evidence
from rovval.diagnose.decision.open_gap import evidence_of_something_else, left_open, open_gap
from rovval.diagnose.decision.posterior import Probabilities, probabilities, something_beside
from rovval.diagnose.decision.resemblance import adds_to_forces, gap_left, unlogged_about_healthy, unlogged_where_they_act
from rovval.diagnose.decision.unexplained import Accounted, Unexplained, accounted, unexplained, unexplained_by_any
from rovval.diagnose.effort import NEGLIGIBLE, SETS_WEIGHED
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.gap import weighted_errors
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.unlogged_forces import ForceLeft, responses_about, unlogged_forces
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.residuals.sensor_faults import FittedFault
from rovval.diagnose.search.discrepancy import Beside, forces_beside, nominal_forces
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.joint import refitted, some_of, with_relatives, without_each
from rovval.diagnose.search.model import Model, Names, best_of_each_set, better_fits
from rovval.diagnose.search.onset import with_onset

Verdict = Literal["no_gap", "explained", "partly_explained", "unknown"]


@dataclass(frozen=True, slots=True)
class Weighed:
    """What is found beside a model, in the windows in which its causes are at work.

    Attributes:
        of: evidence of the model, and the time from which its causes are at work, where not all through: by these it is known again.
        beside: generic forces beside it; in the fine metric, too, of a model of the whole log.
        varying: by how much the sizes of its causes vary.
        unlogged: the force that nobody logged where its causes act; None where that is not known.
    """

    of: tuple[float, float | None]
    beside: Beside
    varying: Variation
    unlogged: ForceLeft | None


@dataclass(frozen=True, slots=True)
class Common:
    """What all decisions about a log have in common.

    Attributes:
        forces: generic forces beside a healthy vehicle, in the fine metric, too.
        unlogged: force (`unlogged_forces`) that nobody logged beside a healthy vehicle, by axis,
        nominal: and beside the nominal one.
        file: evidence of a file that is off in many numbers, beside no cause and beside the most probable sets of causes (`file_evidence`).
    """

    forces: Beside
    unlogged: Mapping[str, float]
    nominal: Mapping[str, float]
    file: Mapping[Names, float]

    @classmethod
    def of(cls, problem: Problem, selection: Selection) -> Common:
        """That of a log and of what the search met in all of it."""
        segments = responses_about(problem, selection.healthy)
        forces, unlogged = forces_beside(problem, selection.healthy, segments), unlogged_forces(problem, selection.healthy, segments)
        return cls(forces, unlogged, unlogged_forces(problem), file_evidence(problem, selection))


@dataclass(frozen=True, slots=True)
class Decision:
    """What a diagnosis decides.

    Attributes:
        verdict: ``no_gap``, ``explained``, ``partly_explained`` or ``unknown``.
        probabilities: of all models.
        causes: those of the set that is named (`Probabilities.best`) without those without which it is as probable, the surest first, and of those
            that are as sure to a hundredth the one of most evidence; empty for ``no_gap`` and ``unknown``.
        fit: their joint fit; None without causes.
        groups: of each cause the names that this log does not tell from it (itself first) with their probabilities.
        probability: that each cause is at work.
        added: of each cause, twice the log Bayes factor of the set over the set without it.
        evidence: twice the log Bayes factor of the best set of causes over the healthy vehicle, named or not.
        generic_instead: the same of something else in the causes' place, its prior among generic forces paid; 0 where no force gains.
        generic_beside: the same of something else beside the causes, over the causes.
        departure: largest standardised departure of a coefficient that is no cause's, in standard deviations of its prior.
        accounted: what of the gap needs no cause.
        weighed: what was found beside the most probable sets of causes.
        common: what further decisions about the same log have in common with this one.
        open_gap: what is left of the gap beyond noise, over what noise and tolerances are expected to make (1): with the causes that are named, on held-out
            windows.
        unlogged: of the best set, named or not, the force that nobody logged where it acts; None where that is not known.
        unexplained: what is left; None where nothing is.
        indications: what points to a cause where none is named; None where causes are.
        since: s since the run's start from which on the causes are at work, where they are fitted to that part alone; else None.
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
    weighed: Mapping[Names, Weighed]
    common: Common
    open_gap: float
    unlogged: ForceLeft | None
    unexplained: Unexplained | None
    indications: Indications | None = None
    since: float | None = None


def decide(
    problem: Problem, selection: Selection, residuals: list[Array], faults: Sequence[FittedFault], before: Decision | None = None
) -> Decision:
    """The verdict on what a search met; ``residuals`` are the nominal vehicle's, ``faults`` of sensors those that parity residuals show, ``before`` an earlier
    decision about the same log, of which all that is the same is kept."""
    common = before.common if before else Common.of(problem, selection)
    compared = _compared(problem, selection, common, before.weighed if before else {})
    belief, best, known = compared.belief, compared.best, accounted(problem, selection.healthy)
    beside_best = compared.weighed.get(best.names)
    found = Decision(
        "no_gap", belief, (), None, {}, {}, {},
        evidence=best.evidence - selection.models[0].evidence, generic_instead=max(common.forces.evidence, 0.0), generic_beside=0.0,
        departure=selection.healthy.largest_departure(), accounted=known, weighed=compared.weighed, common=common, open_gap=compared.open_gap,
        unlogged=beside_best.unlogged if beside_best else None, unexplained=None,
    )  # fmt: skip
    contradicted = any(h.effect.place != "sensor" for h in best.causes) and _contradicted(problem, residuals)
    if best.fit and beside_best and belief.said == "causes" and not contradicted:
        return _named(problem, found, best, best.fit, compared.without)
    found = replace(found, indications=indications(selection.steps[0] if selection.steps else (), known, faults))
    if belief.said == "healthy":
        return found
    inconstant = [h.name for h in best.causes] if belief.varying > 0.5 * belief.unexplained else []
    goes_with = beside_best.varying.goes_with if inconstant and beside_best else None
    imitated = belief.file > NEGLIGIBLE  # what is at work looks like many numbers of the file, and so goes with the motion
    if belief.unexplained > max(belief.healthy, belief.causes) and common.forces.evidence <= 0.0 and not inconstant and not imitated:
        return replace(found, verdict="unknown", unexplained=unexplained_by_any(problem, known.share, residuals, selection.healthy))
    return replace(found, verdict="unknown", unexplained=unexplained(problem, nominal_forces(problem), selection.healthy, inconstant, goes_with))


@dataclass(frozen=True, slots=True)
class _Compared:
    """Models that a search met and those that stand in for them, compared: their probabilities; the ``best`` set of causes and the models ``without`` each of
    them; what was found beside the sets that were ``weighed``; and the gap that all leave open."""

    belief: Probabilities
    best: Model
    without: Mapping[str, Model]
    weighed: Mapping[Names, Weighed]
    open_gap: float


def _compared(problem: Problem, selection: Selection, common: Common, before: Mapping[Names, Weighed]) -> _Compared:
    """The sets that lead are weighed, and then each that would be named, beside others in the place of each of its causes, until the one that is named has
    been, and those of as many causes that fit better."""
    alone, met = common.forces, list(selection.models)
    gap = open_gap(problem, [selection.healthy, *(m.fit.posterior for m in met if m.fit)])
    about_healthy = {frozenset[str](): unlogged_about_healthy(problem, common.unlogged)} if common.unlogged else {}
    weighed, weigh, exchanged = dict[Names, Weighed](), _leading(problem, selection), {selection.best.names}
    while True:
        weighed |= {m.names: _weighed(problem, m, m.fit, common.nominal, before) for m in weigh if m.fit}
        adding = frozenset(names for names, one in weighed.items() if adds_to_forces(alone.fine, one.beside.fine))
        unlogged = about_healthy | {names: one.unlogged for names, one in weighed.items() if one.unlogged}
        left = replace(gap_left(problem, met), forced=alone.axes, unlogged=unlogged, adding=adding)
        beside, varying = {names: one.beside.evidence for names, one in weighed.items()}, {names: one.varying for names, one in weighed.items()}
        belief = probabilities(met, common.file, alone.evidence, beside, varying, evidence_of_something_else(gap), left)
        best, without = _needed(problem, selection, met, _fitted(problem, selection, met, belief.best))
        weigh = [best] if best.names not in weighed else []
        if best.names in exchanged:
            weigh = weigh or _rivals(problem, met, best, weighed)
        if best.fit is None or (best.names in exchanged and not weigh):
            return _Compared(belief, best, without, weighed, gap)
        met = [best, *(m for m in met if m.names != best.names)]
        if best.names not in exchanged:
            met += with_relatives(problem, selection.prior, selection.library, best, {m.names for m in met})
            exchanged |= {best.names}


def _leading(problem: Problem, selection: Selection) -> list[Model]:
    """The most probable sets of causes, `SETS_WEIGHED` at most, with their sensitivities; none where they are not worth a thought (`NEGLIGIBLE`)."""
    found = sorted((m for m in best_of_each_set(selection.models).values() if m.fit), key=lambda m: -m.log_posterior)[:SETS_WEIGHED]
    return [refitted(problem, m) for m in found if m.log_posterior > selection.log_posterior + log(NEGLIGIBLE)]


def _rivals(problem: Problem, met: Sequence[Model], best: Model, weighed: Mapping[Names, Weighed]) -> list[Model]:
    """The sets of as many causes as the one that would be named that fit better, and of which it is not known what is found beside them: that of one of them
    alone would decide between them."""
    unasked = [m for m in better_fits(met, best) if m.names not in weighed]
    return [refitted(problem, m) for m in unasked[:SETS_WEIGHED]]


def _where_at_work(problem: Problem, model: Model, fit: HypothesisFit) -> tuple[Problem, HypothesisFit]:
    """The windows in which the causes of a model are at work, and the ``fit`` of the model, or the one to these windows."""
    return (model.part.problem, model.part.fit) if model.part else (problem, fit)


def _weighed(problem: Problem, model: Model, fit: HypothesisFit, nominal: Mapping[str, float], before: Mapping[Names, Weighed]) -> Weighed:
    """What is found beside a model; ``nominal`` are the unlogged forces of the whole log beside the nominal vehicle."""
    of = model.evidence, model.part.since if model.part else None
    if model.names in before and before[model.names].of == of:
        return before[model.names]
    there, fit = _where_at_work(problem, model, fit)
    segments = () if model.part else responses_about(there, fit.posterior)
    beside = forces_beside(there, fit.posterior, segments)
    left, at_first = unlogged_forces(there, fit.posterior, segments), unlogged_forces(there) if model.part else nominal
    wanders = any(h.effect.wanders for h in model.causes)
    unlogged = unlogged_where_they_act(there, left, at_first, wanders) if left and at_first else None
    return Weighed(of, beside, variation(there, fit.posterior, model.causes), unlogged)


def _fitted(problem: Problem, selection: Selection, met: Sequence[Model], names: Names) -> Model:
    """The model of a set of causes fitted with care, from where the causes are in a larger set where none of the models ``met`` has them alone; the healthy
    vehicle where there are none."""
    sets = best_of_each_set(met)
    if not names:
        return selection.models[0]
    if names in sets:
        return refitted(problem, sets[names])
    larger = refitted(problem, max((m for whole, m in sets.items() if names < whole), key=lambda m: m.log_posterior))
    assert larger.fit is not None
    causes = tuple(h for h in larger.causes if h.name in names)
    there, whole = _where_at_work(problem, larger, larger.fit)
    found = refitted(there, some_of(there, selection.prior, whole, causes))
    if larger.part and found.fit:  # causes that begin in mid-log do so without the others, too
        return with_onset(problem, causes, found.log_prior, replace(larger.part, fit=found.fit), selection.healthy, larger)
    return found


def _needed(problem: Problem, selection: Selection, met: Sequence[Model], best: Model) -> tuple[Model, dict[str, Model]]:
    """A model without causes without which it is as probable, since others of it stand in for them; and the models without each of those that are left, which
    is the healthy vehicle for causes that begin together in mid-log where no other was fitted."""
    known = best_of_each_set(met)
    while True:
        if best.fit and best.part is None:
            known |= {m.names: m for m in without_each(problem, selection.prior, best, known.keys())}
        without = {h.name: known.get(best.names - {h.name}, known[frozenset()]) for h in best.causes}
        if len(without) < 2 or max(m.log_posterior for m in without.values()) < best.log_posterior:
            return best, without
        idle = max(without, key=lambda name: without[name].log_posterior)
        best = _fitted(problem, selection, [best, *met], best.names - {idle})


def _named(problem: Problem, found: Decision, best: Model, fit: HypothesisFit, without: Mapping[str, Model]) -> Decision:
    """The causes of the best set, which was weighed, are named; they explain a part where generic forces beside them, or sizes that vary along the log, are
    likelier than not, or where they leave more of the gap than noise and tolerances make."""
    belief, weighed, left = found.probabilities, found.weighed[best.names], left_open(problem, fit)
    problem, fit = _where_at_work(problem, best, fit)
    probability = {h.name: belief.of(h.name) for h in best.causes}
    added = {name: best.evidence - m.evidence for name, m in without.items()}
    rest = None
    if something_beside(weighed.beside.evidence, weighed.varying):
        rest = unexplained(problem, weighed.beside.forces, fit.posterior, goes_with=weighed.varying.goes_with)
    elif left > 1.0:
        rest = unexplained_by_any(problem, 1.0 / left, corrected_residuals(problem, fit.beta), fit.posterior)
    return replace(
        found,
        verdict="partly_explained" if rest else "explained",
        causes=tuple(sorted(best.causes, key=lambda h: (-round(probability[h.name], 2), -added[h.name]))),
        fit=fit,
        groups={h.name: belief.group(h.name) for h in best.causes},
        probability=probability,
        added=added,
        generic_beside=max(weighed.beside.evidence, 0.0),
        departure=fit.posterior.largest_departure(),
        open_gap=left,
        unexplained=rest,
        since=best.part.since if best.part else None,
    )


def _contradicted(problem: Problem, residuals: list[Array]) -> bool:
    """Whether the log contradicts itself on the axis of the largest gap: a fault of a sensor that the library lacks, whatever explains the gap."""
    weight = weighted_errors(problem, residuals)
    return bool(inconsistencies(problem, dict([max(weight.items(), key=lambda item: item[1])])))
