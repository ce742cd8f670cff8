"""What stands before a cause is added, and what the cause closes of it: with every other coefficient as the file has it, and beside slop.

A vehicle that rolls freely answers to each of its coefficients. With those as filed, a true cause may even open the gap; once healthy
coefficients have settled, it closes what they leave, which the nearest relative of something else does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.bootstrap import interval
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.laplace import Point, whole_evidence
from rovval.diagnose.inference.map_fit import FEW, settle
from rovval.diagnose.inference.prior import STRAINED, WITHIN, Prior
from rovval.diagnose.inference.problem import Problem, gap_at
from rovval.diagnose.search.confusion import RELIEF, STRONG, Losses, Rival, closed

FEWEST = 6  # windows in which something acts, from which it is asked what it closes there (chosen: fewer may be any event)


@dataclass(frozen=True, slots=True)
class Ground:
    """Where slop settles beside what stands, the evidence of that, and its held-out losses with and without the kinematic checks."""

    point: Point
    evidence: float
    loss: Losses


def bare(problem: Problem, healthy: Point) -> Ground:
    """Nothing but healthy coefficients, which settle at ``healthy``."""
    return Ground(healthy, whole_evidence(problem, healthy), (problem.gap_data.c, problem.gap.c))


def with_causes(fitted: Confirmed) -> Ground:
    """What stands with the causes that were fitted."""
    return Ground(fitted.point, fitted.evidence, (fitted.loss, fitted.dynamic_loss))


def rival(problem: Problem, h: Hypothesis, fitted: Confirmed, ground: Ground) -> Rival:
    """What a hypothesis adds to what stands; beside slop where its evidence is strong."""
    evidence = fitted.evidence - ground.evidence
    gain, kinematic = closed(ground.loss, (fitted.loss, fitted.dynamic_loss))
    begun = _from_there_on(problem, h, fitted, ground) if evidence >= STRONG else 0.0
    beside = 0.0
    if evidence >= STRONG and gain < RELIEF:
        others = without_own(problem, ground.point, h.slots)
        beside = closed(_settled(problem, others), _settled(problem, fitted.point))[0]
    mends = evidence >= STRONG and gain > 0.0 and ground.point.strain() > STRAINED and fitted.point.strain() <= WITHIN
    return Rival(h, fitted, evidence, gain, kinematic, beside, mends, begun)


def _from_there_on(problem: Problem, h: Hypothesis, fitted: Confirmed, ground: Ground) -> float:
    """Share that what begins in mid-log closes of the windows in which it acts: those before say nothing of it. 0 for another hypothesis."""
    onset = [float(fitted.beta[s]) for s in h.slots if problem.plant.slots[s].parameter.role == "onset"]
    if not onset:
        return 0.0
    ends = np.concatenate([(part.start + part.steps) * part.run.dt for part in problem.parts])
    acts = np.flatnonzero(ends > onset[0])
    (was, moved), (left, still) = ground.loss, (fitted.loss, fitted.dynamic_loss)
    return closed((was[acts], moved[acts]), (left[acts], still[acts]))[0] if len(acts) >= FEWEST else 0.0


def without_own(problem: Problem, stands: Point, slots: Sequence[int]) -> Point:
    """What ``stands`` settled where the coefficients ``slots`` have no slop: the departure that a cause is, slop is not to imitate."""
    own = [s for s in slots if s in problem.slop.sd]
    if not own:
        return stands
    start = stands.beta.copy()
    start[own] = problem.origin[own]
    others = replace(problem, slop=Prior({s: sd for s, sd in problem.slop.sd.items() if s not in own}))
    return settle(others, start, stands.columns[: stands.own], stands.scaled, FEW)


def relief(problem: Problem, fitted: Confirmed, others: Point, seed: int) -> tuple[float, float, float]:
    """Share of the gap of the simulated motion, left where ``others``, the healthy coefficients that are not the causes', settle alone, that the
    causes close beside healthy coefficients: (value, low, high) of the 90 % block bootstrap over windows. All windows were fitted: a step of the
    causes that a fold would take goes with one of the coefficients, and evidence has paid for the causes' freedom."""
    return interval(_settled(problem, others)[1], _settled(problem, fitted.point)[1], seed)


def _settled(problem: Problem, point: Point) -> Losses:
    """Losses of every window where healthy coefficients stand as at ``point``."""
    dynamic, data = gap_at(problem, point.beta, ())
    return data.c, dynamic.c
