"""Joint reconsideration: each cause of a set is weighed against its absence and against the names that came nearest to it, beside the other causes.

A search that adds one cause after the other decides about the first without the second. Where two causes offset each other neither explains the
logs alone, and where the first was the nearest relative of two, another name is better once both are there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import log

from rovval.diagnose.effort import MOST_ALTERNATIVES, NEGLIGIBLE
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, fit_hypothesis, fit_quickly, only_places
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.baseline import Candidate
from rovval.diagnose.search.model import Model, ModelPrior, best_of_each_set


def reconsidered(problem: Problem, prior: ModelPrior, best: Model, tried: Sequence[Sequence[Candidate]], known: set[frozenset[str]]) -> list[Model]:
    """Models of the set ``best`` without each of its causes, and with each exchanged for the candidates that came nearest to it.

    Args:
        problem: what they are fitted to.
        prior: prior mass of sets of causes.
        best: a model of two causes or more, its fit with sensitivities.
        tried: candidates of each step of the search, best evidence first; a cause is exchanged for those of the step in which it was found.
        known: names of the sets that were fitted already.
    """
    assert best.fit is not None
    found = list[Model]()
    for cause in best.causes:
        rest = [h for h in best.causes if h is not cause]
        step = next((one for one in tried if cause.name in {c.hypothesis.name for c in one}), ())
        others = [c for c in step if c.hypothesis.name not in best.names][:MOST_ALTERNATIVES]
        without = joint_fit(problem, best.fit, rest)
        for other in (None, *others):
            causes = (*rest, other.hypothesis) if other else tuple(rest)
            if frozenset(h.name for h in causes) not in known:
                fit = (_exchanged(problem, best.fit, rest, other, without) if other else without).without_sensitivities()
                found.append(Model(causes, fit, fit.evidence, prior.log_mass(causes)))
                known.add(found[-1].names)
    return found


def _exchanged(problem: Problem, whole: HypothesisFit, rest: Sequence[Hypothesis], other: Candidate, without: HypothesisFit) -> HypothesisFit:
    """The fit of ``rest`` and another cause; of one that ends worse than ``without`` that cause, again from there, with no more of it than its place."""
    fit = joint_fit(problem, whole, rest, other)
    if fit.posterior.predicted_cost() <= without.posterior.predicted_cost():
        return fit
    start, placed = without.posterior.beta.copy(), [s for s in other.hypothesis.slots if only_places(problem, s)]
    start[placed] = other.fit.beta[placed]
    again = fit_quickly(problem, start, fit.slots, without.posterior.whitened)
    return max(fit, again, key=lambda one: one.evidence)


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


def joint_fit(problem: Problem, whole: HypothesisFit, kept: Sequence[Hypothesis], other: Candidate | None = None) -> HypothesisFit:
    """The causes ``kept`` fitted from where they are in ``whole``, with another one from where it was as a candidate."""
    start, slots = whole.posterior.beta.copy(), [s for h in kept for s in h.slots]
    gone = [s for s in whole.slots if s not in slots]
    start[gone] = problem.origin[gone]
    if other:
        new = list(other.hypothesis.slots)
        start[new], slots = other.fit.beta[new], [*slots, *new]
    return fit_quickly(problem, start, tuple(dict.fromkeys(slots)), whole.posterior.whitened)
