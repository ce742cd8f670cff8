"""Which effects: forward selection with joint refit, each step detected on top of slop, named by held-out re-simulation.

A round asks three questions. Is there anything beyond calibration slop (`detect`)? Which hypotheses, refitted by re-simulation, do best on
windows that they were not fitted on (`confirm`)? Which others does this log not tell from the best (`separate`)? It stops when a gain
is not real or too small to matter; an effect that later ones make needless is dropped again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, confirm
from rovval.diagnose.contest import Fit, Prior, contest, fit
from rovval.diagnose.detect import null_gains
from rovval.diagnose.library import PRIOR_WIDTH, Hypothesis
from rovval.diagnose.problem import Problem, at, columns_of
from rovval.diagnose.products import Products
from rovval.diagnose.separate import group

MOST = 3  # effects at once
FINALISTS = 8  # hypotheses that are re-simulated in a round
FALSE_ALARM = 0.05  # family-wise, over the whole library
LEAST_GAIN = 0.05  # of the gap that is there in this round, on top of slop: less is not worth a name
NAMING_SLOP = 0.3  # share of the declared slop that stays in the contest of names


@dataclass(frozen=True, slots=True)
class Named:
    """One effect that was found: its hypothesis, the others this log cannot tell it from (with bootstrap shares), the joint fit after
    it was added and the detection that let it in."""

    hypothesis: Hypothesis
    group: tuple[tuple[str, float], ...]
    fitted: Confirmed
    p_value: float
    gain_over_slop: float


@dataclass(frozen=True, slots=True)
class Selection:
    """Effects in the order found; the final joint fit (None: nothing found); every hypothesis's held-out share of the gap alone; the
    p-value and gain of the round that ended the search."""

    named: tuple[Named, ...]
    final: Confirmed | None
    ranking: tuple[tuple[str, float], ...]
    last_p: float
    last_gain: float


def select(problem: Problem, library: list[Hypothesis], seed: int, progress: Callable[[str, float], None]) -> Selection:
    """Search for the effects that explain the gap; see the module."""
    beta, chosen = problem.origin.copy(), tuple[int, ...]()
    named: list[Named] = []
    ranking: tuple[tuple[str, float], ...] = ()
    p, gain = 1.0, 0.0
    for round_number in range(MOST):
        progress(f"screening {len(library)} hypotheses, round {round_number + 1}", 0.3 + 0.2 * round_number)
        data = _bank(problem, library, beta, chosen)
        open_now = [h for h in library if h.name not in {n.hypothesis.name for n in named}]
        over_slop, p = _detect(problem, data, open_now, chosen, seed + round_number)
        best_share = max(over_slop.values(), default=0.0)
        names = _name(problem, data, open_now, chosen)
        if not ranking:
            ranking = _ranking(names)
        gain = best_share
        if p > FALSE_ALARM or best_share < LEAST_GAIN:
            break
        progress("re-simulating the finalists", 0.4 + 0.2 * round_number)
        fitted = _finalists(problem, data, names, over_slop, beta, chosen)
        if not fitted:
            break
        losses = {h.name: c.loss for h, c in fitted}
        winner, best = min(fitted, key=lambda item: float(item[1].loss.sum()))
        members = tuple(group(losses, winner.name, seed))
        named.append(Named(winner, members, best, p, over_slop[winner.label]))
        beta, chosen = best.beta, best.slots
    final = named[-1].fitted if named else None
    return Selection(tuple(named), final, ranking, p, gain)


def _bank(problem: Problem, library: list[Hypothesis], beta: Array, chosen: tuple[int, ...]) -> Products:
    """Linearise everything about the point reached."""
    if (beta == problem.origin).all():
        return problem.data
    columns, directions = columns_of(library, problem.slop)
    return at(problem, beta, tuple(sorted({*columns, *chosen})), directions)[1]


def _free(problem: Problem, slots: tuple[int, ...]) -> Prior:
    return Prior({s: PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in slots})


def _prior(h: Hypothesis) -> Prior:
    return Prior(dict(zip(h.columns, h.sd, strict=True)))


def _detect(problem: Problem, data: Products, library: list[Hypothesis], chosen: tuple[int, ...], seed: int) -> tuple[dict[str, float], float]:
    """Held-out gain of each hypothesis on top of slop, as a share of the loss that slop leaves; p-value of the best."""
    base = problem.slop.widened(_free(problem, chosen))
    total, fits = contest(data, problem.folds, base, {h.label: _prior(h) for h in library}, problem.inflation)
    left = float(total.loss.sum())
    share = {label: float((left - one.loss.sum()) / left) for label, one in fits.items()}
    slots = [c for c in data.columns if c < len(problem.plant.slots)]
    everything = fit(data, problem.folds, Prior({c: problem.plant.slots[c].parameter.typical for c in slots}), problem.inflation).step
    null = null_gains(data, problem.folds, base, problem.slop, {h.label: _prior(h) for h in library}, problem.inflation, everything, seed)
    return share, null.p_value(max(share.values(), default=0.0))


def _name(problem: Problem, data: Products, library: list[Hypothesis], chosen: tuple[int, ...]) -> dict[str, tuple[Hypothesis, Fit, float]]:
    """Held-out contest of names with only a trace of slop: label -> hypothesis, fit, share of the loss that it takes away."""
    tight = Prior({s: NAMING_SLOP * sd for s, sd in problem.slop.sd.items()}).widened(_free(problem, chosen))
    _, fits = contest(data, problem.folds, tight, {h.label: _prior(h) for h in library}, problem.inflation)
    return {h.label: (h, fits[h.label], float(1.0 - fits[h.label].loss.sum() / data.c.sum())) for h in library}


def _ranking(contest: dict[str, tuple[Hypothesis, Fit, float]]) -> tuple[tuple[str, float], ...]:
    best: dict[str, float] = {}
    for h, _, share in contest.values():
        best[h.name] = max(share, best.get(h.name, -np.inf))
    return tuple(sorted(best.items(), key=lambda item: -item[1]))


def _finalists(
    problem: Problem, data: Products, names: dict[str, tuple[Hypothesis, Fit, float]], over_slop: dict[str, float], beta: Array, chosen: tuple[int, ...]
) -> list[tuple[Hypothesis, Confirmed]]:
    """The best starting point of each of the best hypotheses, refitted by re-simulation jointly with what was chosen before."""
    threshold = 0.5 * max(over_slop.values())
    ordered = sorted((v for label, v in names.items() if over_slop[label] > threshold), key=lambda item: -item[2])
    seen: set[str] = set()
    fitted = []
    for h, one, _ in ordered:
        if h.name in seen or len(seen) >= FINALISTS:
            continue
        seen.add(h.name)
        start = _start(problem, data, h, one, beta)
        fitted.append((h, confirm(problem, start, tuple(dict.fromkeys((*chosen, *h.slots))))))
    return fitted


def _start(problem: Problem, data: Products, h: Hypothesis, one: Fit, beta: Array) -> Array:
    """The linear answer as the starting point of the re-simulation, inside the parameters' bounds."""
    start = beta.copy()
    for slot, value in h.at:
        start[slot] = value
    free = [d.slot for d in h.directions] or list(h.columns)
    for slot, step in zip(free, one.step[data.place(h.columns)], strict=True):
        if slot >= 0:
            parameter = problem.plant.slots[slot].parameter
            start[slot] = float(np.clip(start[slot] + step, parameter.low, parameter.high))
    return start
