"""MAP fit by re-simulation: the most probable values of effects and of coefficients within tolerance, by Levenberg's and Marquardt's iteration.

Coefficients within tolerance move in the simulation itself, not only in its linearisation: the gain of a hypothesis is then one over a vehicle whose
coefficients are as a careful calibration would have them. The sensors' tolerances, small and nearly linear, stay in the linearisation; but for an
offset of the thrusters' clock beside a delay, which does the same.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.effort import (
    DAMPINGS,
    MAP_STEPS,
    PROGRESSIVE_S,
    QUICK_STEPS,
    RELINEARISED_TIMES,
    STEP_KEPT,
    STEP_SHARES,
    STEP_WORTH,
)
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.prior import wide_sd
from rovval.diagnose.problem.problem import Problem, equations_of, equations_with_frozen, whitened
from rovval.diagnose.residuals.normal_equations import Whitened, with_frozen_columns
from rovval.diagnose.residuals.perturbations import STEP, STEP_NEAR
from rovval.diagnose.residuals.sensitivities import linearise
from rovval.plant import Plant
from rovval.plant.sensors import moves_the_vehicle


def map_fit(problem: Problem, start: Array, slots: tuple[int, ...], near: tuple[Whitened, ...] | None = None, rounds: int = MAP_STEPS) -> Posterior:
    """Fit ``slots`` and coefficients within tolerance jointly from ``start`` (p,), in ``rounds`` steps at most; the posterior at the optimum.

    Sensitivities to the slots are taken anew at every step. Those to coefficients within tolerance and to initial states are frozen: those of ``near``, or
    of ``start``, and then of where each descent ends (`_followed`). The first descent takes sensitivities to the slots by wide differences (`STEP`), which see
    beyond a small valley.
    """
    share = STEP if slots else STEP_NEAR
    point = posterior_at(problem, start, _columns(problem, slots), len(slots), near, share)
    return _followed(problem, point, rounds, share) if near is None else _descended(problem, point, near, rounds, share)


def map_refit(problem: Problem, point: Posterior) -> Posterior:
    """The MAP fit under the priors of ``problem`` from where one under others ended, at first with the sensitivities that it has there."""
    return _followed(problem, _point(problem, point.beta, point.effect_count, point.whitened), MAP_STEPS, STEP_NEAR)


def healthy_fit(problem: Problem) -> Posterior:
    """The MAP fit of coefficients within tolerance alone."""
    return map_fit(problem, progressive_start(problem, problem.origin, ()), ())


def progressive_start(problem: Problem, start: Array, slots: tuple[int, ...]) -> Array:
    """Parameters (p,) of MAP fits from ``start`` to the first `PROGRESSIVE_S` of each window, one after the other.

    Over a whole window a vehicle that rolls freely, or is held, loses the phase of its motion, and a fit from far away ends in the nearest of many local
    minima; over short windows the loss has few.
    """
    beta = start
    for seconds in PROGRESSIVE_S:
        beta = map_fit(_begun(problem, seconds), beta, slots).beta
    return beta


def refit_healthy(problem: Problem, before: Posterior, point: Posterior, slots: tuple[int, ...]) -> Posterior:
    """The healthy fit begun at the coefficients of ``point``, its ``slots`` null, where that ends better than the fit ``before``; else ``before``.

    Every fit is local: a cause must not gain over the healthy vehicle by another start alone.
    """
    start = point.beta.copy()
    start[list(slots)] = problem.origin[list(slots)]
    quick = map_fit(problem, start, (), before.whitened, QUICK_STEPS)
    if before.predicted_cost() - quick.predicted_cost() < STEP_WORTH * problem.tempering:
        return before
    again = map_fit(problem, quick.beta, ())
    return again if again.predicted_cost() < before.predicted_cost() else before


def _begun(problem: Problem, seconds: float) -> Problem:
    """The problem with nothing but the first ``seconds`` of each window."""
    n = round(seconds / problem.runs[0].run.dt) + 1
    runs = [
        replace(p, steps=n - 1, y=p.y[:, :n], ok=p.ok[:, :n], disturbance_response=None if p.disturbance_response is None else p.disturbance_response[:, :n])
        for p in problem.runs if p.steps >= n
    ]  # fmt: skip
    return replace(problem, runs=tuple(runs), likelihood=replace(problem.likelihood, variance=problem.likelihood.variance[:n])) if runs else problem


def _columns(problem: Problem, slots: tuple[int, ...]) -> tuple[int, ...]:
    """The slots, then every other one that has a tolerance."""
    return (*slots, *(c for c in problem.tolerance.sd if c not in slots))


def _followed(problem: Problem, point: Posterior, rounds: int, share: float) -> Posterior:
    """The optimum from ``point``, with the sensitivities that it has there, by differences of a ``share`` of the typical sizes: where a descent ends they are
    made anew by small ones (`STEP_NEAR`), and another follows where one more step gains by them, `RELINEARISED_TIMES` times at most. Of the points so
    reached it is the best, each by its own sensitivities."""
    best = point
    for _ in range(RELINEARISED_TIMES):
        reached = _descended(problem, point, point.whitened, rounds, share)
        if reached is point and share == STEP_NEAR:
            break
        share = STEP_NEAR
        point = posterior_at(problem, reached.beta, point.columns, point.effect_count)
        best = min(point, best, key=Posterior.cost)
        if point.promised_gain() < STEP_WORTH * problem.tempering:
            break
    return best


def _descended(problem: Problem, point: Posterior, slopes: tuple[Whitened, ...], rounds: int, share: float) -> Posterior:
    """The point that ``rounds`` damped steps reach at most, with frozen sensitivities ``slopes`` to coefficients within tolerance, those to the effects by
    differences of a ``share`` of their typical sizes."""
    for _ in range(rounds):
        better = _better(problem, point, slopes, share)
        if better is None:
            break
        gain, point = point.cost() - better.cost(), better
        if gain < STEP_WORTH * problem.tempering:
            break
    return point


def moved_to(problem: Problem, point: Posterior, slot: int, value: float) -> Posterior:
    """The posterior about the same point with one slot at ``value``, sensitivities to coefficients within tolerance frozen."""
    beta = point.beta.copy()
    beta[slot] = value
    return posterior_at(problem, beta, point.columns, point.effect_count, point.whitened)


def effects_alone(problem: Problem, point: Posterior) -> Array:
    """Parameters (p,) of the plant with the effects of a fit, held within their bounds, and all else as the vehicle's file has it (`effects_given_others`)."""
    beta, slots = problem.origin.copy(), list(point.columns[: point.effect_count])
    departure = point.effects_given_others() @ (point.departure + point.solve(point.curvature, point.descent, point.tangent_only))
    for slot, value in zip(slots, problem.prior_mean[slots] + departure, strict=True):
        beta[slot] = problem.plant.slots[slot].parameter.within(float(value))
    return beta


def tangent_slots(plant: Plant, own: Sequence[int]) -> frozenset[int]:
    """Slots whose departures within tolerance are moved in the linearisation only beside effects of the slots ``own``: those of sensors; beside a delay not
    the clocks of the thrusters, which do what it does."""
    delayed = any(plant.slots[s].parameter.delays for s in own)
    sensors = (i for i, slot in enumerate(plant.slots) if effects.load(slot.effect).place == "sensor")
    return frozenset(i for i in sensors if not (delayed and moves_the_vehicle(plant.slots[i])))


def posterior_at(
    problem: Problem, beta: Array, columns: tuple[int, ...], own: int, near: tuple[Whitened, ...] | None = None, share: float = STEP_NEAR
) -> Posterior:
    """The posterior about ``beta`` (p,) in ``columns``, of which the first ``own`` are effects', by differences of a ``share`` of their typical sizes; with
    ``near``, sensitivities to the others and to initial states are taken from there."""
    if near is None:
        there = whitened(problem, [linearise(windows, beta, columns[:own], coarse=columns[own:], share=share) for windows in problem.runs])
    else:
        mine = [linearise(windows, beta, columns[:own], starts=False, share=share) for windows in problem.runs]
        there = tuple(with_frozen_columns(one, other, columns[own:]) for one, other in zip(mine, near, strict=True))
    return _point(problem, beta, own, there)


def _point(problem: Problem, beta: Array, own: int, there: tuple[Whitened, ...]) -> Posterior:
    """The posterior about ``beta`` of which ``there`` is the linearisation."""
    dynamic, data = equations_of(problem, beta, there)
    columns = data.columns
    parameters = [problem.plant.slots[s].parameter for s in columns]
    prior = problem.tolerance.plus(wide_sd(problem.plant, columns[:own]))
    at = beta[list(columns)]
    side = np.array([float(x >= p.high) - float(x <= p.low) for x, p in zip(at, parameters, strict=True)])
    sensors = tangent_slots(problem.plant, columns[:own])
    still = np.array([i >= own and s in sensors for i, s in enumerate(columns)], dtype=bool)
    tempering, departure = problem.tempering, at - problem.prior_mean[list(columns)]
    return Posterior(beta, columns, own, there, dynamic, data, tempering * prior.precision(columns), tempering, departure, side, still)


def _better(problem: Problem, point: Posterior, near: tuple[Whitened, ...], differences: float) -> Posterior | None:
    """The next point of Levenberg's and Marquardt's iteration, by the first of the trial steps that keeps what it promises (`STEP_KEPT`) or by the best of
    them; None where none gains more than `STEP_WORTH`."""
    best, before, gained = None, point.cost(), STEP_WORTH * problem.tempering
    for step, promised in _trial_steps(point):
        beta = moved_within_bounds(problem, point.beta, point.columns, step)
        data = equations_with_frozen(problem, beta, point.whitened)
        if data is None:
            continue
        trial = replace(point, beta=beta, total=data, departure=point.departure + (beta - point.beta)[list(point.columns)])
        if (gain := before - trial.cost()) > gained:
            best, gained = beta, gain
            if gain > STEP_KEPT * promised:
                break
    return None if best is None else posterior_at(problem, best, point.columns, point.effect_count, near, differences)


def _trial_steps(point: Posterior) -> Iterator[tuple[Array, float]]:
    """Steps (k,) that are tried in turn, by `DAMPINGS` and then by `STEP_SHARES` of the undamped one, each with the gain that the linearisation promises."""
    before = point.cost()
    for damping in DAMPINGS:
        step, predicted = point.simulated_step(damping)
        yield step, before - predicted
    step, predicted = point.simulated_step()
    for share in STEP_SHARES:
        yield share * step, share * (2.0 - share) * (before - predicted)


def moved_within_bounds(problem: Problem, beta: Array, columns: Sequence[int], step: Array) -> Array:
    """Parameters ``beta`` (p,) moved by a ``step`` (k,) in ``columns``, stopped at their bounds (a parameter that rests there is reported as such)."""
    moved = beta.copy()
    for slot, own in zip(columns, step, strict=True):
        moved[slot] = problem.plant.slots[slot].parameter.within(beta[slot] + own)
    return moved
