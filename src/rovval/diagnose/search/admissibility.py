"""Which finalists could be the cause, and which of those to name first."""

from __future__ import annotations

from rovval import effects
from rovval.diagnose.inference.hypothesis_fit import places, significance
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.confusion import PER_PARAMETER, Rival, alike, denied, form_share

LEAST_SIGMA = 2.2  # standard errors, slop included, by which an effect departs from nothing (tuning set: healthy logs reach 2.0)
TOLERANCES = 3.0  # times the tolerance of calibration slop within which a coefficient is not worth a name
LOSSES = 1.5  # the same for a loss of thrust that comes and goes
SERIOUS = 0.5  # share of the best evidence from which a rival's gain counts
NEARLY = 0.9  # of the best's gain
LEAST_OF_BEST = 0.5  # of the gain of the best serious rival
CLEARLY = 20.0  # evidence of a loss with an onset over that of the same without (opened logs: false < 0, true 69 and more)


def admissible(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Of the `possible` those that could be the cause by themselves: they close on held-out windows at least half of what the best of the
    serious rivals closes."""
    rivals = _in_form(problem, weighed)
    if not rivals:
        return []
    serious = max(r.closes for r in rivals if r.evidence >= SERIOUS * rivals[0].evidence)
    return [r for r in possible(problem, weighed) if r.closes >= LEAST_OF_BEST * serious and r.closes > 0]


def possible(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Finalists whose size is beyond what slop of all other coefficients could feign and within what the library knows, best evidence first."""
    rivals = [r for r in _in_form(problem, weighed) if not _beyond_the_library(problem, r) and not denied(r)]
    return [r for r in rivals if significance(problem, r.fitted, r.hypothesis.slots) >= LEAST_SIGMA and _beyond_tolerance(problem, r)]


def simplest(problem: Problem, rivals: list[Rival]) -> Rival:
    """Of the rivals that the form of an equation may set apart, the one with the fewest parameters, if it closes nearly as much as the best;
    one that rests on a bound of its search comes last."""
    most, least = _parameters(problem, rivals[0]), (1.0 - form_share(problem.blocks)) * rivals[0].evidence
    tied = [
        r for r in rivals if not _began(rivals[0], r)
        if r is rivals[0]
        or alike(problem, r, rivals[0])
        or (r.evidence >= least and r.closes >= (NEARLY - PER_PARAMETER * max(most - _parameters(problem, r), 0)) * rivals[0].closes)
    ]  # fmt: skip
    return min(tied, key=lambda r: (_beyond_the_library(problem, r), _parameters(problem, r), -r.evidence))


def _began(best: Rival, other: Rival) -> bool:
    """Whether the best is the other but for an onset: no form of an equation lies between them, and evidence decides."""
    always = best.hypothesis.effect.onset_of
    return bool(always) and other.hypothesis.name == f"{always}{best.hypothesis.of}" and best.evidence > other.evidence + CLEARLY


def _parameters(problem: Problem, rival: Rival) -> int:
    """Parameters of a rival but for those that only refine it."""
    named = [problem.plant.slots[s] for s in rival.hypothesis.slots]
    return sum(slot.parameter.name not in effects.load(slot.effect).refines for slot in named)


def _in_form(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Finalists that are what their name says, where the best has evidence at all: a thruster counts as reversed only where it pushes the
    other way (up to half-reversed it is a degraded one), and what begins before the log does has no onset in it."""
    rivals = [r for r in weighed if _genuine(problem, r) and not _from_the_start(problem, r)]
    return rivals if rivals and rivals[0].evidence > 0 else []


def _beyond_tolerance(problem: Problem, rival: Rival) -> bool:
    """Whether some parameter that healthy vehicles and sensors vary in is further off than they are; True where none has a tolerance.

    A loss of thrust that begins, or that a stream causes, is held against what thrust may be off by all the time.
    """
    beta, origin, slots = rival.fitted.beta, problem.origin, problem.plant.slots
    tolerance = {s: TOLERANCES * problem.slop.sd[s] for s in rival.hypothesis.slots if s in problem.slop.sd}
    likened = {s: slots[s].parameter.compared_with for s in rival.hypothesis.slots if s not in tolerance and slots[s].parameter.compared_with}
    widest = {name: max((sd for s, sd in problem.slop.sd.items() if slots[s].effect == name), default=0.0) for name in likened.values()}
    tolerance |= {s: LOSSES * widest[name] for s, name in likened.items()}
    return not tolerance or any(abs(beta[s] - origin[s]) >= limit for s, limit in tolerance.items())


def _beyond_the_library(problem: Problem, rival: Rival) -> bool:
    """Whether a size rests at a bound of its search: the fit would go on, to where no vehicle is. A coefficient may well vanish, thrust too, and what a
    log does not show rests where nothing is at work."""
    slots = {s: problem.plant.slots[s].parameter for s in rival.hypothesis.slots if not places(problem, s)}
    sized = [(slots[s], float(rival.fitted.beta[s])) for s in rival.fitted.at_bound if s in slots and slots[s].role != "lever"]
    return any(x != p.null and not (p.vanishes_at == "low" and x <= p.low) and not (p.vanishes_at == "high" and x >= p.high) for p, x in sized)


def _from_the_start(problem: Problem, rival: Rival) -> bool:
    first = min(float(part.start[0] + part.steps) * part.run.dt for part in problem.parts)
    slots = problem.plant.slots
    return any(slots[s].parameter.role == "onset" and rival.fitted.beta[s] < first for s in rival.hypothesis.slots)


def _genuine(problem: Problem, rival: Rival) -> bool:
    """Whether it is large enough to be what its name says."""
    least = {s: problem.plant.slots[s].parameter.genuine_from for s in rival.hypothesis.slots}
    return not any(value is not None and rival.fitted.beta[s] < value for s, value in least.items())
