"""Settle effects and calibration slop together by re-simulation: the most probable point of both, linearised there.

Slop moves in the simulation itself, not only in its tangent: a coefficient that has to go far from its tolerance is seen to, and what a
hypothesis then still gains is gained over a vehicle whose coefficients are as good as a careful calibration makes them. The sensors'
tolerances, small and nearly linear, stay in the tangent.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.problem import Problem, carried, in_metric, products_about
from rovval.diagnose.residuals.normal_equations import Scaled, beside
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.plant import Plant

ROUNDS, FEW = 5, 3  # damped steps of a fit, and of one that only has to show whether it is worth more
LITTLE = 1.0  # twice the log posterior: a smaller gain is not worth another step
FAR, ANEW = 10.0, 2  # the same, from which slop's slopes are made anew, and how often at most
SHORTER = (1.0, 0.4, 0.1)  # shares of the Gauss-Newton step that are tried
EARLY = (2.5, 5.0)  # s of each window that are fitted before the whole of it (chosen)


def settle(problem: Problem, start: Array, slots: tuple[int, ...], near: tuple[Scaled, ...] | None = None, rounds: int = ROUNDS) -> Point:
    """Fit ``slots`` and slop jointly from ``start``.

    With ``near``, the slopes of slop and of the windows' starts are taken from a linearisation nearby; else they are made at ``start``, and
    made anew, `ANEW` times at most, where the fit ends far from it. Slop moves in the simulation all the same.
    """
    if near is not None:
        return _descended(problem, about(problem, start, _columns(problem, slots), len(slots), near), near, rounds)
    point = about(problem, start, _columns(problem, slots), len(slots))
    for _ in range(ANEW):
        reached = _descended(problem, point, point.scaled, rounds)
        if point.cost() - reached.cost() < FAR * problem.inflation:
            return reached
        point = about(problem, reached.beta, point.columns, point.own)
    return _descended(problem, point, point.scaled, rounds)


def healthy_point(problem: Problem) -> Point:
    """Where slop settles by itself."""
    return settle(problem, early(problem, problem.origin, ()), ())


def early(problem: Problem, start: Array, slots: tuple[int, ...]) -> Array:
    """Where ``slots`` and slop (k,) settle from ``start`` on the beginning of each window. Over ten seconds a vehicle that rolls freely, or that something
    holds, forgets how it began, and a fit of the whole window from far away ends in the first of many valleys."""
    beta = start
    for seconds in EARLY:
        beta = settle(_begun(problem, seconds), beta, slots).beta
    return beta


def resettled(problem: Problem, before: Point, point: Point, slots: tuple[int, ...]) -> Point:
    """The healthy vehicle, settled again from where slop stands at ``point``, its ``slots`` gone, or as it was ``before`` where that is better:
    every search is local, and no cause is to gain by another start."""
    start = point.beta.copy()
    start[list(slots)] = problem.origin[list(slots)]
    if settle(problem, start, (), before.scaled, FEW).profile() >= before.profile():
        return before
    again = settle(problem, start, ())
    return again if again.profile() < before.profile() else before


def _begun(problem: Problem, seconds: float) -> Problem:
    """The problem with nothing but the first ``seconds`` of each window."""
    n = round(seconds / problem.parts[0].run.dt) + 1
    parts = [
        replace(p, steps=n - 1, y=p.y[:, :n], ok=p.ok[:, :n], pushed=None if p.pushed is None else p.pushed[:, :n])
        for p in problem.parts if p.steps >= n
    ]  # fmt: skip
    return replace(problem, parts=tuple(parts), white=problem.white[:n]) if parts else problem


def _columns(problem: Problem, slots: tuple[int, ...]) -> tuple[int, ...]:
    return (*slots, *(c for c in problem.slop.sd if c not in slots))


def _descended(problem: Problem, point: Point, slopes: tuple[Scaled, ...], rounds: int) -> Point:
    """The point that damped steps reach, slop's ``slopes`` kept."""
    for _ in range(rounds):
        better = _better(problem, point, slopes)
        if better is None:
            break
        gain, point = point.cost() - better.cost(), better
        if gain < LITTLE * problem.inflation:
            break
    return point


def moved(problem: Problem, point: Point, slot: int, value: float) -> Point:
    """The point with one slot elsewhere, slop's slopes kept."""
    beta = point.beta.copy()
    beta[slot] = value
    return about(problem, beta, point.columns, point.own, point.scaled)


def stays(plant: Plant) -> frozenset[int]:
    """Slots that stay in the tangent as long as they are slop: those of the sensors."""
    return frozenset(i for i, slot in enumerate(plant.slots) if effects.load(slot.effect).place == "sensor")


def about(problem: Problem, beta: Array, columns: tuple[int, ...], own: int, near: tuple[Scaled, ...] | None = None) -> Point:
    """Linearise about ``beta``: all columns, or the own ones with the slopes of slop and of the windows' starts from ``near``."""
    if near is None:
        there = in_metric(problem, [linearise(part, beta, columns[:own], coarse=columns[own:]) for part in problem.parts])
    else:
        mine = [linearise(part, beta, columns[:own], starts=False) for part in problem.parts]
        there = tuple(beside(one, other, columns[own:]) for one, other in zip(mine, near, strict=True))
    return _point(problem, beta, own, there)


def _point(problem: Problem, beta: Array, own: int, there: tuple[Scaled, ...]) -> Point:
    dynamic, data = products_about(problem, beta, there)
    columns = data.columns
    parameters = [problem.plant.slots[s].parameter for s in columns]
    width = np.array([PRIOR_WIDTH * p.typical for p in parameters[:own]] + [problem.slop.sd[s] for s in columns[own:]])
    at = beta[list(columns)]
    side = np.array([float(x >= p.high) - float(x <= p.low) for x, p in zip(at, parameters, strict=True)])
    sensors = stays(problem.plant)
    still = np.array([i >= own and s in sensors for i, s in enumerate(columns)], dtype=bool)
    return Point(beta, columns, own, there, dynamic, data, problem.inflation / width**2, at - problem.origin[list(columns)], side, still)


def _better(problem: Problem, point: Point, near: tuple[Scaled, ...]) -> Point | None:
    """The next point of a damped Gauss-Newton iteration, None where no step gains more than a `LITTLE`."""
    step = np.where(point.still, 0.0, point.solved(point.curvature, point.slope))
    for share in SHORTER:
        beta = _clipped(problem, point, share * step)
        data = carried(problem, beta, point.scaled)
        if data is None:
            continue
        trial = replace(point, beta=beta, data=data, offset=point.offset + (beta - point.beta)[list(point.columns)])
        if trial.cost() < point.cost() - LITTLE * problem.inflation:
            return about(problem, beta, point.columns, point.own, near)
    return None


def _clipped(problem: Problem, point: Point, step: Array) -> Array:
    """The step, stopped at the parameters' bounds (a parameter that rests there is reported as such)."""
    trial = point.beta.copy()
    for slot, part in zip(point.columns, step, strict=True):
        parameter = problem.plant.slots[slot].parameter
        trial[slot] = min(max(point.beta[slot] + part, parameter.low), parameter.high)
    return trial
