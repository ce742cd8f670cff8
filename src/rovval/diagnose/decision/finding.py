"""All that one pass of the algorithm finds: the problem, what was searched in it, and the decision; and how the part of a log after an
onset is weighed with the whole of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import inf, log

from rovval.core.data import Array
from rovval.diagnose.decision.verdict import Decision, decide
from rovval.diagnose.effort import NEGLIGIBLE, SETS_WEIGHED
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.problem.problem import Problem, corrected_residuals
from rovval.diagnose.residuals.sensor_faults import FittedFault, sensor_faults
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.joint import refitted
from rovval.diagnose.search.model import Model, Part, best_of_each_set
from rovval.diagnose.search.onset import evidence_with_onset, moved_onset, with_onset


@dataclass(frozen=True, slots=True)
class Search:
    """One pass of the algorithm, nothing decided yet.

    Attributes:
        problem: the estimation problem that was posed.
        untestable: effects and hypotheses that the log cannot test, with the reason.
        selection: what was met.
    """

    problem: Problem
    untestable: Mapping[str, str]
    selection: Selection


@dataclass(frozen=True, slots=True)
class Finding(Search):
    """One pass of the algorithm, and what is decided by it.

    Attributes:
        residuals: the nominal vehicle's, per run (windows, samples, channels).
        faults: of sensors, each fitted to the parity residuals by itself.
        decision: the verdict.
    """

    residuals: list[Array]
    faults: tuple[FittedFault, ...]
    decision: Decision


def decided(met: Search) -> Finding:
    """What a pass decides."""
    problem, residuals = met.problem, corrected_residuals(met.problem)
    faults = tuple(f for check, part in zip(problem.parity, problem.runs, strict=True) for f in sensor_faults(check, part, problem.origin))
    return Finding(problem, met.untestable, met.selection, residuals, faults, decide(problem, met.selection, residuals, faults))


def may_begin(whole: Finding, time: float) -> bool:
    """Whether it is worth a search what may be at work from ``time`` (s) on alone: where the ``whole`` log has no answer, or one that needs further numbers of
    the file to be off beside it, and where its most probable causes have an onset of their own or may as well begin then (not negligible beside all through,
    `NEGLIGIBLE`); the windows before do not hold what else begins on a healthy vehicle."""
    problem, best, healthy, decision = whole.problem, whole.selection.best, whole.selection.healthy, whole.decision
    if best.fit is None or any(h.effect.begins for h in best.causes) or decision.verdict == "unknown":
        return True
    if decision.probabilities.off_beside(frozenset(h.name for h in decision.causes)):
        return True
    return evidence_with_onset(problem, best.fit, time, healthy) > best.evidence + 2.0 * log(NEGLIGIBLE)


def began(late: Search, whole: Search, time: float) -> float:
    """When (s) the likeliest causes in the part of the ``whole`` log from ``time`` on began; ``time`` where there are none, and where they began in the window
    before: that holds them in part, and in a part of the log they would have to be at work all through."""
    best, windows = late.selection.best, whole.problem.runs[0]
    moved = moved_onset(whole.problem, best.fit, time, whole.selection.healthy) if best.fit else time
    starts = windows.start * windows.run.dt
    return time if moved == starts[starts < time].max(initial=-inf) else moved


def weighed_with(late: Finding, whole: Finding, time: float) -> Finding:
    """The decision between the models of the ``whole`` log and those of its ``late`` part, from ``time`` (s) on, the vehicle healthy before; of the pass that
    found the causes which are named, or of the whole log where none are."""
    problem, selection = whole.problem, whole.selection
    later = list[Model]()
    for causes, part in _leading(late, time):
        log_prior = selection.prior.log_mass(causes)
        later.append(with_onset(problem, causes, log_prior, part, selection.healthy, later[0] if later else None))
    both = replace(selection, models=(*selection.models, *later))
    decision = decide(problem, both, whole.residuals, whole.faults, whole.decision)
    return replace(whole, decision=decision) if decision.since is None else replace(_with_the_rest(late, whole), decision=decision)


def _with_the_rest(late: Finding, whole: Finding) -> Finding:
    """The finding of a part of the log, with what the ``whole`` of it says of effects that were left out there because they have an onset of their own."""
    told = {name for name, _ in late.selection.ranking} | set(late.untestable)
    rest = tuple(row for row in whole.selection.ranking if row[0] not in told)
    untestable = {name: why for name, why in whole.untestable.items() if name not in told}
    return replace(late, selection=replace(late.selection, ranking=(*late.selection.ranking, *rest)), untestable={**late.untestable, **untestable})


def _leading(late: Finding, time: float) -> list[tuple[tuple[Hypothesis, ...], Part]]:
    """The sets of causes that are the most probable in a part of the log by prior and fit, the first of them first, with what they are there."""
    problem, fitted = late.problem, best_of_each_set(late.selection.models)
    sets = [refitted(problem, fitted[names]) for names in late.decision.probabilities.ranked[:SETS_WEIGHED] if names in fitted]
    return [(m.causes, Part(time, problem, m.fit)) for m in sorted(sets, key=lambda m: -m.log_posterior) if m.fit]
