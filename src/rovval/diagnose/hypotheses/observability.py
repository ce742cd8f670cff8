"""Which hypotheses a log can show: of the others none is called absent, and those that it could not show though they were large do not compete."""

from __future__ import annotations

import numpy as np

from rovval.diagnose.criteria import FEW_WINDOWS, PRIOR_WIDTH
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.problem import Problem

LEAST_SIGMA = 3.0  # standard errors by which an effect of typical size must show (research E.6: detectability below 3 says nothing)
LARGE = 3.0  # typical sizes: an effect so large must show as much, or it does not compete (chosen); of few windows, a typical one must


def excited(problem: Problem, library: list[Hypothesis]) -> tuple[list[Hypothesis], dict[str, str]]:
    """Hypotheses of which a `LARGE` size would show in this log, and those of which a typical size would not, with the reason."""
    information = np.einsum("wii->i", problem.data.A) / problem.inflation
    place = {column: i for i, column in enumerate(problem.data.columns)}
    seen: dict[str, float] = {}
    for h in library:
        typical = [sd / PRIOR_WIDTH for sd in h.sd]
        strength = sum(information[place[c]] * t**2 for c, t in zip(h.columns, typical, strict=True))
        seen[h.name] = max(seen.get(h.name, 0.0), float(np.sqrt(strength)))
    silent = {
        name: f"not excited: a typical size would show with {sigma:.1f} standard errors in this log, {LEAST_SIGMA:g} are needed"
        for name, sigma in seen.items()
        if sigma < LEAST_SIGMA
    }
    largest = LARGE if problem.blocks >= FEW_WINDOWS else 1.0
    return [h for h in library if largest * seen[h.name] >= LEAST_SIGMA], silent
