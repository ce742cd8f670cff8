"""What causes are asked before they are named, one function a question: yes to any, and they are only the least bad.

Thresholds were set on opened sets of the blind plant where their line says so, and are chosen where it does not.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.diagnose.criteria import FEW_WINDOWS
from rovval.diagnose.decision.benefit import Way, stand
from rovval.diagnose.decision.consistency import contradicted
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.prior import WITHIN
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.confusion import form_share
from rovval.diagnose.search.discrepancy import Forces
from rovval.diagnose.search.forward import MOST
from rovval.diagnose.search.joint import LEAST_EVIDENCE, Named

BETTER = 1.0  # of a cause's evidence: a generic force that has more is nearer to the truth (chosen)
FORCES, AS_NEAR = 4, 0.9  # what so few single ones gain in its place and not beside it (opened sets: right 0.77 at most, a test's weak current 0.9; wrong 0.88)
FORMLESS = 20.0  # twice the log Bayes factor of what is beside a cause, from which it is more than the form of an equation (chosen)
LONE, LEFT = 75.0, 0.15  # the same of a single force beside, and its share of a cause's evidence (opened sets: the 5 beyond both were wrong; a right one 61)
BROKEN = 7.0  # standard deviations that say by themselves that something is at work: one of some hundred healthy logs of the tuning set reached 6
BENT, OUTWEIGHS = 6.0, 5.0  # the same of causes with less evidence than so much of what the strain costs by its prior (opened sets: 3.9, 4.6; true 15)
WAVERS = 0.5  # of a cause's evidence: one whose value varies more surely than that is not it (opened sets: true ones 0.40 at most)


@dataclass(frozen=True, slots=True)
class Case:
    """Causes and what speaks for and against them: their joint fit ``final`` and its evidence ``total``, the generic forces on the healthy
    vehicle and those beside the causes (``holds``: on windows that they were not fitted on, too), the ``axes`` where they
    act, evidence of generic forces there ``instead`` of and ``beside`` them, the ways in which they show what they do (`shown`; the
    first: as filed), the evidence that each one's value varies. ``faulty``: they are faults of sensors that the kinematic checks see, which a force
    imitates."""

    problem: Problem
    named: tuple[Named, ...]
    final: Confirmed
    total: float
    general: Forces
    rest: Forces
    holds: bool
    axes: tuple[str, ...]
    instead: float
    beside: float
    ways: tuple[Way, ...]
    varies: Mapping[str, float]
    faulty: bool

    @property
    def many(self) -> bool:
        """Whether there are windows enough to weigh evidence."""
        return self.problem.blocks >= FEW_WINDOWS

    @property
    def closed(self) -> dict[str, float]:
        """What the causes close on each axis."""
        return self.ways[0].closed

    @property
    def strain(self) -> float:
        """How far the most strained healthy coefficient leaves its tolerance beside them."""
        return self.final.point.strain()

    @property
    def of_best(self) -> float:
        """Their evidence under the best names of their groups: a simpler name that this log does not tell from it gave some of it up."""
        return self.total + sum(_given_up(n) for n in self.named)


def outdone(case: Case) -> bool:
    """Do generic forces do better in their place, all of them or a few single ones?"""
    if not case.many or case.faulty:
        return False
    few = case.general.alone(case.axes, FORCES, case.final.slots) - case.rest.alone(case.axes, FORCES)
    return case.instead > BETTER * case.of_best or few > AS_NEAR * case.of_best


def unshown(case: Case) -> bool:
    """Do they fail to show what they do: close nothing surely, harm an axis, act where the simulator does not follow the vehicle?"""
    own = [n.hypothesis.name.partition("[")[2].rstrip("]") for n in case.named if n.hypothesis.effect.per == "axis"]
    return not stand(case.ways, case.faulty or not case.many, own)


def bent(case: Case) -> bool:
    """Must healthy coefficients leave their tolerance so that they fit?"""
    return case.strain > BROKEN or (case.strain > BENT and case.total < OUTWEIGHS * case.strain**2)


def wavering(case: Case) -> bool:
    """Does the value of one vary more surely than they are there?"""
    return max(case.varies.values(), default=0.0) > max(WAVERS * case.total, LEAST_EVIDENCE)


def accompanied(case: Case) -> bool:
    """Is a single generic force left beside them that is as sure as a cause?"""
    if not case.many or case.faulty or any(way.all_of_it for way in case.ways):
        return False
    return case.rest.alone(case.axes) > max(LONE, LEFT * case.total)


def crowded(case: Case) -> bool:
    """Are there `MOST` of one kind, all of axes or all of thrusters: a file that is off in so many coefficients is miscalibrated (which is
    asked where nothing is named), or they make up what its equations lack? Opened sets: none of 5 such answers was right."""
    return crowd(case.named)


def crowd(named: Sequence[Named]) -> bool:
    """Whether there are `MOST` causes of one kind."""
    return len(named) == MOST and len({n.hypothesis.effect.per for n in named}) == 1 and named[0].hypothesis.effect.per != ""


def of_a_log_at_odds(case: Case) -> bool:
    """Does the log contradict itself where causes that are no sensor's close most?"""
    most = max(case.closed.items(), key=lambda item: item[1])
    return not all(of_sensor(n) for n in case.named) and bool(contradicted(case.problem, dict([most])))


def incomplete(case: Case) -> bool:
    """Would a generic force still gain, or do healthy coefficients bend, more than the form of an equation may cost?"""
    return max(case.beside, _excess(case.problem, case.final.point, case.axes)) > max(form_share(case.problem.blocks) * case.total, FORMLESS)


ALL = (outdone, unshown, bent, wavering, accompanied, crowded, of_a_log_at_odds, incomplete)


def of_sensor(named: Named) -> bool:
    """Whether a cause is a fault of a sensor."""
    return named.hypothesis.effect.place == "sensor"


def _given_up(named: Named) -> float:
    """Evidence of the best of a cause's group over its own, as they were weighed against each other."""
    group = {name for name, _ in named.group}
    worth = {r.hypothesis.name: r.evidence for r in named.rivals if r.hypothesis.name in group}
    return max(worth.values()) - worth[named.hypothesis.name] if named.hypothesis.name in worth else 0.0


def _excess(problem: Problem, point: Point, axes: tuple[str, ...]) -> float:
    """What coefficients beyond tolerance cost, in twice the log of their prior, each as far as it moves the motion on ``axes``."""
    moves = np.zeros((2, len(point.columns)))
    for part, one in zip(problem.parts, point.linear, strict=True):
        by_channel = np.einsum("wtck,tc->ck", np.where(part.ok[..., None], one.S, 0.0) ** 2, 1.0 / problem.white)
        here = np.array([axis in axes for axis in part.axes], dtype=bool)
        moves += by_channel[here].sum(axis=0), by_channel.sum(axis=0)
    share = moves[0] / np.maximum(moves[1], 1e-300)
    return float((np.maximum(point.sigmas() ** 2 - WITHIN**2, 0.0) * share[point.own :]).sum())
