"""Causes in each other's company: each is weighed again beside the others that were found, against its rivals and against its absence.

A search that adds one cause after the other decides about the first without the second. Where two causes offset each other neither
closes the gap alone, and where the first was the nearest relative of two, another name is better once both are there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import Confirmed, confirm, roughly
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.baseline import Ground, bare, rival, with_causes
from rovval.diagnose.search.confusion import Rival, closed, denied, group

LEAST_GAIN = 0.15  # of the gap, on held-out windows: less is not worth a name (opened sets: 0 of 8 below it were right)
LATER_GAIN = 0.18  # of what is left, the same for a second and third effect: the forms of equations leave structure (0 of 7 were right)
LEAST_EVIDENCE = 6.0  # over slop: "strong" (Kass & Raftery 1995); no healthy Merlin log of the tuning set got as far as finalists
LATER_WORTH = 8.0  # evidence times gain, the same for those: little evidence will do where much closes (opened sets: 1 of 9 below it was right)
RIVALS, SERIOUS = 2, 0.5  # of a cause that are weighed again, and the share of its evidence that makes one


@dataclass(frozen=True, slots=True)
class Named:
    """One effect that was found: its hypothesis, the group that this log cannot tell apart with probabilities (itself first), the joint
    fit after it was added, the detection that let it in, its evidence over what was there before, and those that it was chosen from."""

    hypothesis: Hypothesis
    group: tuple[tuple[str, float], ...]
    fitted: Confirmed
    p_value: float
    evidence: float
    rivals: tuple[Rival, ...]


def worthy(one: Rival, alone: bool) -> bool:
    """Whether a rival closes enough of the gap, of what kinematics show, or from where it begins on, with enough evidence, or mends the file;
    ``alone``: nothing was found before it."""
    gain = max(one.closes, one.kinematic, one.begun)
    if denied(one):
        return False
    if one.mends:
        return True
    if alone:
        return gain >= LEAST_GAIN and one.evidence >= LEAST_EVIDENCE
    return gain >= LATER_GAIN and one.evidence * min(gain, 1.0) >= LATER_WORTH


def together(problem: Problem, named: Sequence[Named], healthy: Point, seed: int) -> list[Named]:
    """The causes that are worth their names beside the others, under the names that fit best there; ``healthy`` is where slop settles alone."""
    found = list(named)
    for i in range(len(found) if len(found) > 1 else 0):
        found = _renamed(problem, found, i, healthy, seed)
    while found:
        whole, alone = found[-1].fitted, len(found) == 1
        without = [_without(problem, found, n, healthy) for n in found]
        added = [rival(problem, n.hypothesis, whole, ground) for n, ground in zip(found, without, strict=True)]
        found = [replace(n, evidence=one.evidence) for n, one in zip(found, added, strict=True)]
        if all(worthy(one, alone) for one in added):
            break
        nothing = bare(problem, healthy)
        seen = [one.kinematic >= LEAST_GAIN and worthy(one, alone) for one in added]  # by kinematics, to which no other cause is a rival
        stands = [-np.inf if safe and not all(seen) else _worth(problem, ground, nothing) for ground, safe in zip(without, seen, strict=True)]
        found = _dropped(problem, found, found[int(np.argmax(stands))])
    return [_apart(n, {other.hypothesis.name for other in found if other is not n}) for n in found]


def _without(problem: Problem, found: Sequence[Named], one: Named, healthy: Point) -> Ground:
    rest = [n for n in found if n is not one]
    if not rest:
        return bare(problem, healthy)
    return with_causes(jointly(problem, found[-1].fitted, [n.hypothesis for n in rest]))


def _worth(problem: Problem, ground: Ground, nothing: Ground) -> float:
    """Evidence of what stands without a cause, over that of ``nothing`` at all, times what it closes of the gap."""
    gain, _ = closed(nothing.loss, ground.loss)
    return (ground.evidence - nothing.evidence) * max(gain, 0.0)


def jointly(problem: Problem, whole: Confirmed, kept: Sequence[Hypothesis], other: Rival | None = None) -> Confirmed:
    """The causes ``kept`` from where they stand in ``whole``, with another one from where it stood when it was weighed."""
    start, slots = whole.point.beta.copy(), [s for h in kept for s in h.slots]
    gone = [s for s in whole.slots if s not in slots]
    start[gone] = problem.origin[gone]
    if other:
        new = list(other.hypothesis.slots)
        start[new], slots = other.fitted.beta[new], [*slots, *new]
    return roughly(problem, start, tuple(dict.fromkeys(slots)), whole.point.scaled)


def _renamed(problem: Problem, found: list[Named], i: int, healthy: Point, seed: int) -> list[Named]:
    """The causes with the i-th under the name that fits best beside the others, and those that are not told from it there."""
    one, whole = found[i], found[-1].fitted
    taken, rest = {n.hypothesis.name for n in found}, [n.hypothesis for n in found if n is not one]
    others = [r for r in one.rivals if r.hypothesis.name not in taken and r.evidence > SERIOUS * one.rivals[0].evidence][:RIVALS]
    if not others:
        return found
    ground = _without(problem, found, one, healthy)
    mine = rival(problem, one.hypothesis, whole, ground)
    rivals = [mine, *(rival(problem, r.hypothesis, jointly(problem, whole, rest, r), ground) for r in others)]
    rivals.sort(key=lambda r: -r.evidence)
    best = rivals[0] if rivals[0].evidence > mine.evidence + LEAST_EVIDENCE else mine
    members = tuple(sorted(group(problem, rivals, seed), key=lambda member: member[0] != best.hypothesis.name))
    better = replace(one, hypothesis=best.hypothesis, group=members, evidence=best.evidence)
    renamed = [better if n is one else n for n in found]
    if best is mine:
        return renamed
    return [*renamed[:-1], replace(renamed[-1], fitted=confirm(problem, best.fitted.point.beta, best.fitted.slots))]


def _apart(one: Named, others: set[str]) -> Named:
    """A cause whose group does not hold those that are there as well: they are no alternative to it."""
    kept = [(name, probability) for name, probability in one.group if name not in others]
    whole = sum(probability for _, probability in kept)
    return replace(one, group=tuple((name, probability / whole) for name, probability in kept)) if len(kept) < len(one.group) and whole > 0 else one


def _dropped(problem: Problem, found: list[Named], weak: Named) -> list[Named]:
    """The causes without a weak one, fitted again."""
    rest = [n for n in found if n is not weak]
    if not rest:
        return []
    start = jointly(problem, found[-1].fitted, [n.hypothesis for n in rest])
    return [*rest[:-1], replace(rest[-1], fitted=confirm(problem, start.point.beta, start.slots))]

