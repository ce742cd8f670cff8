"""Admissibility: which candidates could be the cause, and which of those is named first."""

from __future__ import annotations

from rovval import effects
from rovval.diagnose.criteria import (
    ADMISSIBLE_GAIN,
    ADMISSIBLE_LOSS,
    ADMISSIBLE_SIGMA,
    ADMISSIBLE_TOLERANCES,
    EVIDENCE_PER_PARAMETER,
    ONSET_CLEAR,
    SERIOUS_EVIDENCE,
    SIMPLER_GAIN,
)
from rovval.diagnose.inference.hypothesis_fit import only_places, significance
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.baseline import Candidate
from rovval.diagnose.search.confusion import form_share, gains_alike


def admissible(problem: Problem, candidates: list[Candidate]) -> list[Candidate]:
    """Of the `possible` those that could be the cause by themselves: they reduce the gap at least half as much as the best of those with serious
    evidence."""
    meant = _as_named(problem, candidates)
    if not meant:
        return []
    serious = max(c.best_gain for c in meant if c.evidence >= SERIOUS_EVIDENCE * meant[0].evidence)
    return [c for c in possible(problem, candidates) if c.best_gain >= ADMISSIBLE_GAIN * serious and c.best_gain > 0]


def possible(problem: Problem, candidates: list[Candidate]) -> list[Candidate]:
    """Candidates whose size is beyond what tolerances of all other coefficients could feign and inside the bounds of the library, best evidence first."""
    within = [c for c in _as_named(problem, candidates) if not beyond_bounds(problem, c) and not c.contradicted]
    return [c for c in within if significance(problem, c.fit, c.hypothesis.slots) >= ADMISSIBLE_SIGMA and _beyond_tolerance(problem, c)]


def simplest(problem: Problem, candidates: list[Candidate]) -> Candidate:
    """Of the candidates that only model-form error may set apart, the one with the fewest parameters, if it reduces the gap nearly as much as the best;
    one that rests on a bound comes last."""
    best = candidates[0]
    most, least = _parameters(problem, best), (1.0 - form_share(problem.window_count)) * best.evidence
    tied = [
        c for c in candidates if not _is_onset_of(best, c)
        if c is best
        or gains_alike(problem, c, best)
        or (c.evidence >= least and c.best_gain >= (SIMPLER_GAIN - EVIDENCE_PER_PARAMETER * max(most - _parameters(problem, c), 0)) * best.best_gain)
    ]  # fmt: skip
    return min(tied, key=lambda c: (beyond_bounds(problem, c), _parameters(problem, c), -c.evidence))


def _is_onset_of(best: Candidate, other: Candidate) -> bool:
    """Whether the best is the other but for an onset: no model-form error lies between them, and evidence decides."""
    always = best.hypothesis.effect.onset_of
    return bool(always) and other.hypothesis.name == f"{always}{best.hypothesis.of}" and best.evidence > other.evidence + ONSET_CLEAR


def _parameters(problem: Problem, one: Candidate) -> int:
    """Parameters of a candidate but for those that only refine it."""
    named = [problem.plant.slots[s] for s in one.hypothesis.slots]
    return sum(slot.parameter.name not in effects.load(slot.effect).refines for slot in named)


def _as_named(problem: Problem, candidates: list[Candidate]) -> list[Candidate]:
    """Candidates that are what their name says, where the best has evidence at all: a thruster counts as reversed only where it pushes the
    other way (up to half-reversed it is a degraded one), and what begins before the log does has no onset in it."""
    meant = [c for c in candidates if _genuine(problem, c) and not _from_the_start(problem, c)]
    return meant if meant and meant[0].evidence > 0 else []


def _beyond_tolerance(problem: Problem, one: Candidate) -> bool:
    """Whether some parameter in which healthy vehicles and sensors vary is further off than they are; True where none has a tolerance.

    A loss of thrust that begins, or that a stream causes, is held against what thrust may be off by all the time.
    """
    beta, origin, slots = one.fit.beta, problem.origin, problem.plant.slots
    limits = {s: ADMISSIBLE_TOLERANCES * problem.tolerance.sd[s] for s in one.hypothesis.slots if s in problem.tolerance.sd}
    likened = {s: slots[s].parameter.compared_with for s in one.hypothesis.slots if s not in limits and slots[s].parameter.compared_with}
    widest = {name: max((sd for s, sd in problem.tolerance.sd.items() if slots[s].effect == name), default=0.0) for name in likened.values()}
    limits |= {s: ADMISSIBLE_LOSS * widest[name] for s, name in likened.items()}
    return not limits or any(abs(beta[s] - origin[s]) >= limit for s, limit in limits.items())


def beyond_bounds(problem: Problem, one: Candidate) -> bool:
    """Whether a size rests at a bound: the fit would go on, to where no vehicle is. A coefficient may well vanish, thrust too, and what a
    log does not show rests where nothing is at work."""
    slots = {s: problem.plant.slots[s].parameter for s in one.hypothesis.slots if not only_places(problem, s)}
    sized = [(slots[s], float(one.fit.beta[s])) for s in one.fit.at_bound if s in slots and slots[s].role != "lever"]
    return any(x != p.null and not (p.vanishes_at == "low" and x <= p.low) and not (p.vanishes_at == "high" and x >= p.high) for p, x in sized)


def _from_the_start(problem: Problem, one: Candidate) -> bool:
    first = min(float(part.start[0] + part.steps) * part.run.dt for part in problem.runs)
    slots = problem.plant.slots
    return any(slots[s].parameter.role == "onset" and one.fit.beta[s] < first for s in one.hypothesis.slots)


def _genuine(problem: Problem, one: Candidate) -> bool:
    """Whether it is large enough to be what its name says."""
    least = {s: problem.plant.slots[s].parameter.genuine_from for s in one.hypothesis.slots}
    return not any(value is not None and one.fit.beta[s] < value for s, value in least.items())
