"""Constancy of a cause: a true cause has mostly one size all through the log, the nearest relative of another effect has not.

The model in which the size of a cause varies from window to window about its mean (a hierarchical model; Gelman and Hill 2007, chapter 11) stands beside
the one in which it is constant. A constant cause that is only nearly right hardly ever varies so (of some 70 right causes on three plants, three did).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.diagnose.criteria import VARIATIONS
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem


def variation(problem: Problem, point: Posterior, causes: Sequence[Hypothesis]) -> float:
    """Twice the log Bayes factor of the model in which one of the causes fitted at ``point`` varies over that in which all are constant, which cause and by
    how much integrated over; minus infinity where all wander by nature or are of a sensor, whose faults the parity residuals show."""
    found = [_varies(problem, point, h, share) for h in causes if not (h.effect.wanders or h.effect.place == "sensor") for share in VARIATIONS]
    return 2.0 * float(np.logaddexp.reduce(0.5 * np.array(found)) - np.log(len(found))) if found else -np.inf


def _varies(problem: Problem, point: Posterior, h: Hypothesis, share: float) -> float:
    """The same for one cause of which the response in each window is multiplied by a normal factor of mean 1 and standard deviation ``share``.

    The factor is a nuisance of each window, integrated out (Woodbury identity).
    """
    at = [i for i, slot in enumerate(point.columns) if slot in h.slots]
    step = point.solve(point.curvature, point.descent)
    size = np.zeros(len(point.columns))
    size[at] = point.departure[at] + step[at]
    A, b, D = point.total.A, point.total.b, problem.tempering
    response = A @ size
    power, along = response @ size / D, b @ size
    weight = 1.0 / (D / share**2 + response @ size)
    H = point.curvature - np.einsum("wk,w,wl->kl", response, weight, response)
    slope = point.descent - (response * (weight * along)[:, None]).sum(axis=0)
    explained = float(slope @ point.solve(H, slope)) + float((weight * along**2).sum())
    before = float(point.descent @ step)
    volume = np.linalg.slogdet(H)[1] - np.linalg.slogdet(point.curvature)[1]
    return (explained - before) / D - float(volume) - float(np.log1p(share**2 * power).sum())
