"""The candidates of a step: the hypotheses that the linearised screen puts first, fitted by re-simulation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import OUT_OF_TOLERANCE
from rovval.diagnose.effort import (
    COHERENT,
    LEAST_SCREENED,
    MOST_CANDIDATES,
    MOST_COHERENT,
    MOST_REFITTED,
    MOST_RELINEARISED,
    REFITTED_EVIDENCE,
    SCREENED_ANYWAY,
    SCREENED_EVIDENCE,
    SERIOUS_EVIDENCE,
    STARTS_TRIED,
    TANGENT_KEPT,
)
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, prior_of
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, fit_hypothesis, fit_quickly
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.inference.map_fit import progressive_start, tangent_slots
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.coherence import coherence
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import ridge_step
from rovval.diagnose.search.baseline import Baseline, Candidate, compared

Fits = dict[str, tuple[Hypothesis, HypothesisFit]]  # by name: the best initial point of each hypothesis and its fit
Start = Callable[[Hypothesis, tuple[int, ...]], Array]


def candidates(
    problem: Problem, data: NormalEquations, library: list[Hypothesis], promised: Mapping[str, float], needed: Mapping[str, float],
    baseline: Baseline, chosen: tuple[int, ...],
) -> list[Candidate]:  # fmt: skip
    """The best initial point of each of the best hypotheses, fitted jointly with what was chosen before; best evidence first.

    Args:
        problem: what they are fitted to.
        data: normal equations of the library, linearised at the baseline.
        library: hypotheses to choose from.
        promised: evidence of each initial point in that linearisation, by label.
        needed: evidence with which it is not negligible, by label; what promises less, or has less, is fitted quickly and no further, and not at all beside
            causes that were chosen before.
        baseline: the model that they are added to.
        chosen: slots of the causes of the baseline.
    """
    base = baseline.posterior
    ordered = sorted(library, key=lambda h: (not h.evident, -promised[h.label]))
    share = SCREENED_EVIDENCE * max(0.0, *(promised[h.label] for h in library))
    prior = problem.tolerance.plus(wide_sd(problem.plant, chosen))
    fits: Fits = {}

    def steps(h: Hypothesis) -> Array:
        return ridge_step(data, prior.plus(prior_of(problem, h).sd), problem.tempering)

    def alone(h: Hypothesis, slots: tuple[int, ...]) -> Array:
        """The start where all else stays as in the baseline: a step of everything may lead away what was found before."""
        return start_of(problem, data, h, np.where(np.isin(data.columns, h.columns), steps(h), 0.0), base.beta, slots)

    def fit_from(h: Hypothesis, begin: Array, slots: tuple[int, ...]) -> None:
        quick = fit_quickly(problem, begin, slots, base.whitened).without_sensitivities()
        if h.name not in fits or quick.evidence > fits[h.name][1].evidence:
            fits[h.name] = h, quick

    def astray(h: Hypothesis) -> bool:
        """Whether the fit is worse than without the hypothesis, which it has as a special case."""
        return fits[h.name][1].posterior.predicted_cost() > base.predicted_cost()

    def refit(h: Hypothesis) -> None:
        slots = tuple(dict.fromkeys((*chosen, *h.slots)))
        start = start_of(problem, data, h, steps(h), base.beta, slots)
        if h.effect.continues:
            start = _beyond(problem, h, start)
        if h.evident:
            start = progressive_start(problem, alone(h, slots), slots)
        for begin in (start, *_departed(problem, base, h, start)):
            fit_from(h, begin, slots)
        if astray(h):
            fit_from(h, alone(h, slots), slots)
        if astray(h):
            fit_from(h, progressive_start(problem, alone(h, slots), slots), slots)

    tries = Counter[str]()
    for h in ordered:
        least = max(share if len(fits) >= LEAST_SCREENED else min(share, SCREENED_ANYWAY), needed[h.label] if chosen else -np.inf)
        promising = h.evident or promised[h.label] > least
        if promising and (tries[h.name] < STARTS_TRIED if h.name in fits and _has_local_minima(h) else h.name not in fits and len(fits) < MOST_CANDIDATES):
            refit(h)
            tries[h.name] += 1
    for h in _like_the_best(data, ordered, fits):
        if h.name not in fits:
            refit(h)
    if included := _included(problem, library, fits):
        h, begin = included
        fit_from(h, begin, tuple(dict.fromkeys((*chosen, *h.slots))))
    carefully = _refitted(problem, promised, needed, fits, alone if chosen else None, baseline.evidence)
    return _relinearised(problem, _compared(list(carefully.values()), baseline), needed, baseline)


def _like_the_best(data: NormalEquations, ordered: list[Hypothesis], fits: Fits) -> list[Hypothesis]:
    """Hypotheses whose sensitivities are coherent with the best fit's, and those that one of the fits may imitate: fitted whatever the screen said."""
    if not fits:
        return []
    best = max(fits.values(), key=lambda item: item[1].evidence)[0]
    twins = [h for h in ordered if h.name not in fits and coherence(data, best.columns, h.columns) > COHERENT]
    further = [h for h in ordered if h.effect.continues and f"{h.effect.continues}{h.of}" in fits]
    return [*twins[:MOST_COHERENT], *further]


def _included(problem: Problem, library: Sequence[Hypothesis], fits: Fits) -> tuple[Hypothesis, Array] | None:
    """What the best fit is where its own size is nothing (a tether's pull without its drag), and the parameters there; None where it includes nothing."""
    if not fits:
        return None
    best, fit = max(fits.values(), key=lambda item: item[1].evidence)
    name = f"{best.effect.includes}{best.of}"
    plain = next((h for h in library if best.effect.includes and h.name == name), None)
    if plain is None:
        return None
    found, start, slots = fit.posterior.beta, fit.posterior.beta.copy(), problem.plant.slots
    start[list(best.slots)] = problem.origin[list(best.slots)]
    there, placed = {slots[s].parameter.name: found[s] for s in best.slots}, dict(plain.at)
    for s in plain.slots:
        start[s] = there.get(slots[s].parameter.name, placed.get(s, problem.origin[s]))
    return plain, start


def _departed(problem: Problem, base: Posterior, h: Hypothesis, start: Array) -> list[Array]:
    """The start with the parameters of ``h`` where the baseline has them, if it has one of them far beyond its tolerance: what the fit of a healthy vehicle
    has walked to lies nearer than where one step of the linearisation leads."""
    beyond = [s for s in h.slots if s in problem.tolerance.sd and abs(base.beta[s] - problem.origin[s]) > OUT_OF_TOLERANCE * problem.tolerance.sd[s]]
    there = start.copy()
    there[list(h.slots)] = base.beta[list(h.slots)]
    return [there] if beyond else []


def _has_local_minima(h: Hypothesis) -> bool:
    """Whether fits of it end in one of many local minima: it begins well away from no effect and is not fitted through the beginnings of windows, or it
    oscillates."""
    return (h.from_full_size and not h.evident) or h.effect.has("period")


def _refitted(
    problem: Problem, promised: Mapping[str, float], needed: Mapping[str, float], fits: Fits, alone: Start | None, ground: float
) -> Fits:
    """The fits; those that promise most, and of which a quick fit with fixed sensitivities kept little, made with care: from where it ended, and from
    ``alone``, where there is one. ``ground`` is the evidence of the baseline."""
    promise = {name: promised[h.label] for name, (h, _) in fits.items()}
    kept = {name: quick.evidence - ground for name, (_, quick) in fits.items()}
    least = {name: max(REFITTED_EVIDENCE * max(kept.values()), needed[h.label]) for name, (h, _) in fits.items()}
    short = sorted((name for name in fits if kept[name] < TANGENT_KEPT * promise[name] and promise[name] >= least[name]), key=lambda name: -promise[name])
    found = dict(fits)
    for name in short[:MOST_REFITTED]:
        h, quick = fits[name]
        starts = [quick.posterior.beta, *([alone(h, quick.slots)] if alone else [])]
        careful = [fit_hypothesis(problem, start, quick.slots).without_sensitivities() for start in starts]
        found[name] = h, max((quick, *careful), key=lambda one: one.evidence)
    return found


def _relinearised(problem: Problem, some: list[Candidate], needed: Mapping[str, float], baseline: Baseline) -> list[Candidate]:
    """The best of the candidates fitted with sensitivities made at their own point, the others as they are; best evidence first."""
    serious = [c for c in some if c.evidence > max(SERIOUS_EVIDENCE * some[0].evidence, needed[c.hypothesis.label])][:MOST_RELINEARISED]
    again = [(c.hypothesis, fit_hypothesis(problem, c.fit.posterior.beta, c.fit.slots)) for c in serious]
    return _compared(again + [(c.hypothesis, c.fit) for c in some if c not in serious], baseline)


def _compared(fits: list[tuple[Hypothesis, HypothesisFit]], baseline: Baseline) -> list[Candidate]:
    """Fits with what they add to the baseline, best evidence first."""
    return sorted((compared(h, fit, baseline) for h, fit in fits), key=lambda c: -c.evidence)


def _beyond(problem: Problem, h: Hypothesis, start: Array) -> Array:
    """Start of an effect that continues another one (a thruster that is reversed and not only dead): as large as it is searched from, the other as the
    vehicle has it. Where tolerance has worn a thruster's gain down to nothing, nothing shows which way its shaft turns."""
    start = start.copy()
    for i, slot in enumerate(problem.plant.slots):
        if slot.hypothesis == f"{h.effect.continues}{h.of}":
            start[i] = problem.origin[i]
    for s in h.slots:
        start[s] = problem.plant.slots[s].parameter.starts[0]
    return start


def start_of(problem: Problem, data: NormalEquations, h: Hypothesis, steps: Array, beta: Array, free: tuple[int, ...]) -> Array:
    """Parameters from which a hypothesis is fitted by re-simulation: the linear answer, inside the bounds.

    Args:
        problem: what is fitted.
        data: the linearisation whose columns ``steps`` are of.
        h: the hypothesis, whose initial point comes before its step.
        steps: step of each column.
        beta: parameters that the linearisation was made at.
        free: slots that the fit moves; tolerances of sensors that are not among them stay in the tangent.
    """
    start = beta.copy()
    still = {s for s in tangent_slots(problem.plant, free) if s not in free}
    for slot, value in h.at:
        start[slot] = value
    moved, begins = {d.id: d.slot for d in h.displaced}, {d.slot for d in h.displaced} | {slot for slot, _ in h.at}
    for column, move in zip(data.columns, steps, strict=True):
        slot = moved.get(column, column)
        if move and 0 <= slot < len(start) and slot not in still and (column in moved or slot not in begins):
            parameter = problem.plant.slots[slot].parameter
            start[slot] = parameter.within(start[slot] + move)
    return start
