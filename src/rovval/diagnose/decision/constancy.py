"""Constancy of a cause: a true cause has one size all through the log, the nearest relative of what the library lacks has not.

Beside the model in which the size of a cause is constant stand those in which it varies: from window to window about its mean (a hierarchical model; Gelman
and Hill 2007, chapter 11), or with something that was logged (`dependence`). By a little, it is that cause in another form than its equation here; by much, it
is something else that only comes near to it (`VARIATIONS`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import log

import numpy as np

from rovval.diagnose.criteria import VARIATIONS
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import only_places
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.search.dependence import dependence


@dataclass(frozen=True, slots=True)
class Variation:
    """How much likelier it is that the size of one of some causes varies than that all are constant, as twice a log Bayes factor; with what it varies is
    integrated over.

    Attributes:
        form: the size of any of them varies by as much as the form of an equation is off (`VARIATIONS`, the first); minus infinity where none could.
        alike: that of each cause varies by as much as only something else does (the second), which of them it is integrated over too.
        goes_with: (cause, covariate) that one most likely varies with by that much; None where it varies from window to window, or not at all.
    """

    form: float = -np.inf
    alike: Mapping[str, float] = field(default_factory=dict)
    goes_with: tuple[str, str] | None = None

    @property
    def either(self) -> float:
        """That one varies by the one or the other."""
        return 2.0 * float(np.logaddexp.reduce(0.5 * np.array([self.form, *self.alike.values()])) - np.log(2.0))


def variation(problem: Problem, point: Posterior, causes: Sequence[Hypothesis]) -> Variation:
    """The variation of causes fitted at ``point``. A cause that wanders by nature is no less likely where it does; what a sensor's fault does from window to
    window the parity residuals show."""
    still = [h for h in causes if not h.effect.wanders]
    logged = dependence(problem, point, still)
    little, much = (dict(zip(logged.names, logged.alone(share).tolist(), strict=True)) if logged else {} for share in VARIATIONS)
    form, alike = (_of_each(problem, point, still, share, along) for share, along in zip(VARIATIONS, (little, much), strict=True))
    largest = max(much, key=lambda name: much[name], default=None)
    return Variation(_sum(form.values()), alike, largest if largest and much[largest] > 0.0 else None)


def _of_each(problem: Problem, point: Posterior, causes: Sequence[Hypothesis], share: float, along: Mapping[tuple[str, str], float]) -> dict[str, float]:
    """Evidence that the size of each cause is the one that varies by ``share``, from window to window or ``along`` one covariate."""
    found = dict[str, float]()
    for h in causes:
        ways = [evidence for (name, _), evidence in along.items() if name == h.name]
        ways += [_varies(problem, point, h, share)] if h.effect.place != "sensor" else []
        if ways:
            found[h.name] = _mean(ways) - 2.0 * log(len(causes))
    return found


def _sum(evidence: Iterable[float]) -> float:
    """Evidence of any of several models, the prior of each counted."""
    return 2.0 * float(np.logaddexp.reduce(0.5 * np.array([-np.inf, *evidence])))


def _mean(evidence: Sequence[float]) -> float:
    """Evidence of any of several models that are as likely as each other beforehand."""
    return _sum(evidence) - 2.0 * log(len(evidence))


def _varies(problem: Problem, point: Posterior, h: Hypothesis, share: float) -> float:
    """Evidence that the response to one cause in each window is multiplied by a normal factor of mean 1 and standard deviation ``share``.

    The factor is a nuisance of each window, integrated out (Woodbury identity).
    """
    at = [i for i, slot in enumerate(point.columns) if slot in h.slots and not only_places(problem, slot)]
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
