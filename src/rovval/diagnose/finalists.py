"""The finalists of a round: the hypotheses that a screen puts first, settled by re-simulation, and which of them could be the cause."""

from __future__ import annotations

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, confirm, roughly, significance
from rovval.diagnose.contest import Prior, step
from rovval.diagnose.detect import Detection
from rovval.diagnose.library import PRIOR_WIDTH, Hypothesis
from rovval.diagnose.point import Point, whole_evidence
from rovval.diagnose.problem import Problem
from rovval.diagnose.products import Products
from rovval.diagnose.separate import PER_PARAMETER, Losses, Rival, alike, closed, coherence, form_share
from rovval.diagnose.settle import stays

FINALISTS = 10  # hypotheses that are re-simulated in a round
SCREENED = 0.15  # of the best linear evidence: less is not re-simulated
TWIN, MOST_TWINS = 0.85, 4  # coherence from which a hypothesis is re-simulated beside the best finalist whatever the screen said
HALF_REVERSED = 0.55  # 0.5 is a dead thruster; the margin is chosen
LEAST_SIGMA = 2.2  # standard errors, slop included, by which an effect departs from nothing (tuning set: healthy logs reach 2.0)
TOLERANCES = 3.0  # times the tolerance of calibration slop within which a coefficient is not worth a name
LOSSES = 1.5  # the same for a loss of thrust that comes and goes
SHARPENED = 4  # finalists that are settled with slopes made at their own point
SERIOUS = 0.5  # share of the best evidence from which a rival's gain counts
NEARLY = 0.9  # of the best's gain
LEAST_OF_BEST = 0.5  # of the gain of the best serious rival
REVERSED, DEGRADED = "thruster_reversed", "thruster_degraded"  # one imitates the other up to a dead thruster, and no further


def finalists(
    problem: Problem, data: Products, library: list[Hypothesis], detection: Detection, base: Point, chosen: tuple[int, ...], loss: Losses
) -> list[Rival]:
    """The best starting point of each of the best hypotheses, settled jointly with what was chosen before; best evidence first.

    ``loss`` are the held-out losses of what stands, with and without the kinematic checks, ``base`` where it settled and ``data`` the library linearised there.
    """
    ordered = sorted(library, key=lambda h: -detection.evidence[h.label])
    least = SCREENED * max(detection.evidence[detection.best], 0.0)
    ground = problem.slop.widened(freed(problem, chosen))
    fitted: dict[str, tuple[Hypothesis, Confirmed]] = {}

    def refit(h: Hypothesis) -> None:
        slots = tuple(dict.fromkeys((*chosen, *h.slots)))
        start = _start(problem, data, h, step(data, ground.widened(prior_of(h)), problem.inflation), base.beta, slots)
        if h.name.startswith(REVERSED):
            start = _turned(problem, h, start)
        fitted[h.name] = h, roughly(problem, start, slots, base.linear)

    for h in ordered:
        if h.name not in fitted and len(fitted) < FINALISTS and detection.evidence[h.label] > least:
            refit(h)
    if fitted:
        best = max(fitted.values(), key=lambda item: item[1].evidence)[0]
        twins = [h for h in ordered if h.name not in fitted and coherence(data, best.columns, h.columns) > TWIN]
        turned = [h for h in ordered if h.name.replace(REVERSED, DEGRADED) in fitted and h.name.startswith(REVERSED)]
        for h in (*twins[:MOST_TWINS], *turned):
            if h.name not in fitted:
                refit(h)
    return _weighed(problem, list(fitted.values()), base, loss)


def sharpened(problem: Problem, rivals: list[Rival], base: Point, loss: Losses) -> list[Rival]:
    """The best of the admissible settled with slopes made at their own point, the others as they are."""
    serious = [r for r in rivals if r.evidence > SERIOUS * rivals[0].evidence][:SHARPENED]
    sharp = [(r.hypothesis, confirm(problem, r.fitted.point.beta, r.fitted.slots)) for r in serious]
    return _weighed(problem, sharp + [(r.hypothesis, r.fitted) for r in rivals if r not in serious], base, loss)


def _weighed(problem: Problem, fitted: list[tuple[Hypothesis, Confirmed]], base: Point, loss: Losses) -> list[Rival]:
    """Finalists with what they add to what stands: evidence over slop, and the share that they close of what is left of the gap, with or
    without the kinematic checks, whichever is more."""
    ground = whole_evidence(problem, base)
    rivals = [Rival(h, c, c.evidence - ground, *closed(loss, (c.loss, c.dynamic_loss))) for h, c in fitted]
    return sorted(rivals, key=lambda r: -r.evidence)


def admissible(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Of the `possible` those that could be the cause by themselves: they close on held-out windows at least half of what the best of the
    serious rivals closes. What a hypothesis achieves only with slop's help leaves the gap itself open."""
    rivals = _in_form(problem, weighed)
    if not rivals:
        return []
    serious = max(r.gain for r in rivals if r.evidence >= SERIOUS * rivals[0].evidence)
    return [r for r in possible(problem, weighed) if r.gain >= LEAST_OF_BEST * serious and r.gain > 0]


def possible(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Finalists whose size is beyond what slop of all other coefficients could feign, best evidence first."""
    rivals = _in_form(problem, weighed)
    return [r for r in rivals if significance(problem, r.fitted, r.hypothesis.slots) >= LEAST_SIGMA and _beyond_tolerance(problem, r)]


def _in_form(problem: Problem, weighed: list[Rival]) -> list[Rival]:
    """Finalists that are what their name says, where the best has evidence at all: a thruster counts as reversed only where it pushes the
    other way (up to half-reversed it is a degraded one), and what begins before the log does has no onset in it."""
    rivals = [r for r in weighed if not _half_reversed(r) and not _from_the_start(problem, r)]
    return rivals if rivals and rivals[0].evidence > 0 else []


def _beyond_tolerance(problem: Problem, rival: Rival) -> bool:
    """Whether some parameter that healthy vehicles and sensors vary in is further off than they are; True where none has a tolerance.

    A loss of thrust that begins, or that a stream causes, is held against what thrust may be off by all the time.
    """
    beta, origin, slots = rival.fitted.beta, problem.origin, problem.plant.slots
    tolerance = {s: TOLERANCES * problem.slop.sd[s] for s in rival.hypothesis.slots if s in problem.slop.sd}
    thrust = max((sd for s, sd in problem.slop.sd.items() if slots[s].effect == "thruster_degraded"), default=0.0)
    tolerance |= {s: LOSSES * thrust for s in rival.hypothesis.slots if slots[s].parameter.name == "loss" and s not in tolerance}
    return not tolerance or any(abs(beta[s] - origin[s]) >= limit for s, limit in tolerance.items())


def simplest(problem: Problem, rivals: list[Rival]) -> Rival:
    """Of the rivals that the form of an equation may set apart, the one with the fewest parameters, if it closes nearly as much as the best;
    one that rests on a bound comes last."""
    most, least = len(rivals[0].hypothesis.slots), (1.0 - form_share(problem.blocks)) * rivals[0].evidence
    tied = [
        r for r in rivals
        if r is rivals[0]
        or alike(problem, r, rivals[0])
        or (r.evidence >= least and r.gain >= (NEARLY - PER_PARAMETER * max(most - len(r.hypothesis.slots), 0)) * rivals[0].gain)
    ]  # fmt: skip
    return min(tied, key=lambda r: (bool(r.fitted.at_bound), len(r.hypothesis.slots), -r.evidence))


def _from_the_start(problem: Problem, rival: Rival) -> bool:
    first = min(float(part.start[0] + part.steps) * part.run.dt for part in problem.parts)
    slots = problem.plant.slots
    return any(slots[s].parameter.name == "onset" and rival.fitted.beta[s] < first for s in rival.hypothesis.slots)


def _turned(problem: Problem, h: Hypothesis, start: Array) -> Array:
    """Start of a reversed thruster: fully turned, its gain as the vehicle has it. Where slop has worn the gain down to nothing, nothing
    shows which way the shaft turns."""
    start, target = start.copy(), h.name.removeprefix(REVERSED)
    for i, slot in enumerate(problem.plant.slots):
        if slot.hypothesis == DEGRADED + target:
            start[i] = problem.origin[i]
    start[list(h.slots)] = 1.0
    return start


def _half_reversed(rival: Rival) -> bool:
    h = rival.hypothesis
    return h.name.startswith(REVERSED) and any(rival.fitted.beta[s] < HALF_REVERSED for s in h.slots)


def _start(problem: Problem, data: Products, h: Hypothesis, moves: Array, beta: Array, own: tuple[int, ...]) -> Array:
    """The linear answer as the starting point of the re-simulation, inside the parameters' bounds; tolerances of sensors stay in the tangent."""
    start = beta.copy()
    still = {s for s in stays(problem.plant) if s not in own}
    for slot, value in h.at:
        start[slot] = value
    moved = {d.id: d.slot for d in h.directions}
    for column, move in zip(data.columns, moves, strict=True):
        slot = moved.get(column, column)
        if move and 0 <= slot < len(start) and slot not in still:
            parameter = problem.plant.slots[slot].parameter
            start[slot] = float(np.clip(start[slot] + move, parameter.low, parameter.high))
    return start


def freed(problem: Problem, slots: tuple[int, ...]) -> Prior:
    """The wide prior of effects that were chosen."""
    return Prior({s: PRIOR_WIDTH * problem.plant.slots[s].parameter.typical for s in slots})


def prior_of(h: Hypothesis) -> Prior:
    """The wide prior of a hypothesis."""
    return Prior(dict(zip(h.columns, h.sd, strict=True)))
