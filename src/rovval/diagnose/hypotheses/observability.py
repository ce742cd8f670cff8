"""Which hypotheses a log can show: an effect that would not show at a typical size is not called absent, and one that would not show
though it were large does not compete."""

from __future__ import annotations

import numpy as np

from rovval.diagnose.criteria import FEW_WINDOWS, LARGE_SIZE, OBSERVABLE_SIGMA, PRIOR_WIDTH
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.problem.problem import Problem


def observable(problem: Problem, library: list[Hypothesis]) -> tuple[list[Hypothesis], dict[str, str]]:
    """(Hypotheses that compete, reason by name of those that this log does not show at a typical size).

    An effect's signal-to-noise ratio is the square root of the Fisher information that the log holds on a typical size of its parameters, one at a
    time, divided by the design effect; of several initial points the best counts.
    """
    information = np.einsum("wii->i", problem.likelihood.total.A) / problem.design_effect
    place = {column: i for i, column in enumerate(problem.likelihood.total.columns)}
    sigmas: dict[str, float] = {}
    for h in library:
        typical = [sd / PRIOR_WIDTH for sd in h.sd]
        strength = sum(information[place[c]] * t**2 for c, t in zip(h.columns, typical, strict=True))
        sigmas[h.name] = max(sigmas.get(h.name, 0.0), float(np.sqrt(strength)))
    unseen = {
        name: f"not excited: a typical size would show with {sigma:.1f} standard errors in this log, {OBSERVABLE_SIGMA:g} are needed"
        for name, sigma in sigmas.items()
        if sigma < OBSERVABLE_SIGMA
    }
    largest = LARGE_SIZE if problem.window_count >= FEW_WINDOWS else 1.0
    return [h for h in library if largest * sigmas[h.name] >= OBSERVABLE_SIGMA], unseen
