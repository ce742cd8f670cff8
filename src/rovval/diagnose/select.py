"""Which effects: forward selection with joint refit, each step detected on top of slop, named by held-out re-simulation.

A round asks three questions. Is there anything beyond calibration slop (`detect`)? Which hypotheses, refitted by re-simulation, do best on
windows that they were not fitted on (`confirm`)? Which others does this log not tell from the best (`separate`)? It stops when a gain
is not real or too small to matter; an effect that later ones make needless is dropped again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, confirm, roughly, significance
from rovval.diagnose.contest import Fit, Prior, Ring, contest, fit
from rovval.diagnose.detect import Detection, detect
from rovval.diagnose.library import PRIOR_WIDTH, Hypothesis
from rovval.diagnose.problem import Problem, at, columns_of
from rovval.diagnose.products import Products
from rovval.diagnose.separate import PER_PARAMETER, Rival, coherence, group
from rovval.diagnose.settle import Point, evidence, settle

MOST = 3  # effects at once
FINALISTS = 10  # hypotheses that are re-simulated in a round
TWIN, MOST_TWINS = 0.85, 4  # coherence from which a hypothesis is re-simulated beside the best finalist whatever the screen said
FALSE_ALARM = 0.05  # family-wise, over the whole library
NEEDLESS = 6.0  # twice the log Bayes factor below which an effect is dropped again (Kass & Raftery 1995: positive evidence)
HALF_REVERSED = 0.55  # 0.5 is a dead thruster; the margin is chosen
LEAST_GAIN = 0.04  # of the gap, on held-out windows: less is not worth a name
LATER_GAIN = 0.08  # the same for a second and third effect: the forms of equations alone leave structure of this size
LEAST_EVIDENCE = 16.0  # over slop: well past "very strong" (10; Kass & Raftery 1995), since null logs reach 10 now and then
LEAST_SIGMA = 2.2  # standard errors, slop included, by which an effect departs from nothing (tuning set: healthy logs reach 2.0)
TOLERANCES = 3.0  # times the tolerance of calibration slop within which a coefficient is not worth a name
SHARPENED = 4  # finalists that are settled with slopes made at their own point
SERIOUS = 0.5  # share of the best evidence from which a rival's gain counts
NEARLY = 0.9  # of the best's gain
LEAST_OF_BEST = 0.5  # of the gain of the best serious rival


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
    chosen, loss = tuple[int, ...](), problem.data.c
    healthy = base = settle(problem, problem.origin, ())
    named: list[Named] = []
    rounds: list[tuple[tuple[str, float, float], ...]] = []
    ranking: tuple[tuple[str, float], ...] = ()
    p, last, null = 1.0, 0.0, 0.0
    for round_number in range(MOST):
        progress(f"screening {len(library)} hypotheses, round {round_number + 1}", 0.3 + 0.2 * round_number)
        data = _bank(problem, library, base)
        open_now = [h for h in library if h.name not in {n.hypothesis.name for n in named}]
        detection = _detect(problem, data, open_now, chosen, seed + round_number)
        names = _name(problem, data, open_now, chosen)
        if not ranking:
            ranking = _ranking(names)
        p, last, null = detection.p_value(detection.best), detection.evidence[detection.best], float(np.quantile(detection.null, 0.95))
        if p > FALSE_ALARM:
            break
        progress("re-simulating the finalists", 0.4 + 0.2 * round_number)
        fitted = _finalists(problem, data, names, detection, base, chosen)
        weighed = _weighed(problem, fitted, base, loss)
        able = admissible(problem, _sharpened(problem, admissible(problem, weighed), base, loss))
        rounds.append(tuple((r.hypothesis.name, r.evidence, r.gain) for r in able or weighed))
        if not able or able[0].gain < (LATER_GAIN if named else LEAST_GAIN) or able[0].evidence < LEAST_EVIDENCE:
            break
        members = group(problem, able, seed)
        best = simplest(able, members)
        members = tuple(sorted(members, key=lambda member: member[0] != best.hypothesis.name))
        named.append(Named(best.hypothesis, members, best.fitted, detection.p_value(best.hypothesis.label), best.evidence))
        named = _pruned(problem, named)
        chosen, loss, base = named[-1].fitted.slots, named[-1].fitted.loss, named[-1].fitted.point
    final = named[-1].fitted if named else None
    return Selection(tuple(named), final, healthy, ranking, tuple(rounds), p, last, null)


def _pruned(problem: Problem, named: list[Named]) -> list[Named]:
    """Drop effects that the last one made needless: without them the evidence of the joint fit is no worse."""
    for one in named[:-1]:
        whole = named[-1].fitted
        slots = tuple(s for s in whole.slots if s not in one.hypothesis.slots)
        start = whole.beta.copy()
        start[list(one.hypothesis.slots)] = problem.origin[list(one.hypothesis.slots)]
        without = confirm(problem, start, slots)
        if without.evidence > whole.evidence - NEEDLESS:
            rest = [n for n in named if n is not one]
            named = [*rest[:-1], replace(rest[-1], fitted=without)]
    return named


def _bank(problem: Problem, library: list[Hypothesis], base: Point) -> Products:
    """Linearise everything about the point reached."""
    columns, directions = columns_of(library, problem.slop)
    data = at(problem, base.beta, tuple(sorted({*columns, *base.columns})), directions)[1]
    offset = np.array([base.beta[c] - problem.origin[c] if c < len(base.beta) else 0.0 for c in data.columns])
    return replace(data, offset=offset)


def _free(problem: Problem, slots: tuple[int, ...]) -> Prior:
    return Prior({s: PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in slots})


def _prior(h: Hypothesis) -> Prior:
    return Prior(dict(zip(h.columns, h.sd, strict=True)))


def _detect(problem: Problem, data: Products, library: list[Hypothesis], chosen: tuple[int, ...], seed: int) -> Detection:
    """Evidence of each hypothesis on top of slop and of what was chosen before."""
    slots = [c for c in data.columns if c < len(problem.plant.slots)]
    typical = Prior({c: problem.plant.slots[c].parameter.typical for c in slots})
    everything = fit(Ring.of(data, problem.folds), typical, problem.inflation).step
    base = problem.slop.widened(_free(problem, chosen))
    return detect(data, base, problem.slop, {h.label: _prior(h) for h in library}, problem.inflation, everything, seed)


def _name(problem: Problem, data: Products, library: list[Hypothesis], chosen: tuple[int, ...]) -> dict[str, tuple[Hypothesis, Fit, float]]:
    """Held-out contest of names with slop beside them: label -> hypothesis, fit, share of the loss that it takes away."""
    base = problem.slop.widened(_free(problem, chosen))
    _, fits = contest(Ring.of(data, problem.folds), base, {h.label: _prior(h) for h in library}, problem.inflation)
    return {h.label: (h, fits[h.label], 1.0 - fits[h.label].loss / max(float(data.c.sum()), 1e-300)) for h in library}


def _ranking(contest: dict[str, tuple[Hypothesis, Fit, float]]) -> tuple[tuple[str, float], ...]:
    best: dict[str, float] = {}
    for h, _, share in contest.values():
        best[h.name] = max(share, best.get(h.name, -np.inf))
    return tuple(sorted(best.items(), key=lambda item: -item[1]))


def _finalists(
    problem: Problem, data: Products, names: dict[str, tuple[Hypothesis, Fit, float]], detection: Detection, base: Point, chosen: tuple[int, ...]
) -> list[tuple[Hypothesis, Confirmed]]:
    """The best starting point of each of the best hypotheses, refitted by re-simulation jointly with what was chosen before."""
    ordered = sorted(names.values(), key=lambda item: -detection.evidence[item[0].label])
    fitted: dict[str, tuple[Hypothesis, Confirmed]] = {}

    def refit(h: Hypothesis, one: Fit) -> None:
        start = _start(problem, data, h, one, base.beta)
        fitted[h.name] = h, roughly(problem, start, tuple(dict.fromkeys((*chosen, *h.slots))), base.linear)

    for h, one, _ in ordered:
        if h.name not in fitted and len(fitted) < FINALISTS and detection.evidence[h.label] > 0:
            refit(h, one)
    if fitted:
        best = max(fitted.values(), key=lambda item: item[1].evidence)[0]
        twins = [v for v in ordered if v[0].name not in fitted and coherence(data, best.columns, v[0].columns) > TWIN]
        for h, one, _ in twins[:MOST_TWINS]:
            if h.name not in fitted:
                refit(h, one)
    return list(fitted.values())


def _sharpened(problem: Problem, rivals: list[Rival], base: Point, loss: Array) -> list[Rival]:
    """The best of the admissible settled with slopes made at their own point, the others as they are."""
    serious = [r for r in rivals if r.evidence > SERIOUS * rivals[0].evidence][:SHARPENED]
    sharp = [(r.hypothesis, confirm(problem, r.fitted.point.beta, r.fitted.slots)) for r in serious]
    return _weighed(problem, sharp + [(r.hypothesis, r.fitted) for r in rivals if r not in serious], base, loss)


def _weighed(problem: Problem, fitted: list[tuple[Hypothesis, Confirmed]], base: Point, loss: Array) -> list[Rival]:
    """Finalists with what they add to what stands: evidence over slop, and the share of the gap that they close by themselves."""
    ground, gap = float(evidence(problem, base, np.ones((1, problem.blocks)))[0]), float(problem.data.c.sum())
    rivals = [Rival(h, c, c.evidence - ground, float((loss - c.loss).sum()) / gap) for h, c in fitted]
    return sorted(rivals, key=lambda r: -r.evidence)


def admissible(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Finalists that could be the cause, best evidence first.

    Evidence alone is not enough: what a hypothesis achieves only with slop's help leaves the gap itself open. It must close, by itself
    and on held-out windows, at least half of what the best of its serious rivals closes, and its size must be beyond what slop of
    all other coefficients could feign. A thruster counts as reversed only where it pushes the other way (up to half-reversed it is
    a degraded one), and what begins before the log does has no onset in it.
    """
    rivals = [r for r in weighed if not _half_reversed(r) and not _from_the_start(problem, r)]
    if not rivals or rivals[0].evidence <= 0:
        return []
    serious = max(r.gain for r in rivals if r.evidence >= SERIOUS * rivals[0].evidence)
    return [
        r for r in rivals
        if r.gain >= LEAST_OF_BEST * serious
        and r.gain > 0
        and significance(problem, r.fitted, r.hypothesis.slots) >= LEAST_SIGMA
        and _beyond_tolerance(problem, r)
    ]  # fmt: skip


def _beyond_tolerance(problem: Problem, rival: Rival) -> bool:
    """Whether some parameter that healthy vehicles and sensors vary in is further off than they are; True where none has a tolerance."""
    slots = [s for s in rival.hypothesis.slots if s in problem.slop.sd]
    off = [abs(rival.fitted.beta[s] - problem.origin[s]) / problem.slop.sd[s] for s in slots]
    return not off or max(off) >= TOLERANCES


def simplest(rivals: list[Rival], members: tuple[tuple[str, float], ...]) -> Rival:
    """Of the rivals that the log does not tell apart, the one with the fewest parameters, if it closes nearly as much as the best does."""
    most = len(rivals[0].hypothesis.slots)
    tied = [
        r for r in rivals
        if r.hypothesis.name in dict(members) and r.gain >= (NEARLY - PER_PARAMETER * max(most - len(r.hypothesis.slots), 0)) * rivals[0].gain
    ]  # fmt: skip
    return min(tied, key=lambda r: (len(r.hypothesis.slots), -r.evidence))


def _from_the_start(problem: Problem, rival: Rival) -> bool:
    first = min(float(part.start[0] + part.steps) * part.run.dt for part in problem.parts)
    slots = problem.plant.slots
    return any(slots[s].parameter.name == "onset" and rival.fitted.beta[s] < first for s in rival.hypothesis.slots)


def _half_reversed(rival: Rival) -> bool:
    h = rival.hypothesis
    return h.name.startswith("thruster_reversed") and any(rival.fitted.beta[s] < HALF_REVERSED for s in h.slots)


def _start(problem: Problem, data: Products, h: Hypothesis, one: Fit, beta: Array) -> Array:
    """The linear answer as the starting point of the re-simulation, inside the parameters' bounds."""
    start = beta.copy()
    for slot, value in h.at:
        start[slot] = value
    moved = {d.id: d.slot for d in h.directions}
    for column, step in zip(data.columns, one.step, strict=True):
        slot = moved.get(column, column)
        if step and 0 <= slot < len(start):
            parameter = problem.plant.slots[slot].parameter
            start[slot] = float(np.clip(start[slot] + step, parameter.low, parameter.high))
    return start
