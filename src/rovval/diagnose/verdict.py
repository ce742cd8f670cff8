"""The verdict: explained, partly explained, unknown, or no gap. A library effect is not named for being the least bad.

Five questions are asked of what was found. Does it do better than a generic force on the axes where it acts? What would such a force
still gain beside it? How far must healthy coefficients leave their tolerance so that it fits? Does the simulator follow the vehicle
there at all? And does no axis get worse by much? A true cause passes all; the nearest relative of an effect that the library lacks
fails one of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from rovval import effects
from rovval.channels import AXES
from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, roughly
from rovval.diagnose.gap import axis_weight
from rovval.diagnose.point import Point, whole_evidence
from rovval.diagnose.problem import Problem, corrected_residuals
from rovval.diagnose.select import FALSE_ALARM, Named, Selection
from rovval.diagnose.separate import FEW, form_share
from rovval.diagnose.shrinkage import shrinkage
from rovval.diagnose.unknown import Forces, bare_forces, forces

BETTER = 0.9  # of a cause's evidence: a generic force that has more is as near to the truth (chosen)
ACTING = 0.15  # of what a cause closes: the axes on which it acts
HARMS = 0.25  # of what causes close in all: a cause that opens more on one axis is the least bad (chosen)
SKILL = 0.5  # of the squared motion: an axis on which more is left is not simulated at all (chosen)
REAL = 100.0  # twice the log Bayes factor of a generic force from which it is not a healthy vehicle's form (tuning set)
HOLDS = 0.02  # of what is left: a generic force that closes less on held-out windows is a fit to these windows (chosen)
REMAINS = 0.10  # of a cause's evidence: less left over is form, not another cause
WITHIN = 3.5  # standard deviations of tolerance that healthy coefficients reach (tuning set: 3.3 of some hundred)
STRAINED = 5.0  # standard deviations from which something is left beside a cause
BROKEN = 7.0  # standard deviations that say by themselves that something is at work: one of some hundred healthy logs of the tuning set reached 6


@dataclass(frozen=True, slots=True)
class Judgement:
    """``verdict`` of the contract; the causes that stand, their joint fit, groups and probabilities; the evidence of the causes, of a
    generic force instead of them and beside them; the largest strain on a healthy coefficient; what is left in words."""

    verdict: str
    named: tuple[Named, ...]
    final: Confirmed | None
    groups: Mapping[str, tuple[tuple[str, float], ...]]
    probability: Mapping[str, float]
    causes: float
    instead: float
    beside: float
    strain: float
    left: dict[str, object] | None


def judge(problem: Problem, selection: Selection, before: list[Array]) -> Judgement:
    """Weigh what was found against what could have been found; ``before`` are the nominal vehicle's residuals."""
    general = forces(problem, selection.healthy)
    weighed = _weighed(problem, selection, selection.final, general, before) if selection.final else None
    if selection.final and weighed and weighed.parity_led and weighed.least_bad:
        selection = _sensors_alone(problem, selection, selection.final)
        weighed = replace(weighed, remains=True)
    if selection.final and weighed and (weighed.parity_led or not weighed.least_bad):
        left = _left(problem, weighed.rest, selection.final.point) if weighed.remains else None
        groups = {n.hypothesis.name: n.group for n in selection.named}
        probability = {n.hypothesis.name: _probability(n) for n in selection.named}
        verdict = "partly_explained" if weighed.remains else "explained"
        figures = weighed.total, weighed.instead, weighed.beside, weighed.strain
        return Judgement(verdict, selection.named, selection.final, groups, probability, *figures, left)
    total, skill = (weighed.total, weighed.skill) if weighed else (0.0, True)
    anything, strain = general.evidence(), _strain(selection.healthy)
    tried = max((worth if gain > 0 else worth / 3 for _, worth, gain in selection.rounds[0]), default=0.0) if selection.rounds else 0.0
    real = (max(total, tried) > REAL and skill) or (anything > REAL and general.share(problem.folds) > HOLDS) or strain > BROKEN
    left = _left(problem, bare_forces(problem), selection.healthy) if real else None
    return Judgement("unknown" if real else "no_gap", (), None, {}, {}, total, anything, anything, strain, left)


@dataclass(frozen=True, slots=True)
class _Weighed:
    """What causes were asked: their evidence, that of generic forces instead and beside them, the strain, whether the simulator follows the
    vehicle; whether kinematics carry most of the gap, whether they are only the least bad, and whether something remains."""

    total: float
    instead: float
    beside: float
    strain: float
    skill: bool
    parity_led: bool
    least_bad: bool
    remains: bool
    rest: Forces


def _weighed(problem: Problem, selection: Selection, final: Confirmed, general: Forces, before: list[Array]) -> _Weighed:
    rest, total = forces(problem, final.point), whole_evidence(problem, final.point) - whole_evidence(problem, selection.healthy)
    after, many = corrected_residuals(problem, final.beta), problem.blocks >= FEW
    was, now = axis_weight(problem, before), axis_weight(problem, after)
    closed = {axis: max(was[axis] - now[axis], 0.0) for axis in was}  # of the weighted gap
    harmful = max(now[axis] - was[axis] for axis in was) > HARMS * (sum(was.values()) - sum(now.values()))
    axes = _acting(closed)
    holds = many and rest.share(problem.folds) > HOLDS
    beside, instead = rest.evidence(axes) if holds else 0.0, general.evidence(axes)
    excess, strain = _excess(problem, final.point, axes), _strain(final.point)
    sensors = all(_of_sensor(n) for n in selection.named)  # a force imitates a bias of the sensor that shows what it does
    skill = not many or sensors or _skill(problem, closed, now)
    outdone = many and not sensors and instead > BETTER * total
    broken = not skill or strain > BROKEN or harmful
    least_bad = outdone or broken or max(beside, excess) > form_share(problem.blocks) * total
    kinematic = float((problem.gap_data.c - problem.gap.c).sum()) > float(problem.gap.c.sum())
    parity_led = kinematic and any(_of_sensor(n) for n in selection.named)
    sure = _shrinks(problem, final, before, axes) and strain <= STRAINED
    remains = not sure or (holds and rest.evidence() > max(REAL, REMAINS * total))
    return _Weighed(total, instead, beside, strain, skill, parity_led, least_bad, remains, rest)


def _sensors_alone(problem: Problem, selection: Selection, final: Confirmed) -> Selection:
    """Where kinematics carry most of the gap they vouch for faults of sensors, not for what else was found beside them."""
    kept = tuple(n for n in selection.named if _of_sensor(n))
    if not kept or len(kept) == len(selection.named):
        return selection
    slots = tuple(s for n in kept for s in n.hypothesis.slots)
    start = problem.origin.copy()
    start[list(slots)] = final.beta[list(slots)]
    return replace(selection, named=kept, final=roughly(problem, start, slots, final.point.linear))


def _shrinks(problem: Problem, final: Confirmed, before: list[Array], axes: tuple[str, ...]) -> bool:
    """Whether the gap surely shrinks on held-out windows, in all or on an axis where the causes act."""
    shrunk = shrinkage(problem, final, before, 0)
    return shrunk["low"] > 0 or any(shrunk["axes_interval"][axis]["low"] > 0 for axis in axes if axis in shrunk["axes_interval"])


def _acting(closed: Mapping[str, float]) -> tuple[str, ...]:
    """Axes on which the causes close a good part of what they close."""
    return tuple(axis for axis in AXES if closed.get(axis, 0.0) > ACTING * max(sum(closed.values()), 1e-300))


def _of_sensor(named: Named) -> bool:
    return effects.load(named.hypothesis.name.partition("[")[0]).place == "sensor"


def _skill(problem: Problem, closed: Mapping[str, float], left: Mapping[str, float]) -> bool:
    """Whether on the axis where they close most the simulator, causes added, errs well less than the vehicle moves. Where it does not, it
    replays an autopilot's answers to disturbances that nobody logged, which shows nothing about the vehicle."""
    axis = max(closed, key=lambda a: closed[a])
    moved = [np.where(part.ok, part.y - (part.y * part.ok).sum((0, 1)) / np.maximum(part.ok.sum((0, 1)), 1), 0.0) for part in problem.parts]
    return left[axis] <= SKILL * axis_weight(problem, moved)[axis]


def _strain(point: Point) -> float:
    """Standard deviations by which the most strained healthy coefficient is off."""
    return float(np.abs(point.sigmas()).max(initial=0.0))


def _excess(problem: Problem, point: Point, axes: tuple[str, ...]) -> float:
    """What coefficients beyond tolerance cost, in twice the log of their prior, each as far as it moves the motion on ``axes``."""
    moves = np.zeros((2, len(point.columns)))
    for part, one in zip(problem.parts, point.linear, strict=True):
        by_channel = np.einsum("wtck,tc->ck", np.where(part.ok[..., None], one.S, 0.0) ** 2, 1.0 / problem.white)
        here = np.array([axis in axes for axis in part.axes], dtype=bool)
        moves += by_channel[here].sum(axis=0), by_channel.sum(axis=0)
    share = moves[0] / np.maximum(moves[1], 1e-300)
    return float((np.maximum(point.sigmas() ** 2 - WITHIN**2, 0.0) * share[point.own :]).sum())


def _left(problem: Problem, left: Forces, point: Point) -> dict[str, object]:
    """On which axes a generic force would close most of what is left, with what it varies, and which coefficient is strained."""
    by_axis = sorted(((axis, left.evidence([axis])) for axis in AXES), key=lambda item: -item[1])
    axes = [axis for axis, gain in by_axis if gain > 0.3 * by_axis[0][1]][:3] or [by_axis[0][0]]
    by_feature = sorted(((f, left.evidence([axes[0]], f)) for f in left.features), key=lambda item: -item[1])
    depends = [f for f, gain in by_feature if gain > 0.5 * by_feature[0][1] and gain > 0][:4]
    share = left.share(problem.folds)
    text = f"a systematic force on {', '.join(axes)}"
    text += f" that varies with {', '.join(depends)}" if depends else ""
    text += f" would close {100 * share:.0f} % of it" if share >= 0.005 else " is at work"
    text += "; no effect of the library is shown to be it"
    strained = [(problem.plant.slots[c].key, z) for c, z in zip(point.columns[point.own :], point.sigmas(), strict=True) if abs(z) > STRAINED]
    if strained:
        name, z = max(strained, key=lambda item: abs(item[1]))
        text += f"; nearest is {name}, which would have to be {abs(z):.0f} times its tolerance off"
    return {"axes": axes, "depends_on": depends, "share": share, "text": text}


def _probability(named: Named) -> float:
    """Share of belief that the named effect has in its group, less the chance that detection itself was false."""
    return float(named.group[0][1] * (1.0 - min(named.p_value, FALSE_ALARM)))
