"""Joint reconsideration: each cause of a set is weighed against its absence, and against other names in its place, beside the other causes.

A search that adds one cause after the other decides about the first without the second. Where two causes offset each other neither explains the
logs alone, and where the first was the nearest relative of two, another name is better once both are there. So a set is a step of the search back, too
(floating search: Pudil, Novovicova and Kittler 1994): each cause is taken out and what could stand in for it is fitted, which shows what the log does not
tell from it.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import replace
from math import log

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.effort import MOST_RELATIVES, NEGLIGIBLE
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, prior_of
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, fit_hypothesis, fit_quickly
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.normal_equations import NormalEquations
from rovval.diagnose.residuals.ridge import ridge_step
from rovval.diagnose.search.candidates import start_of
from rovval.diagnose.search.model import Model, ModelPrior, Names, best_of_each_set
from rovval.diagnose.search.screening import linearised, screened


def without_each(problem: Problem, prior: ModelPrior, whole: Model, known: Set[Names] = frozenset()) -> list[Model]:
    """Models of a set of causes, its fit with sensitivities, without each of them, fitted from where the others are beside it (`some_of`): a set that was
    fitted before may have ended in another minimum. Sets that are ``known`` are left out."""
    assert whole.fit is not None
    fewer = [tuple(h for h in whole.causes if h is not cause) for cause in whole.causes]
    return [some_of(problem, prior, whole.fit, causes) for causes in fewer if causes and frozenset(h.name for h in causes) not in known]


def with_relatives(
    problem: Problem, prior: ModelPrior, library: Sequence[Hypothesis], whole: Model, known: set[Names], near: NormalEquations | None = None
) -> list[Model]:
    """Models of a set of causes with each of them exchanged for the hypotheses of the library that would stand in for it, whether or not the search met them.

    About the fit of the set each cause is taken out in turn, with its response in the linearised model, and every hypothesis is screened in its place; those
    that promise most (`MOST_RELATIVES`) are fitted by re-simulation. Of a single cause every exchange was a candidate of the first step, and causes that begin
    in mid-log were exchanged in their part: of these there are none.

    Args:
        problem: what they are fitted to.
        prior: prior mass of sets of causes.
        library: hypotheses to choose from.
        whole: the set, its fit with sensitivities.
        known: names of the sets that were fitted already; those that are fitted here are added to it.
        near: the library linearised near by, which is made anew where that does not hold.
    """
    if whole.fit is None or whole.part or len(whole.causes) < 2:
        return []
    fit, found = whole.fit, list[Model]()
    data, others = linearised(problem, library, fit.posterior, near), [h for h in library if h.name not in whole.names]
    for cause in whole.causes:
        rest = [h for h in whole.causes if h is not cause]
        kept = tuple(dict.fromkeys(s for h in rest for s in h.slots))
        gone = [s for s in cause.slots if s not in kept]
        start, without = fit.posterior.beta.copy(), _taken_out(problem, data, fit.posterior.beta, gone)
        start[gone] = problem.origin[gone]
        promised, beside = screened(problem, without, others, kept), problem.tolerance.plus(wide_sd(problem.plant, kept))
        nearest = dict[str, Hypothesis]()
        for h in sorted(others, key=lambda h: -promised[h.label]):
            if not any(h.is_one_with(one) for one in rest):
                nearest.setdefault(h.name, h)
        for h in list(nearest.values())[:MOST_RELATIVES]:
            if (names := frozenset({h.name, *(one.name for one in rest)})) not in known:
                slots = tuple(dict.fromkeys((*kept, *h.slots)))
                steps = ridge_step(without, beside.plus(prior_of(problem, h).sd), problem.tempering)
                own = fit_quickly(problem, start_of(problem, without, h, steps, start, slots), slots, fit.posterior.whitened).without_sensitivities()
                found.append(Model((*rest, h), own, own.evidence, prior.log_mass((*rest, h))))
                known.add(names)
    return found


def _taken_out(problem: Problem, data: NormalEquations, beta: Array, gone: Sequence[int]) -> NormalEquations:
    """Normal equations about ``beta`` as they are, in the linearised model, where the slots ``gone`` are as the vehicle's file has them."""
    places, offset = data.place(tuple(gone)), np.zeros(len(data.columns)) if data.offset is None else data.offset.copy()
    offset[places] = 0.0
    return replace(data, b=data.b + data.A[:, :, places] @ (beta[list(gone)] - problem.origin[list(gone)]), offset=offset)


def settled(problem: Problem, models: Sequence[Model], count: int) -> list[Model]:
    """The models, the ``count`` most probable sets of which are fitted with care, and have sensitivities; sets of no probability beside the best
    (`NEGLIGIBLE`) are left as they are."""
    found = list(models)
    while True:
        top = max(m.log_posterior for m in found)
        sets = best_of_each_set(m for m in found if m.fit).values()
        leading = [m for m in sorted(sets, key=lambda m: -m.log_posterior)[:count] if m.log_posterior > top + log(NEGLIGIBLE)]
        there = {id(m) for m in leading}
        again = [refitted(problem, m) if id(m) in there else m for m in found]
        if all(new is old for new, old in zip(again, found, strict=True)):
            return [m if id(m) in there else m.without_sensitivities() for m in found]
        found = again


def refitted(problem: Problem, model: Model) -> Model:
    """The model fitted with care, with its sensitivities; one that begins in mid-log has those of its part."""
    assert model.fit is not None
    if model.part or (model.careful and model.fit.posterior.whitened):
        return model
    fit = fit_hypothesis(problem, model.fit.posterior.beta, model.fit.slots)
    return replace(model, fit=fit, evidence=fit.evidence, careful=True)


def some_of(problem: Problem, prior: ModelPrior, whole: HypothesisFit, causes: tuple[Hypothesis, ...]) -> Model:
    """The model of some of the causes of the fit ``whole``, fitted from where they are in it."""
    start, slots = whole.posterior.beta.copy(), tuple(dict.fromkeys(s for h in causes for s in h.slots))
    gone = [s for s in whole.slots if s not in slots]
    start[gone] = problem.origin[gone]
    fit = fit_quickly(problem, start, slots, whole.posterior.whitened).without_sensitivities()
    return Model(causes, fit, fit.evidence, prior.log_mass(causes))
