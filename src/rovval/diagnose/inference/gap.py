"""How large the gap is: per axis rms, integral absolute error and noise floor, and how each shrinks with an effect added."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.windows.windows import axis_channels

ANGULAR = ("roll", "pitch", "yaw")


def squared_errors(problem: Problem, residuals: Sequence[Array]) -> dict[str, Array]:
    """Sum of squared errors of each measured axis in every window, all runs behind one another (m,)."""
    found: dict[str, list[Array]] = {}
    for part, error in zip(problem.runs, residuals, strict=True):
        for axis, channel in axis_channels(part).items():
            found.setdefault(axis, []).append(np.where(part.ok[..., channel], error[..., channel] ** 2, 0.0).sum(axis=1))
    return {axis: np.concatenate(values) for axis, values in found.items()}


def axis_table(problem: Problem, residuals: Sequence[Array]) -> dict[str, dict[str, object]]:
    """The ``gap.axes`` table: rms, iae, noise floor and share of the weighted gap of each measured axis."""
    rows: dict[str, dict[str, object]] = {}
    weight = weighted_errors(problem, residuals)
    total = sum(weight.values()) or 1.0
    for axis, channel in axis_channels(problem.runs[0]).items():
        error = np.concatenate([r[..., channel][p.ok[..., channel]] for r, p in zip(residuals, problem.runs, strict=True)])
        floor = float(np.mean([p.noise[channel] for p in problem.runs]))
        name = problem.runs[0].channels[channel]
        pose = name in ("x", "y", "z", "phi", "theta", "psi")
        unit = ("rad" if axis in ANGULAR else "m") if pose else ("rad/s" if axis in ANGULAR else "m/s")
        rows[axis] = {
            "unit": unit,
            "channel": name,
            "rms": float(np.sqrt(np.mean(error**2))),
            "iae": float(np.abs(error).sum() * problem.runs[0].run.dt),
            "floor_rms": floor,
            "share": weight[axis] / total,
        }
    return rows


def weighted_errors(problem: Problem, residuals: Sequence[Array]) -> dict[str, float]:
    """Each axis's part of the gap in the metric of the contest (roll and pitch with their angles)."""
    weight: dict[str, float] = {}
    for part, error in zip(problem.runs, residuals, strict=True):
        scaled = np.where(part.ok, error**2 / problem.gap.variance, 0.0).sum(axis=(0, 1))
        for axis, value in zip(part.axes, scaled, strict=True):
            weight[axis] = weight.get(axis, 0.0) + float(value)
    return weight


def noise_floor_loss(problem: Problem) -> Array:
    """What white sensor noise alone contributes to each window's loss (m,): the floor of the explainable part."""
    share = [np.where(p.ok, p.noise**2 / problem.gap.variance, 0.0).sum(axis=(1, 2)) for p in problem.runs]
    return np.concatenate(share)
