"""Which effects: forward selection with joint refit, each step detected on top of slop, named by held-out re-simulation.

A round (`round`) asks three questions. Is there anything beyond calibration slop (`detect`)? Which hypotheses, refitted by re-simulation, do best on
windows that they were not fitted on (`confirm`)? Which others does this log not tell from the best (`separate`)? It stops when a gain
is not real or too small to matter; an effect that later ones make needless is dropped again. In the end the causes are weighed beside each
other (`together`), and where one falls the search goes on without it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.hypotheses.library import retuned
from rovval.diagnose.inference.cross_validation import Ring, contest
from rovval.diagnose.inference.hypothesis_fit import Confirmed, confirm, roughly
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.map_fit import healthy_point, resettled
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.search.admissibility import simplest
from rovval.diagnose.search.candidates import prior_of
from rovval.diagnose.search.confusion import group
from rovval.diagnose.search.joint import Named, together
from rovval.diagnose.search.onset import Beginning
from rovval.diagnose.search.round import Round, search

MOST = 3  # effects at once
ROUNDS = 5  # of the search: an effect that later ones make needless leaves its place
NEEDLESS = 6.0  # twice the log Bayes factor below which an effect is dropped again (Kass & Raftery 1995: positive evidence)


@dataclass(frozen=True, slots=True)
class Selection:
    """Effects in the order found; the final joint fit (None: nothing found); where slop settles without any; every hypothesis's held-out share of the gap;
    of each round the finalists with their evidence and held-out gain; the p-value of the round that ended the search; from when on something
    seems to be at work that was not there before (`since`)."""

    named: tuple[Named, ...]
    final: Confirmed | None
    healthy: Point
    ranking: tuple[tuple[str, float], ...]
    rounds: tuple[tuple[tuple[str, float, float], ...], ...]
    last_p: float
    began: Beginning | None
    last_evidence: float
    null_evidence: float


def select(problem: Problem, library: list[Hypothesis], seed: int, progress: Callable[[str, float], None]) -> Selection:
    """Search for the effects that explain the gap; see the module."""
    healthy = healthy_point(problem)
    tuned = retuned(problem, library, healthy)
    named, spent = list[Named](), set[str]()
    rounds = list[Round]()
    for number in range(ROUNDS):
        progress(f"screening {len(tuned)} hypotheses, round {number + 1}", 0.3 + 0.1 * number)
        open_now = [h for h in tuned if h.name not in {n.hypothesis.name for n in named} | spent]
        rounds.append(search(problem, tuned, open_now, named, healthy, seed + number))
        if rounds[-1].able:
            named = _pruned(problem, [*named, _found(problem, rounds[-1], seed)])
            if len(named) < MOST:
                continue
        progress("weighing the causes beside each other", 0.35 + 0.1 * number)
        healthy = _fairer(problem, healthy, named)
        kept = together(problem, named, healthy, seed)
        spent |= {n.hypothesis.name for n in named} - {n.hypothesis.name for n in kept}
        settled, named = len(kept) in (0, MOST, len(named)), kept
        if settled:
            break
    else:
        healthy = _fairer(problem, healthy, named)
        named = together(problem, named, healthy, seed)
    final, tried = named[-1].fitted if named else None, tuple(r.told for r in rounds if r.told)
    last = rounds[-1].detection
    p, most, null = last.p_value(last.best), last.evidence[last.best], float(np.quantile(last.null, 0.95))
    return Selection(tuple(named), final, healthy, _ranking(problem, library, named, tried), tried, p, rounds[0].began, most, null)


def _fairer(problem: Problem, healthy: Point, named: list[Named]) -> Point:
    """The healthy vehicle, after another start beside the causes."""
    return resettled(problem, healthy, named[-1].fitted.point, named[-1].fitted.slots) if named else healthy


def _found(problem: Problem, one: Round, seed: int) -> Named:
    """The best of those that may be added, with those that this log does not tell from it."""
    best = simplest(problem, one.able)
    members = group(problem, one.rivals, seed)
    if best.hypothesis.name not in dict(members):  # one that closes too little to be named has far more evidence
        members = group(problem, one.able, seed)
    members = tuple(sorted(members, key=lambda member: member[0] != best.hypothesis.name))
    rivals = tuple(replace(r, fitted=r.fitted.light()) for r in one.rivals)
    fitted = best.fitted if best.fitted.point.scaled else confirm(problem, best.fitted.point.beta, best.fitted.slots)
    return Named(best.hypothesis, members, fitted, one.detection.p_value(best.hypothesis.label), best.evidence, rivals)


def _pruned(problem: Problem, named: list[Named]) -> list[Named]:
    """Drop effects that the last one made needless: without them the evidence of the joint fit is no worse."""
    for one in named[:-1]:
        whole = named[-1].fitted
        slots = tuple(s for s in whole.slots if s not in one.hypothesis.slots)
        start = whole.beta.copy()
        start[list(one.hypothesis.slots)] = problem.origin[list(one.hypothesis.slots)]
        without = roughly(problem, start, slots, whole.point.scaled)
        if without.evidence > whole.evidence - NEEDLESS:
            without = confirm(problem, without.point.beta, slots)
            rest = [n for n in named if n is not one]
            named = [*rest[:-1], replace(rest[-1], fitted=without)]
    return named


def _ranking(
    problem: Problem, library: list[Hypothesis], named: list[Named], rounds: Sequence[tuple[tuple[str, float, float], ...]]
) -> tuple[tuple[str, float], ...]:
    """Every hypothesis with the held-out share of the gap that it closes by itself, slop standing still: the named ones, then the others by that
    share, re-simulated for the finalists, linearised for the rest."""
    _, fits = contest(Ring.of(problem.gap_data, problem.folds), Prior({}), {h.label: prior_of(problem, h) for h in library}, problem.inflation)
    gap, share = float(problem.gap_data.c.sum()), dict[str, float]()
    for h in library:
        share[h.name] = max(1.0 - fits[h.label].loss / gap, share.get(h.name, -np.inf))
    share |= {name: gain for name, _, gain in (rounds[0] if rounds else ())}
    leading = dict.fromkeys(n.hypothesis.name for n in named)
    return tuple((name, share[name]) for name in (*leading, *sorted(share.keys() - leading.keys(), key=lambda n: -share[n])))
