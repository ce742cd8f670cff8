"""What was found is weighed before it is named: a library effect is not named for being the least bad.

It is asked everything of `questions`: a true cause passes all, the nearest relative of an effect that the library lacks fails one of them. Then what the
causes leave: whether they hold still, whether kinematics alone show them, whether something remains.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from rovval.core.data import Array
from rovval.diagnose.criteria import FEW_WINDOWS
from rovval.diagnose.decision import questions
from rovval.diagnose.decision.benefit import acting, as_filed, beside_slop, checked, seen_by_checks
from rovval.diagnose.decision.constancy import drifting, wavering
from rovval.diagnose.decision.questions import WAVERS, Case, of_sensor
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.laplace import whole_evidence
from rovval.diagnose.inference.prior import STRAINED
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.discrepancy import Forces, forces
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.joint import LEAST_EVIDENCE

HOLDS = 0.02  # of what is left: a generic force that closes less on held-out windows is a fit to these windows (chosen)
REAL = 100.0  # twice the log Bayes factor of a generic force from which it is not a healthy vehicle's form (tuning set)
REMAINS = 0.10  # of a cause's evidence: less left over is form, not another cause


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
    case = _case(problem, selection, final, general, before)
    sensors = [of_sensor(n) for n in selection.named]
    return Weighed(
        total=case.total,
        instead=case.instead,
        beside=case.beside,
        strain=case.strain,
        skill=not case.many or case.faulty or any(way.skill for way in case.ways),
        parity_led=any(sensors) and seen_by_checks(problem, final),
        least_bad=any(question(case) for question in questions.ALL),
        remains=not case.ways[0].sure or case.strain > STRAINED or (case.holds and case.rest.evidence() > max(REAL, REMAINS * case.total)),
        unsteady=_unsteady(problem, selection, final, case.varies) if case.many else (),
        rest=case.rest,
    )


def _case(problem: Problem, selection: Selection, final: Confirmed, general: Forces, before: list[Array]) -> Case:
    """What speaks for the causes and against them."""
    total = whole_evidence(problem, final.point) - whole_evidence(problem, selection.healthy)
    filed = as_filed(problem, final, before)
    slop = [beside_slop(problem, final, selection.healthy, before)] if final.point.strain() <= STRAINED else []
    faulty = all(of_sensor(n) for n in selection.named) and checked(problem, final)
    varies = wavering(problem, final, selection.named) if problem.blocks >= FEW_WINDOWS else {}
    rest = forces(problem, final.point)
    holds = problem.blocks >= FEW_WINDOWS and rest.share(problem.folds) > HOLDS
    axes = acting(filed.closed)
    instead, beside = general.evidence(axes), rest.evidence(axes) if holds else 0.0
    return Case(problem, selection.named, final, total, general, rest, holds, axes, instead, beside, (filed, *slop), varies, faulty)


def _unsteady(problem: Problem, selection: Selection, final: Confirmed, varies: Mapping[str, float]) -> tuple[str, ...]:
    """Causes whose value varies more surely than `WAVERS` of their evidence, the worst first, and those that drift."""
    own = {n.hypothesis.name: max(WAVERS * n.evidence, LEAST_EVIDENCE) for n in selection.named}
    wavers = sorted((name for name, most in varies.items() if most > own[name]), key=lambda name: own[name] / varies[name])
    return tuple(dict.fromkeys((*wavers, *drifting(problem, final, selection.named))))
