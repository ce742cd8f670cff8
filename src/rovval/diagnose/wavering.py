"""Whether a cause holds still: a true one has one value all through the log, the nearest relative of another effect has not.

The value that a cause's parameter would take in each window by itself is held against the one that the whole log gives; for a cause that
sits in one thruster, its thrust is let vary in each `PIECES` part of a window as well (a coupling that slips, a supply that gives way).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rovval.data import Array
from rovval.diagnose.confirm import PLACING, Confirmed
from rovval.diagnose.disturbance import pieces
from rovval.diagnose.forced import answered
from rovval.diagnose.linearise import spread
from rovval.diagnose.point import Point
from rovval.diagnose.problem import Problem
from rovval.diagnose.products import Products, joined, products
from rovval.diagnose.together import Named
from rovval.vehicle.model import allocation

SHARES = (0.1, 0.2, 0.4, 0.8)  # of the value, or of the thruster's thrust: rms by which it may vary
WANDERS = ("gyro_bias",)  # a gyro's bias wanders by nature (in-run instability of its data sheet)


def wavering(problem: Problem, final: Confirmed, named: Sequence[Named]) -> dict[str, float]:
    """Twice the log Bayes factor, for each named cause, of a value that varies normally about its mean over one that does not."""
    step = final.point.solved(final.point.curvature, final.point.slope)
    return {n.hypothesis.name: max(_windows(problem, final.point, step, n), _moments(problem, final.point, step, n)) for n in named}


def _windows(problem: Problem, point: Point, step: Array, named: Named) -> float:
    """From window to window, the worst of the cause's sized parameters; what only places a cause (an onset) is left out."""
    found, effect = [0.0], named.hypothesis.name.partition("[")[0]
    for slot in named.hypothesis.slots:
        value = float(point.beta[slot] - problem.origin[slot])
        if value and effect not in WANDERS and problem.plant.slots[slot].parameter.name not in PLACING:
            j = point.columns.index(slot)
            own = Products(point.data.A[:, j, j, None, None], (point.data.b[:, j] - point.data.A[:, j] @ step)[:, None], point.data.c, (slot,))
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
