"""The finalists of a round: the hypotheses that a screen puts first, settled by re-simulation."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.cross_validation import step
from rovval.diagnose.inference.hypothesis_fit import Confirmed, confirm, roughly
from rovval.diagnose.inference.map_fit import early, stays
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.coherence import coherence
from rovval.diagnose.residuals.normal_equations import Products
from rovval.diagnose.search.admissibility import SERIOUS
from rovval.diagnose.search.baseline import Ground, rival
from rovval.diagnose.search.confusion import Rival

FINALISTS = 10  # hypotheses that are re-simulated in a round
SCREENED = 0.15  # of the best linear evidence: less is not re-simulated,
FEWEST, ANYWAY = 4, 20.0  # unless it is one of the first few and is strong evidence by itself
TRIES = 3  # starting points that a hypothesis whose fits end in many valleys is settled from
TWIN, MOST_TWINS = 0.85, 4  # coherence from which a hypothesis is re-simulated beside the best finalist whatever the screen said
PROMISED, RETRIED = 0.5, 2  # share of the tangent's evidence that a quick fit must keep, else it is settled with care; how many may be,
HOPEFUL = 0.25  # and how much of the best's evidence the tangent must promise (chosen: what closes little is found again once the best stands)
SHARPENED = 4  # finalists that are settled with slopes made at their own point


def finalists(
    problem: Problem, data: Products, library: list[Hypothesis], promised: Mapping[str, float], stands: Ground, chosen: tuple[int, ...]
) -> list[Rival]:
    """The best starting point of each of the best hypotheses, settled jointly with what was chosen before; best evidence first.

    ``data`` is the library linearised where what ``stands`` settled, ``promised`` the evidence there of each starting point.
    """
    base = stands.point
    ordered = sorted(library, key=lambda h: (not h.evident, -promised[h.label]))
    least = SCREENED * max(0.0, *(promised[h.label] for h in library))
    ground = problem.slop.widened(freed(problem, chosen))
    fitted: dict[str, tuple[Hypothesis, Confirmed]] = {}

    def moves(h: Hypothesis) -> Array:
        return step(data, ground.widened(prior_of(problem, h)), problem.inflation)

    def still(h: Hypothesis, slots: tuple[int, ...]) -> Array:
        """The start where all else stays as it stands: a step of everything may lead away what was found before."""
        return begun(problem, data, h, np.where(np.isin(data.columns, h.columns), moves(h), 0.0), base.beta, slots)

    def refit(h: Hypothesis) -> None:
        slots = tuple(dict.fromkeys((*chosen, *h.slots)))
        start = begun(problem, data, h, moves(h), base.beta, slots)
        if h.effect.continues:
            start = _beyond(problem, h, start)
        if h.evident:
            start = early(problem, still(h, slots), slots)
        quick = roughly(problem, start, slots, base.scaled).light()
        if h.name not in fitted or quick.evidence > fitted[h.name][1].evidence:
            fitted[h.name] = h, quick

    tries = Counter[str]()
    for h in ordered:
        promising = h.evident or promised[h.label] > (least if len(fitted) >= FEWEST else min(least, ANYWAY))
        if promising and (tries[h.name] < TRIES if h.name in fitted and _valleys(h) else h.name not in fitted and len(fitted) < FINALISTS):
            refit(h)
            tries[h.name] += 1
    if fitted:
        best = max(fitted.values(), key=lambda item: item[1].evidence)[0]
        twins = [h for h in ordered if h.name not in fitted and coherence(data, best.columns, h.columns) > TWIN]
        further = [h for h in ordered if h.effect.continues and f"{h.effect.continues}{h.of}" in fitted]
        for h in (*twins[:MOST_TWINS], *further):
            if h.name not in fitted:
                refit(h)
    return _weighed(problem, list(_retried(problem, promised, fitted, still if chosen else None, stands.evidence).values()), stands)


def _valleys(h: Hypothesis) -> bool:
    """Whether fits of it end in one of many valleys: it begins well away from nothing and is not settled through the beginnings of windows, or it swings."""
    return (h.whole and not h.evident) or h.effect.has("period")


def _retried(
    problem: Problem, promised: Mapping[str, float], fitted: dict[str, tuple[Hypothesis, Confirmed]],
    still: Callable[[Hypothesis, tuple[int, ...]], Array] | None, ground: float,
) -> dict[str, tuple[Hypothesis, Confirmed]]:
    """The fits, those settled with care that promise most and of which a quick fit, whose slopes stand still, kept little; from where it ended, and
    from ``still``, where there is one."""
    promise = {name: promised[h.label] for name, (h, _) in fitted.items()}
    kept = {name: quick.evidence - ground for name, (_, quick) in fitted.items()}
    least = HOPEFUL * max(kept.values(), default=0.0)
    short = sorted((name for name in fitted if kept[name] < PROMISED * promise[name] and promise[name] >= least), key=lambda name: -promise[name])
    found = dict(fitted)
    for name in short[:RETRIED]:
        h, quick = fitted[name]
        starts = [quick.point.beta, *([still(h, quick.slots)] if still else [])]
        careful = [confirm(problem, start, quick.slots).light() for start in starts]
        found[name] = h, max((quick, *careful), key=lambda one: one.evidence)
    return found


def sharpened(problem: Problem, rivals: list[Rival], stands: Ground) -> list[Rival]:
    """The best of the admissible settled with slopes made at their own point, the others as they are."""
    serious = [r for r in rivals if r.evidence > SERIOUS * rivals[0].evidence][:SHARPENED]
    sharp = [(r.hypothesis, confirm(problem, r.fitted.point.beta, r.fitted.slots)) for r in serious]
    return _weighed(problem, sharp + [(r.hypothesis, r.fitted) for r in rivals if r not in serious], stands)


def _weighed(problem: Problem, fitted: list[tuple[Hypothesis, Confirmed]], stands: Ground) -> list[Rival]:
    """Finalists with what they add to what stands, best evidence first."""
    return sorted((rival(problem, h, c, stands) for h, c in fitted), key=lambda r: -r.evidence)


def _beyond(problem: Problem, h: Hypothesis, start: Array) -> Array:
    """Start of an effect that continues another one (a thruster that is reversed and not only dead): as large as it is searched from, the other as the
    vehicle has it. Where tolerance has worn a thruster's gain down to nothing, nothing shows which way its shaft turns."""
    start = start.copy()
    for i, slot in enumerate(problem.plant.slots):
        if slot.hypothesis == f"{h.effect.continues}{h.of}":
            start[i] = problem.origin[i]
    for s in h.slots:
        start[s] = problem.plant.slots[s].parameter.starts[0]
    return start


def begun(problem: Problem, data: Products, h: Hypothesis, moves: Array, beta: Array, own: tuple[int, ...]) -> Array:
    """The linear answer as the starting point of the re-simulation, inside the parameters' bounds; tolerances of sensors stay in the tangent."""
    start = beta.copy()
    still = {s for s in stays(problem.plant) if s not in own}
    for slot, value in h.at:
        start[slot] = value
    moved, begins = {d.id: d.slot for d in h.directions}, {d.slot for d in h.directions} | {slot for slot, _ in h.at}
    for column, move in zip(data.columns, moves, strict=True):
        slot = moved.get(column, column)
        if move and 0 <= slot < len(start) and slot not in still and (column in moved or slot not in begins):
            parameter = problem.plant.slots[slot].parameter
            if parameter.role == "amplitude" and start[slot] + move < parameter.low:
                start, move = _half_a_turn_later(problem, h, start), -move
            start[slot] = float(np.clip(start[slot] + move, parameter.low, parameter.high))
    return start


def _half_a_turn_later(problem: Problem, h: Hypothesis, start: Array) -> Array:
    """The start with the phase of a swing turned over: the same as a negative amplitude, which has no meaning."""
    start = start.copy()
    for slot in h.slots:
        if problem.plant.slots[slot].parameter.role == "phase":
            start[slot] = start[slot] - np.pi if start[slot] > 0 else start[slot] + np.pi
    return start


def freed(problem: Problem, slots: tuple[int, ...]) -> Prior:
    """The wide prior of effects that were chosen."""
    return Prior({s: PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in slots})


def prior_of(problem: Problem, h: Hypothesis) -> Prior:
    """The wide prior of a hypothesis: of its columns, and of what slop may move of it wherever it begins."""
    own = {s: PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in h.slots if s in problem.slop.sd}
    return Prior(own | dict(zip(h.columns, h.sd, strict=True)))
