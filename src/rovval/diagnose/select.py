"""Which effects: forward selection with joint refit, each step detected on top of slop, named by held-out re-simulation.

A round asks three questions. Is there anything beyond calibration slop (`detect`)? Which hypotheses, refitted by re-simulation, do best on
windows that they were not fitted on (`confirm`)? Which others does this log not tell from the best (`separate`)? It stops when a gain
is not real or too small to matter; an effect that later ones make needless is dropped again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rovval.diagnose.confirm import Confirmed, confirm, roughly
from rovval.diagnose.contest import Prior, Ring, contest, fit
from rovval.diagnose.detect import Detection, detect
from rovval.diagnose.finalists import admissible, finalists, freed, prior_of, sharpened, simplest
from rovval.diagnose.library import Hypothesis
from rovval.diagnose.point import Point
from rovval.diagnose.problem import Problem, at, columns_of
from rovval.diagnose.products import Products
from rovval.diagnose.separate import group
from rovval.diagnose.settle import settle

MOST = 3  # effects at once
FALSE_ALARM = 0.05  # family-wise, over the whole library
PLAIN = 20.0  # twice the log Bayes factor that needs no p-value: where a strong effect is left of the log, null draws hold some of it
NEEDLESS = 6.0  # twice the log Bayes factor below which an effect is dropped again (Kass & Raftery 1995: positive evidence)
LEAST_GAIN = 0.06  # of the gap, on held-out windows: less is not worth a name
LATER_GAIN = 0.10  # of what is left, the same for a second and third effect: the forms of equations alone leave structure of this size
PROMISING = 0.5  # of `LEAST_EVIDENCE`, in the linearised model: less is not re-simulated
LEAST_EVIDENCE = 6.0  # over slop: "strong" (Kass & Raftery 1995); no healthy Merlin log of the tuning set got as far as finalists


@dataclass(frozen=True, slots=True)
class Named:
    """One effect that was found: its hypothesis, the group that this log cannot tell apart with probabilities (itself first), the joint
    fit after it was added, the detection that let it in and its evidence over what was there before."""

    hypothesis: Hypothesis
    group: tuple[tuple[str, float], ...]
    fitted: Confirmed
    p_value: float
    evidence: float


@dataclass(frozen=True, slots=True)
class Selection:
    """Effects in the order found; the final joint fit (None: nothing found); where slop settles without any; every hypothesis's held-out share of the gap;
    of each round the finalists with their evidence and held-out gain; the p-value of the round that ended the search."""

    named: tuple[Named, ...]
    final: Confirmed | None
    healthy: Point
    ranking: tuple[tuple[str, float], ...]
    rounds: tuple[tuple[tuple[str, float, float], ...], ...]
    last_p: float
    last_evidence: float
    null_evidence: float


def select(problem: Problem, library: list[Hypothesis], seed: int, progress: Callable[[str, float], None]) -> Selection:
    """Search for the effects that explain the gap; see the module."""
    chosen, loss = tuple[int, ...](), (problem.gap_data.c, problem.gap.c)
    healthy = base = settle(problem, problem.origin, ())
    named: list[Named] = []
    rounds: list[tuple[tuple[str, float, float], ...]] = []
    p, last, null = 1.0, 0.0, 0.0
    for round_number in range(MOST):
        progress(f"screening {len(library)} hypotheses, round {round_number + 1}", 0.3 + 0.2 * round_number)
        data = _bank(problem, library, base)
        open_now = [h for h in library if h.name not in {n.hypothesis.name for n in named}]
        detection = _detect(problem, data, open_now, chosen, seed + round_number)
        p, last, null = detection.p_value(detection.best), detection.evidence[detection.best], float(np.quantile(detection.null, 0.95))
        if last < PROMISING * LEAST_EVIDENCE or (p > FALSE_ALARM and last < PLAIN):
            break
        progress("re-simulating the finalists", 0.4 + 0.2 * round_number)
        weighed = finalists(problem, data, open_now, detection, base, chosen, loss)
        able = admissible(problem, sharpened(problem, admissible(problem, weighed), base, loss))
        rounds.append(tuple((r.hypothesis.name, r.evidence, r.gain) for r in able or weighed))
        able = [r for r in able if r.gain >= (LATER_GAIN if named else LEAST_GAIN) and r.evidence >= LEAST_EVIDENCE]
        if not able:
            break
        members = group(problem, able, seed)
        best = simplest(problem, able)
        members = tuple(sorted(members, key=lambda member: member[0] != best.hypothesis.name))
        named.append(Named(best.hypothesis, members, best.fitted, detection.p_value(best.hypothesis.label), best.evidence))
        named = _pruned(problem, named)
        chosen, base = named[-1].fitted.slots, named[-1].fitted.point
        loss = named[-1].fitted.loss, named[-1].fitted.dynamic_loss
    final = named[-1].fitted if named else None
    return Selection(tuple(named), final, healthy, _ranking(problem, library, named, rounds), tuple(rounds), p, last, null)


def _pruned(problem: Problem, named: list[Named]) -> list[Named]:
    """Drop effects that the last one made needless: without them the evidence of the joint fit is no worse."""
    for one in named[:-1]:
        whole = named[-1].fitted
        slots = tuple(s for s in whole.slots if s not in one.hypothesis.slots)
        start = whole.beta.copy()
        start[list(one.hypothesis.slots)] = problem.origin[list(one.hypothesis.slots)]
        without = roughly(problem, start, slots, whole.point.linear)
        if without.evidence > whole.evidence - NEEDLESS:
            without = confirm(problem, without.point.beta, slots)
            rest = [n for n in named if n is not one]
            named = [*rest[:-1], replace(rest[-1], fitted=without)]
    return named


def _bank(problem: Problem, library: list[Hypothesis], base: Point) -> Products:
    """Linearise everything about the point reached."""
    columns, directions = columns_of(library, problem.slop)
    data = at(problem, base.beta, tuple(sorted({*columns, *base.columns})), directions)
    offset = np.array([base.beta[c] - problem.origin[c] if c < len(base.beta) else 0.0 for c in data.columns])
    return replace(data, offset=offset)


def _detect(problem: Problem, data: Products, library: list[Hypothesis], chosen: tuple[int, ...], seed: int) -> Detection:
    """Evidence of each hypothesis on top of slop and of what was chosen before."""
    slots = [c for c in data.columns if c < len(problem.plant.slots)]
    typical = Prior({c: problem.plant.slots[c].parameter.typical for c in slots})
    everything = fit(Ring.of(data, problem.folds), typical, problem.inflation).step
    base = problem.slop.widened(freed(problem, chosen))
    return detect(data, base, problem.slop, {h.label: prior_of(h) for h in library}, problem.inflation, everything, seed)


def _ranking(
    problem: Problem, library: list[Hypothesis], named: list[Named], rounds: list[tuple[tuple[str, float, float], ...]]
) -> tuple[tuple[str, float], ...]:
    """Every hypothesis with the held-out share of the gap that it closes by itself, slop standing still: the named ones, the finalists by
    evidence, then the others by their share in the linearised model."""
    _, fits = contest(Ring.of(problem.gap_data, problem.folds), Prior({}), {h.label: prior_of(h) for h in library}, problem.inflation)
    gap, share = float(problem.gap_data.c.sum()), dict[str, float]()
    for h in library:
        share[h.name] = max(1.0 - fits[h.label].loss / gap, share.get(h.name, -np.inf))
    share |= {name: gain for name, _, gain in (rounds[0] if rounds else ())}
    leading = dict.fromkeys([n.hypothesis.name for n in named] + [name for name, _, _ in (rounds[0] if rounds else ())])
    return tuple((name, share[name]) for name in (*leading, *sorted(share.keys() - leading.keys(), key=lambda n: -share[n])))


