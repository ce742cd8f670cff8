"""Joint re-selection: each cause is weighed again beside the others that were found, against its candidates and against its absence.

A search that adds one cause after the other decides about the first without the second. Where two causes offset each other neither
closes the gap alone, and where the first was the nearest relative of two, another name is better once both are there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rovval.diagnose.criteria import (
    ALTERNATIVE_EVIDENCE,
    FIRST_GAIN,
    FURTHER_EVIDENCE_GAIN,
    FURTHER_GAIN,
    LEAST_EVIDENCE,
    MOST_ALTERNATIVES,
)
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, fit_hypothesis, fit_quickly
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.baseline import (
    Baseline,
    Candidate,
    SelectedCause,
    baseline_of,
    compared,
    healthy_baseline,
    reduction,
)
from rovval.diagnose.search.confusion import confusion_group


def sufficient(one: Candidate, alone: bool) -> bool:
    """Whether a candidate gains enough to be a cause: in the gap, in the parity residuals, or from its onset on, with enough evidence, or by restoring
    the tolerances of the file; ``alone``: there is no other cause."""
    gain = max(one.best_gain, one.parity_gain, one.gain_since)
    if one.contradicted:
        return False
    if one.restores:
        return True
    if alone:
        return gain >= FIRST_GAIN and one.evidence >= LEAST_EVIDENCE
    return gain >= FURTHER_GAIN and one.evidence * min(gain, 1.0) >= FURTHER_EVIDENCE_GAIN


def reselected(problem: Problem, causes: Sequence[SelectedCause], healthy: Posterior, seed: int) -> list[SelectedCause]:
    """The causes that are sufficient beside the others, under the names that fit best there; ``healthy`` is the fit without causes."""
    found = list(causes)
    for i in range(len(found) if len(found) > 1 else 0):
        found = _exchanged(problem, found, i, healthy, seed)
    while found:
        whole, alone = found[-1].fit, len(found) == 1
        without = [_without(problem, found, n, healthy) for n in found]
        added = [compared(problem, n.hypothesis, whole, baseline) for n, baseline in zip(found, without, strict=True)]
        found = [replace(n, evidence=one.evidence) for n, one in zip(found, added, strict=True)]
        if all(sufficient(one, alone) for one in added):
            break
        nothing = healthy_baseline(problem, healthy)
        seen = [one.parity_gain >= FIRST_GAIN and sufficient(one, alone) for one in added]  # by parity, to which no other cause is an alternative
        rests = [-np.inf if safe and not all(seen) else _merit(baseline, nothing) for baseline, safe in zip(without, seen, strict=True)]
        found = _removed(problem, found, found[int(np.argmax(rests))])
    return [_group_apart(n, {other.hypothesis.name for other in found if other is not n}) for n in found]


def joint_fit(problem: Problem, whole: HypothesisFit, kept: Sequence[Hypothesis], other: Candidate | None = None) -> HypothesisFit:
    """The causes ``kept`` fitted from where they are in ``whole``, with another one from where it was as a candidate."""
    start, slots = whole.posterior.beta.copy(), [s for h in kept for s in h.slots]
    gone = [s for s in whole.slots if s not in slots]
    start[gone] = problem.origin[gone]
    if other:
        new = list(other.hypothesis.slots)
        start[new], slots = other.fit.beta[new], [*slots, *new]
    return fit_quickly(problem, start, tuple(dict.fromkeys(slots)), whole.posterior.whitened)


def _without(problem: Problem, found: Sequence[SelectedCause], one: SelectedCause, healthy: Posterior) -> Baseline:
    """The baseline that the others are."""
    rest = [n for n in found if n is not one]
    if not rest:
        return healthy_baseline(problem, healthy)
    return baseline_of(joint_fit(problem, found[-1].fit, [n.hypothesis for n in rest]))


def _merit(rest: Baseline, nothing: Baseline) -> float:
    """Evidence of what is left without a cause over that of ``nothing`` at all, times its reduction of the gap."""
    gain, _ = reduction(nothing.losses, rest.losses)
    return (rest.evidence - nothing.evidence) * max(gain, 0.0)


def _exchanged(problem: Problem, found: list[SelectedCause], i: int, healthy: Posterior, seed: int) -> list[SelectedCause]:
    """The causes with the i-th under the name that fits best beside the others, and with the group that this log cannot tell from it there."""
    one, whole = found[i], found[-1].fit
    taken, rest = {n.hypothesis.name for n in found}, [n.hypothesis for n in found if n is not one]
    others = [c for c in one.candidates if c.hypothesis.name not in taken and c.evidence > ALTERNATIVE_EVIDENCE * one.candidates[0].evidence]
    others = others[:MOST_ALTERNATIVES]
    if not others:
        return found
    baseline = _without(problem, found, one, healthy)
    mine = compared(problem, one.hypothesis, whole, baseline)
    candidates = [mine, *(compared(problem, c.hypothesis, joint_fit(problem, whole, rest, c), baseline) for c in others)]
    candidates.sort(key=lambda c: -c.evidence)
    best = candidates[0] if candidates[0].evidence > mine.evidence + LEAST_EVIDENCE else mine
    group = tuple(sorted(confusion_group(problem, candidates, seed), key=lambda member: member[0] != best.hypothesis.name))
    better = replace(one, hypothesis=best.hypothesis, group=group, evidence=best.evidence)
    exchanged = [better if n is one else n for n in found]
    if best is mine:
        return exchanged
    return [*exchanged[:-1], replace(exchanged[-1], fit=fit_hypothesis(problem, best.fit.posterior.beta, best.fit.slots))]


def _group_apart(one: SelectedCause, others: set[str]) -> SelectedCause:
    """A cause whose group does not hold those that are there as well: they are no alternative to it."""
    kept = [(name, probability) for name, probability in one.group if name not in others]
    whole = sum(probability for _, probability in kept)
    return replace(one, group=tuple((name, probability / whole) for name, probability in kept)) if len(kept) < len(one.group) and whole > 0 else one


def _removed(problem: Problem, found: list[SelectedCause], weak: SelectedCause) -> list[SelectedCause]:
    """The causes without a weak one, fitted again."""
    rest = [n for n in found if n is not weak]
    if not rest:
        return []
    start = joint_fit(problem, found[-1].fit, [n.hypothesis for n in rest])
    return [*rest[:-1], replace(rest[-1], fit=fit_hypothesis(problem, start.posterior.beta, start.slots))]
