"""Plausibility: whether a fitted hypothesis is what its name says."""

from __future__ import annotations

from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.baseline import Candidate


def plausible(problem: Problem, one: Candidate) -> bool:
    """Whether a candidate is what its name says: a thruster counts as reversed only where it pushes the other way and is nearer to that than to a dead one,
    which is degraded; and what begins before the log does has no onset in it, unless it goes on as it began."""
    first = min(float(part.start[0] + part.steps) * part.run.dt for part in problem.runs)
    named = [(problem.plant.slots[s].parameter, float(one.fit.beta[s])) for s in one.hypothesis.slots]
    genuine = all(p.genuine_from is None or value >= p.genuine_from for p, value in named)
    return genuine and (one.hypothesis.effect.lasts or not any(p.role == "onset" and value < first for p, value in named))
