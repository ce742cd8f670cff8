"""The open gap: what no model of a log explains, beside what noise, a vehicle within its tolerances, and its calibration leave.

Forces that nobody logged are a nuisance of every model, as large as the log shows them (`problem.disturbance`), so that the likelihood alone never calls
them too large. How large they are has a prior: small about a vehicle of which the equations are right, of any size where something else is at work. It says
how likely something else is, and nothing of which cause it is beside: the gap that the best of all models leaves open is the same for each of them.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import log

from rovval.diagnose.criteria import OPEN_GAP_ELSE, OPEN_GAP_RIGHT
from rovval.diagnose.inference.gap import calibrated_by_part, floor_losses, share_left, tolerated_gap
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem


def open_gap(problem: Problem, models: Iterable[Posterior]) -> float:
    """Squared gap that the best of ``models`` leaves, beyond noise, over what noise and tolerances are expected to make (1); 0 at least.

    It is judged in the metric of the likelihood, in which what any unlogged force can do counts for little.
    """
    left = min(share_left(problem, point) for point in models)
    return _beyond_noise(problem, left * float(problem.gap.dynamics.c.sum()))


def left_open(problem: Problem, causes: HypothesisFit) -> float:
    """Squared gap that ``causes`` leave on held-out windows, beyond noise, over what noise and tolerances are expected to make (1); 0 at least."""
    return _beyond_noise(problem, float(causes.dynamics_loss.sum()))


def _beyond_noise(problem: Problem, loss: float) -> float:
    noise = float(floor_losses(problem)[0])
    return max(0.0, (loss - noise) / (noise + tolerated_gap(problem) + sum(calibrated_by_part(problem).values())))


def evidence_of_something_else(gap: float) -> float:
    """Twice the log Bayes factor of something else over the equations that are right, by the size of an open gap (1).

    It is exponential, of mean `OPEN_GAP_RIGHT`, where they are right; else log-logistic, of median `OPEN_GAP_ELSE`, which excludes no size.
    """
    something_else = log(OPEN_GAP_ELSE) - 2.0 * log(OPEN_GAP_ELSE + gap)
    return 2.0 * (something_else + log(OPEN_GAP_RIGHT) + gap / OPEN_GAP_RIGHT)
