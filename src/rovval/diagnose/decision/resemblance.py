"""Resemblance: what looks like a cause and is none, told by how much of the gap is left on held-out windows with it.

A comparison of models does not show it: of models that are all wrong one is the best. Two things look like causes of the library. What the library lacks
mostly resembles something of it (`LIBRARY_ALIKE`). It then closes some part of the gap, any part alike, where causes whose equations are nearly right close
most of it: the share of the gap that is left is uniform, or beta distributed about `CAUSES_LEAVE` and densest at nothing. And what the equations of causes
are off by may look like one more cause (`FORM_ALIKE`). It closes next to nothing of what the others leave of windows that it was not fitted to, while a cause
of its own closes any part of it: here the share that is left is beta distributed about `FORM_LEAVES` and densest at all of it, or uniform.

Shares are of the errors above the noise of the sensors, of the dynamics alone, which causes that push the vehicle close, and with the parity residuals, which
faults of sensors close. A cause is judged by the one of the two that it closes more of, and with the best of the sets that it was fitted in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import CAUSES_LEAVE, FORM_ALIKE, FORM_LEAVES, LIBRARY_ALIKE, PRIOR_CAUSES, PRIOR_SOMETHING_ELSE
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.shrinkage import explainable_left
from rovval.diagnose.problem.problem import Problem, gap_equations_at
from rovval.diagnose.search.model import Model, Names

Left = Mapping[Names, Array]  # (2,) share of the gap that each set of causes leaves on held-out windows: of the dynamics alone, and with parity residuals

NOTHING_LEFT = 1e-3  # share of the gap: rounding of a ratio to what is left


def gap_left(problem: Problem, models: Iterable[Model]) -> dict[Names, Array]:
    """What each set of causes that was fitted leaves (2,); of several fits of a set, the least."""
    fits = [(m.names, np.array([m.fit.dynamics_loss.sum(), m.fit.loss.sum()])) for m in models if m.fit]
    found = dict[Names, Array]()
    for (names, _), share in zip(fits, explainable_left(problem, [losses for _, losses in fits]), strict=True):
        found[names] = np.minimum(np.maximum(share, NOTHING_LEFT), found.get(names, np.inf))
    return found


def gap_left_from(problem: Problem, late: HypothesisFit, time: float) -> Array:
    """The same (2,) of causes that are at work from ``time`` (s since the run's start) on, fitted to the windows from there on; what the windows before lack
    is left."""
    before = np.concatenate([part.start * part.run.dt < time for part in problem.runs])
    dynamics, total = gap_equations_at(problem, late.beta, ())
    losses = [np.where(before, gap.c, found.c).sum() for gap, found in ((problem.gap.dynamics, dynamics), (problem.gap.total, total))]
    return np.maximum(explainable_left(problem, [np.array(losses)])[0], NOTHING_LEFT)


def none_of_the_library(names: Names, left: Left) -> float:
    """Probability that what looks like the causes ``names`` is none of the library; by the priors alone where nothing is known of what they leave."""
    odds = LIBRARY_ALIKE * PRIOR_SOMETHING_ELSE / sum(PRIOR_CAUSES)
    right = 1.0
    if left:
        share = float(_least_left(left, lambda part: part <= names).min())
        freedom = 1.0 / CAUSES_LEAVE - 1.0  # Beta(1, b), of mean 1 / (1 + b)
        right = freedom * (1.0 - min(1.0, share)) ** (freedom - 1.0)
    return odds / (odds + right)


def form_error(name: str, names: Names, left: Left) -> float:
    """Probability that the cause ``name`` of ``names`` is the form error of the others; by the priors alone where nothing is known of what they leave."""
    odds = FORM_ALIKE * PRIOR_CAUSES[len(names) - 2] / PRIOR_CAUSES[len(names) - 1]
    if left:
        beyond = left_beyond(name, names, left)
        if beyond >= 1.0:
            return 1.0
        freedom = FORM_LEAVES / (1.0 - FORM_LEAVES)  # Beta(a, 1), of mean a / (a + 1)
        odds *= freedom * beyond ** (freedom - 1.0)
    return odds / (odds + 1.0)


def left_beyond(name: str, names: Names, left: Left) -> float:
    """Share (1) that the cause ``name`` of ``names`` leaves of what the others leave of the gap; above 1 where it adds to it."""
    own = _least_left(left, lambda part: name in part and part <= names)
    others = _least_left(left, lambda part: name not in part and part <= names)
    return float((own / others).min())


def _least_left(left: Left, which: Callable[[Names], bool]) -> Array:
    """The least (2,) that is left by the sets ``which``; all of the gap where there is none."""
    shares = [share for part, share in left.items() if which(part)]
    return np.min(shares, axis=0) if shares else np.ones(2)
