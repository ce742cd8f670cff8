"""How far the gap shrinks with effects added: in all and per axis, on windows that the parameters were not fitted on.

Every window is scored with the parameters that the other folds give, in the model linearised about the fitted point, as the held-out
losses of `confirm` are; intervals are 90 % block bootstraps over windows.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.bootstrap import interval
from rovval.diagnose.inference.gap import axis_squares, noise_loss
from rovval.diagnose.inference.hypothesis_fit import Confirmed, held_steps
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.residuals.normal_equations import start_corrected
from rovval.diagnose.residuals.sensitivities import Linear, linearise, state_spread

HARM = 0.05  # an axis that gets this much worse is named (research E.7)
NONE = {"total": 0.0, "low": 0.0, "high": 0.0, "of_explainable": 0.0, "axes": {}, "axes_interval": {}, "held_out": True}


def shrinkage(problem: Problem, fitted: Confirmed | None, before: list[Array], seed: int) -> dict[str, Any]:
    """1 - gap(with effects) / gap(nominal), with the share of what lies above the noise floor and the same for each measured axis.

    ``before`` are the nominal vehicle's residuals, as `problem.corrected_residuals` gives them.
    """
    if fitted is None:
        return dict(NONE)
    return told(problem, fitted.dynamic_loss, held_out(problem, fitted), before, seed)


def told(problem: Problem, loss: Array, after: list[Array], before: list[Array], seed: int) -> dict[str, Any]:
    """The shrinkage of held-out losses (m,) and residuals ``after`` over the nominal vehicle's ``before``."""
    value, low, high = interval(problem.gap.c, loss, seed)
    nominal, now = axis_squares(problem, before), axis_squares(problem, after)
    measured = {axis: square > 0 for axis, square in nominal.items() if square.sum() > 0}
    axes = {axis: interval(nominal[axis][seen], now[axis][seen], seed) for axis, seen in measured.items()}
    return {
        "total": value,
        "low": low,
        "high": high,
        "of_explainable": _explainable(problem, loss),
        "axes": {axis: share for axis, (share, _, _) in axes.items()},
        "axes_interval": {axis: {"low": bottom, "high": top} for axis, (_, bottom, top) in axes.items()},
        "held_out": True,
    }


def harm(shrunk: dict[str, Any]) -> list[dict[str, Any]]:
    """Axes that get more than `HARM` worse with the effects added."""
    return [{"axis": axis, "change": -share} for axis, share in shrunk["axes"].items() if share < -HARM]


def held_out(problem: Problem, fitted: Confirmed) -> list[Array]:
    """Residual (m, n, c) of each run's windows with the parameters that the other folds give, best initial states taken out."""
    moved = held_linear(problem, fitted)
    return [start_corrected(one, part.ok, problem.variance, state_spread(part)) for part, one in zip(problem.parts, moved, strict=True)]


def held_linear(problem: Problem, fitted: Confirmed) -> list[Linear]:
    """Each run linearised about the fitted point, its residual moved to what the folds without the window give."""
    step = np.zeros((problem.blocks, len(fitted.slots)))
    for fold, own in held_steps(problem, fitted):
        step[fold.test] = own
    ends = np.cumsum([part.count for part in problem.parts])[:-1]
    found = []
    for part, own in zip(problem.parts, np.split(step, ends), strict=True):
        one = linearise(part, fitted.beta, fitted.slots)
        found.append(replace(one, r=np.where(part.ok, one.r - np.einsum("wtck,wk->wtc", one.S, own), 0.0)))
    return found


def _explainable(problem: Problem, loss: Array) -> float:
    """Share of the gap above the noise floor that is closed, on held-out windows."""
    gap, floor = float(problem.gap.c.sum()), float(noise_loss(problem).sum())
    return float(min((gap - float(loss.sum())) / max(gap - floor, 1e-12), 1.0))
