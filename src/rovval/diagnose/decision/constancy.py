"""Whether a cause holds still: a true one has one value all through the log, the nearest relative of another effect has not.

The value that a cause's parameter would take in each window by itself is held against the one that the whole log gives; for a cause that
sits in one thruster, its thrust is let vary in each `PIECES` part of a window as well (a coupling that slips, a supply that gives way).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import FEW_WINDOWS
from rovval.diagnose.inference.disturbance import pieces
from rovval.diagnose.inference.hypothesis_fit import Confirmed, places
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.external_forces import answered
from rovval.diagnose.residuals.normal_equations import Products, joined, products
from rovval.diagnose.residuals.sensitivities import spread
from rovval.diagnose.search.joint import Named
from rovval.vehicle.model import allocation

DRIFT, SURE = 0.4, 5.0  # of the value, and standard errors (opened sets: 30 true causes drift by 0.24 at most, or by 3.3 standard errors)
SHARES = (0.1, 0.2, 0.4, 0.8)  # of the value, or of the thruster's thrust: rms by which it may vary


def wavering(problem: Problem, final: Confirmed, named: Sequence[Named]) -> dict[str, float]:
    """Twice the log Bayes factor, for each named cause, of a value that varies normally about its mean over one that does not."""
    step = final.point.solved(final.point.curvature, final.point.slope)
    return {n.hypothesis.name: max(_windows(problem, final.point, step, n), _moments(problem, final.point, step, n)) for n in named}


def drifting(problem: Problem, final: Confirmed, named: Sequence[Named]) -> tuple[str, ...]:
    """Causes whose main parameter, the one that most windows show, surely moves by more than `DRIFT` of its value along the log, as the weight
    of a housing that fills does."""
    step = final.point.solved(final.point.curvature, final.point.slope)
    found = []
    for n in named:
        own = [_windowed(problem, final.point, step, slot) for slot in _sized(problem, final.point, n)]
        if own and _drifts(*max(own, key=lambda one: float(one[1].sum()) * one[0] ** 2), problem.inflation):
            found.append(n.hypothesis.name)
    return tuple(found)


def _drifts(value: float, A: Array, b: Array, inflation: float) -> bool:
    """Whether a line through what each window adds to the value leaves it, over the windows that show it, by more than it is."""
    at, shown = np.arange(len(A), dtype=np.float64), np.flatnonzero(A * value**2 > inflation)
    if len(shown) < FEW_WINDOWS:
        return False
    away = at - (A @ at) / A.sum()
    slope, worth = float(b @ away) / float(A @ away**2), float(A @ away**2) / inflation
    return abs(slope) * float(np.ptp(shown)) > DRIFT * abs(value) and abs(slope) * np.sqrt(worth) > SURE


def _windowed(problem: Problem, point: Point, step: Array, slot: int) -> tuple[float, Array, Array]:
    """A parameter's departure from where it stood, and of every window its curvature (m,) and its slope (m,) at the joint fit."""
    j = point.columns.index(slot)
    value = float(point.beta[slot] + step[j] - problem.origin[slot])
    return value, point.data.A[:, j, j], point.data.b[:, j] - point.data.A[:, j] @ step


def _sized(problem: Problem, point: Point, named: Named) -> list[int]:
    """Slots of a cause that have a size: not those that only place it (an onset), nor one that rests at nothing, nor what wanders by nature."""
    wanders = named.hypothesis.effect.wanders
    return [s for s in named.hypothesis.slots if not wanders and point.beta[s] != problem.origin[s] and not places(problem, s)]


def _windows(problem: Problem, point: Point, step: Array, named: Named) -> float:
    """From window to window, the worst of the cause's sized parameters."""
    found = [0.0]
    for slot in _sized(problem, point, named):
        value, A, b = _windowed(problem, point, step, slot)
        about = b - A * b.sum() / max(float(A.sum()), 1e-300)  # its mean, which on a bound is not zero
        own = Products(A[:, None, None], about[:, None], point.data.c, (slot,))
        found += [_varies(own, share * value, problem.inflation) for share in SHARES]
    return max(found)


def _moments(problem: Problem, point: Point, step: Array, named: Named) -> float:
    """From moment to moment, the thrust of the thruster that the cause sits in; 0 for other causes."""
    vehicle, target = problem.plant.vehicle, named.hypothesis.name.partition("[")[2].rstrip("]")
    if target not in vehicle.thrusters:
        return 0.0
    unit, parts = list(vehicle.thrusters).index(target), []
    for part, one in zip(problem.parts, point.linear, strict=True):
        wrench = np.outer(part.plant.thrust(part.driven.inputs.speed)[:, unit], allocation(vehicle)[:, unit])
        bank = np.stack([on[:, None] * wrench for on in pieces(part)])
        left = np.where(part.ok, one.r - one.S @ step, 0.0)
        varied = replace(one, r=left, S=answered(part, point.beta, bank), columns=tuple(range(len(bank))))
        parts.append(products(varied, part.ok, problem.white, spread(part)))
    return max(_varies(joined(parts), share, problem.inflation) for share in SHARES)


def _varies(data: Products, size: float, inflation: float) -> float:
    """Twice the log Bayes factor of each window's own normal departure of standard deviation ``size`` in every column, over none."""
    ridge = inflation / size**2 * np.eye(data.A.shape[-1])
    H = data.A + ridge
    explained = np.einsum("wi,wi->", data.b, np.linalg.solve(H, data.b[..., None])[..., 0]) / inflation
    return float(explained - (np.linalg.slogdet(H)[1] - np.linalg.slogdet(ridge)[1]).sum())
