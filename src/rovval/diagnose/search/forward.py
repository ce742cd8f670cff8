"""Forward selection: causes are added one at a time, each fitted jointly with those before it, as long as a step finds one.

A step asks three questions. Is there anything beyond coefficients within tolerance and the causes so far (`detection`)? Which hypotheses, fitted by
re-simulation, explain most of it on windows that they were not fitted on (`candidates`, `admissibility`)? Which does this log not tell from the best of
them (`confusion`)? A cause that later ones make needless is dropped. When no step adds a cause, the causes are weighed beside each
other (`joint`), and where one is not sufficient there, the search goes on without it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.diagnose.criteria import (
    EVIDENT_WITHOUT_TEST,
    FALSE_ALARM,
    LEAST_EVIDENCE,
    MOST_CAUSES,
    MOST_STEPS,
    NEEDLESS_EVIDENCE,
    OFFSET_EVIDENCE,
    OFFSET_TRIED,
    PROMISING_EVIDENCE,
    STRONG_EVIDENCE,
)
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of, prior_of, wide_prior
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, fit_hypothesis, fit_quickly
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.inference.map_fit import refit_healthy
from rovval.diagnose.problem.cross_validation import FoldSums, compare_held_out, cross_validate
from rovval.diagnose.problem.problem import Problem, equations_at
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.search.admissibility import admissible, possible, simplest
from rovval.diagnose.search.baseline import Baseline, Candidate, SelectedCause, baseline_of, healthy_baseline
from rovval.diagnose.search.candidates import candidates, relinearised
from rovval.diagnose.search.confusion import confusion_group
from rovval.diagnose.search.detection import Detection, detect
from rovval.diagnose.search.joint import reselected, sufficient
from rovval.diagnose.search.onset import Onset, suspected_onset

Row = tuple[str, float, float]  # a candidate's name, evidence over its baseline, and reduction of the gap


@dataclass(frozen=True, slots=True)
class Selection:
    """What a search found.

    Attributes:
        causes: in the order found.
        fit: their joint fit; None where nothing was found.
        healthy: the fit of coefficients within tolerance, without causes.
        ranking: every hypothesis with the reduction of the gap that it makes by itself, held out: the causes first, then by that.
        steps: of each step that had any, its candidates.
        p_value: of the detection of the last step, and its evidence ``last_evidence`` beside the 95 % quantile of null logs, ``null_evidence``.
        onset: from when on something seems to be at work that was not there before; None where nothing does.
    """

    causes: tuple[SelectedCause, ...]
    fit: HypothesisFit | None
    healthy: Posterior
    ranking: tuple[tuple[str, float], ...]
    steps: tuple[tuple[Row, ...], ...]
    p_value: float
    onset: Onset | None
    last_evidence: float
    null_evidence: float


@dataclass(frozen=True, slots=True)
class Step:
    """One step of the search: its detection; the candidates that may be ``added``, and all that are ``admitted`` as the cause, best evidence first; rows of
    all that were weighed; and, in the first, the suspected onset."""

    detection: Detection
    added: list[Candidate]
    admitted: list[Candidate]
    rows: tuple[Row, ...]
    onset: Onset | None


def search(
    problem: Problem, library: list[Hypothesis], initialised: list[Hypothesis], healthy: Posterior, seed: int, progress: Callable[[str, float], None]
) -> Selection:
    """The causes that explain the gap.

    Args:
        problem: the estimation problem.
        library: hypotheses that compete, as the problem was linearised in.
        initialised: the same with the initial points that the log suggests.
        healthy: fit of coefficients within tolerance, without causes.
        seed: of the null logs and bootstraps.
        progress: called with what is being done and the share of the work that is done (0 to 1).
    """
    causes, refused, steps = list[SelectedCause](), set[str](), list[Step]()
    for number in range(MOST_STEPS):
        progress(f"screening {len(initialised)} hypotheses, round {number + 1}", 0.3 + 0.1 * number)
        open_now = [h for h in initialised if h.name not in {n.hypothesis.name for n in causes} | refused]
        steps.append(_step(problem, initialised, open_now, causes, healthy, seed + number))
        if steps[-1].added:
            causes = _pruned(problem, [*causes, _cause(problem, steps[-1], seed)])
            if len(causes) < MOST_CAUSES:
                continue
        progress("weighing the causes beside each other", 0.35 + 0.1 * number)
        healthy = _restarted(problem, healthy, causes)
        kept = reselected(problem, causes, healthy, seed)
        refused |= {n.hypothesis.name for n in causes} - {n.hypothesis.name for n in kept}
        done, causes = len(kept) in (0, MOST_CAUSES, len(causes)), kept
        if done:
            break
    else:
        healthy = _restarted(problem, healthy, causes)
        causes = reselected(problem, causes, healthy, seed)
    rows, last = tuple(s.rows for s in steps if s.rows), steps[-1].detection
    ranking, null = _ranking(problem, library, causes, rows), float(np.quantile(last.null, 0.95))
    joint = causes[-1].fit if causes else None
    return Selection(tuple(causes), joint, healthy, ranking, rows, last.p_value(last.best), steps[0].onset, last.largest, null)


def _step(problem: Problem, library: list[Hypothesis], open_now: list[Hypothesis], causes: list[SelectedCause], healthy: Posterior, seed: int) -> Step:
    """Is there anything beyond the causes, and which of the open hypotheses may be added to them?"""
    chosen = causes[-1].fit.slots if causes else ()
    baseline = baseline_of(causes[-1].fit) if causes else healthy_baseline(problem, healthy)
    data = _linearised(problem, library, baseline.posterior)
    detection = _detection(problem, data, open_now, chosen, seed)
    onset = None if causes else suspected_onset(problem, data, open_now)
    most = detection.largest
    if most < PROMISING_EVIDENCE * LEAST_EVIDENCE or (detection.p_value(detection.best) > FALSE_ALARM and most < EVIDENT_WITHOUT_TEST):
        return Step(detection, [], [], (), onset)
    one, tried = _weighed(problem, data, open_now, detection, causes, baseline, onset)
    rest = [h for h in open_now if h.name not in tried]
    if one.added or causes or max((detection.evidence[h.label] for h in rest), default=0.0) < LEAST_EVIDENCE:
        return one
    other, _ = _weighed(problem, data, rest, detection, causes, baseline, onset)  # kept out by what promised much and keeps nothing
    return replace(other, rows=tuple(sorted((*one.rows, *other.rows), key=lambda row: -row[1])))


def _weighed(
    problem: Problem, data: NormalEquations, library: list[Hypothesis], detection: Detection, causes: list[SelectedCause], baseline: Baseline,
    onset: Onset | None,
) -> tuple[Step, set[str]]:
    """The step with the best of a library fitted by re-simulation, and the names of those that were."""
    weighed = candidates(problem, data, library, detection.evidence, baseline, causes[-1].fit.slots if causes else ())
    tried = {c.hypothesis.name for c in weighed}
    admitted = admissible(problem, relinearised(problem, admissible(problem, weighed), baseline))
    rows = tuple((c.hypothesis.name, c.evidence, c.gain) for c in admitted or weighed)
    enough = [c for c in admitted if sufficient(c, alone=not causes)]
    if enough:
        return Step(detection, enough, admitted, rows, onset), tried
    offset = _offset(problem, weighed, baseline, sum(n.evidence for n in causes))
    return Step(detection, offset, offset, rows, onset), tried


def _offset(problem: Problem, weighed: list[Candidate], baseline: Baseline, evidence: float) -> list[Candidate]:
    """The candidate with the most evidence, though it gains little by itself, as long as others are still to be found: of two causes that
    offset each other, each alone opens the gap. Whether it is sufficient is asked again in the end (`joint`). Beside causes of so
    much ``evidence``, model-form error alone leaves a share."""
    least = max(STRONG_EVIDENCE, OFFSET_EVIDENCE * evidence)
    strong = [c for c in possible(problem, weighed) if c.evidence >= least][:OFFSET_TRIED]
    return [c for c in possible(problem, relinearised(problem, strong, baseline)) if c.evidence >= least][:1] if strong else []


def _linearised(problem: Problem, library: list[Hypothesis], base: Posterior) -> NormalEquations:
    """Normal equations of a library about the point reached, with how far each column is from its prior there."""
    asked = columns_of(library)
    data = equations_at(problem, base.beta, tuple(sorted({*asked.slots, *problem.tolerance.sd, *base.columns})), asked.displaced)
    offset = np.array([base.beta[c] - problem.origin[c] if c < len(base.beta) else 0.0 for c in data.columns])
    return replace(data, offset=offset)


def _detection(problem: Problem, data: NormalEquations, library: list[Hypothesis], chosen: tuple[int, ...], seed: int) -> Detection:
    """Evidence of each hypothesis on top of tolerances and of what was chosen before."""
    slots = [c for c in data.columns if c < len(problem.plant.slots)]
    typical = Prior({c: problem.plant.slots[c].parameter.typical for c in slots})
    everything = cross_validate(FoldSums.of(data, problem.folds), typical, problem.design_effect).step
    base = problem.tolerance.widened(wide_prior(problem, chosen))
    return detect(data, base, problem.tolerance, {h.label: prior_of(problem, h) for h in library}, problem.design_effect, everything, seed)


def _restarted(problem: Problem, healthy: Posterior, causes: list[SelectedCause]) -> Posterior:
    """The healthy fit, tried from another start, where it is beside the causes, too."""
    return refit_healthy(problem, healthy, causes[-1].fit.posterior, causes[-1].fit.slots) if causes else healthy


def _cause(problem: Problem, step: Step, seed: int) -> SelectedCause:
    """The best of those that may be added, with those that this log does not tell from it."""
    best = simplest(problem, step.added)
    group = confusion_group(problem, step.admitted, seed)
    if best.hypothesis.name not in dict(group):  # one that gains too little to be a cause has far more evidence
        group = confusion_group(problem, step.added, seed)
    group = tuple(sorted(group, key=lambda member: member[0] != best.hypothesis.name))
    chosen_from = tuple(replace(c, fit=c.fit.without_sensitivities()) for c in step.admitted)
    whole = best.fit if best.fit.posterior.whitened else fit_hypothesis(problem, best.fit.posterior.beta, best.fit.slots)
    return SelectedCause(best.hypothesis, group, whole, step.detection.p_value(best.hypothesis.label), best.evidence, chosen_from)


def _pruned(problem: Problem, causes: list[SelectedCause]) -> list[SelectedCause]:
    """Without causes that the last one made needless: the evidence of the joint fit is no worse without them."""
    for one in causes[:-1]:
        whole = causes[-1].fit
        slots = tuple(s for s in whole.slots if s not in one.hypothesis.slots)
        start = whole.beta.copy()
        start[list(one.hypothesis.slots)] = problem.origin[list(one.hypothesis.slots)]
        without = fit_quickly(problem, start, slots, whole.posterior.whitened)
        if without.evidence > whole.evidence - NEEDLESS_EVIDENCE:
            without = fit_hypothesis(problem, without.posterior.beta, slots)
            rest = [n for n in causes if n is not one]
            causes = [*rest[:-1], replace(rest[-1], fit=without)]
    return causes


def _ranking(problem: Problem, library: list[Hypothesis], causes: list[SelectedCause], steps: Sequence[Sequence[Row]]) -> tuple[tuple[str, float], ...]:
    """Every hypothesis with the reduction of the gap that it makes by itself, held out, coefficients as filed: the causes first, then the others by
    that, fitted by re-simulation for the first step's candidates, linearised for the rest."""
    priors = {h.label: prior_of(problem, h) for h in library}
    _, fits = compare_held_out(FoldSums.of(problem.gap.total, problem.folds), Prior({}), priors, problem.design_effect)
    gap, share = float(problem.gap.total.c.sum()), dict[str, float]()
    for h in library:
        share[h.name] = max(1.0 - fits[h.label].loss / gap, share.get(h.name, -np.inf))
    share |= {name: gain for name, _, gain in (steps[0] if steps else ())}
    leading = dict.fromkeys(n.hypothesis.name for n in causes)
    others = sorted((name for name in share if name not in leading), key=lambda name: -share[name])  # equals in the order of the library
    return tuple((name, share[name]) for name in (*leading, *others))
