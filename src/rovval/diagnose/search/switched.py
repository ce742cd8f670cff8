"""Causes that are at work from some moment on only: their evidence on the whole log, where they can be held against any others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.hypothesis_fit import Confirmed
from rovval.diagnose.inference.laplace import Point, whole_evidence
from rovval.diagnose.inference.map_fit import about
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.normal_equations import Products


def switched(problem: Problem, late: Confirmed, since: float, healthy: Point) -> float:
    """Twice the log evidence, over the vehicle as it is, of causes as the windows from ``since`` (s) on show them and of a healthy vehicle before.

    Coefficients and sensors that are healthy are the same all through the log; they settle from where they stand beside the causes, or from where they
    are ``healthy`` by themselves, whichever is better.
    """
    own = list(late.slots)
    beside, alone, without = late.point.beta, healthy.beta.copy(), late.point.beta.copy()
    alone[own], without[own] = beside[own], healthy.beta[own]
    starts = (beside, without), (alone, healthy.beta)
    return max(whole_evidence(problem, _from(problem, late.slots, now, then, since)) for now, then in starts)


def _from(problem: Problem, own: tuple[int, ...], now: Array, then: Array, since: float) -> Point:
    """The windows before ``since`` about ``then``, the others about ``now``. A coefficient that the causes take is one of the vehicle's own, with its
    tolerance, before they do."""
    columns = (*own, *(c for c in problem.slop.sd if c not in own))
    begun, before = about(problem, now, columns, len(own)), about(problem, then, columns, len(own))
    taken = [i for i, slot in enumerate(own) if slot in problem.slop.sd]
    k, slots = len(columns), [own[i] for i in taken]
    late, early = np.eye(k + len(taken), k), np.eye(k + len(taken), k)
    early[: len(own)] = 0.0
    early[np.arange(k, k + len(taken)), taken] = 1.0
    first = np.concatenate([part.start * part.run.dt < since for part in problem.parts])
    A = np.where(first[:, None, None], early @ before.data.A @ early.T, late @ begun.data.A @ late.T)
    b = np.where(first[:, None], before.data.b @ early.T, begun.data.b @ late.T)
    none = np.zeros(len(taken))
    return replace(
        begun,
        columns=(*columns, *slots), data=Products(A, b, np.where(first, before.data.c, begun.data.c), (*columns, *slots)),
        precision=np.concatenate([begun.precision, [problem.inflation / problem.slop.sd[s] ** 2 for s in slots]]),
        offset=np.concatenate([begun.offset, (then - problem.origin)[slots]]),
        side=np.concatenate([begun.side, none]), still=np.concatenate([begun.still, none > 0]),
    )  # fmt: skip
