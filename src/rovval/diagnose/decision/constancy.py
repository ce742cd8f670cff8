"""Constancy of a cause's parameters: a true cause has one value all through the log, the nearest relative of another effect has not.

The value that a parameter would take in each window by itself is held against the one that the whole log gives; of a cause that
sits in one thruster, its thrust may vary within a window as well (a coupling that slips, a supply that gives way).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import DRIFTING_SHARE, DRIFTING_SIGMA, FEW_WINDOWS
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, only_places
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.disturbance import segment_indicators
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.external_forces import wrench_sensitivities
from rovval.diagnose.residuals.normal_equations import NormalEquations, concatenated, normal_equations
from rovval.diagnose.residuals.nuisances import nuisance_sd
from rovval.diagnose.search.baseline import SelectedCause
from rovval.vehicle.model import allocation

VARIATIONS = (0.1, 0.2, 0.4, 0.8)  # rms tried by which a value may vary, as a share of the value, or of the thruster's thrust


def variation(problem: Problem, fit: HypothesisFit, causes: Sequence[SelectedCause]) -> dict[str, float]:
    """Twice the log Bayes factor, for each cause, of a value that varies normally about its mean over one that is constant."""
    step = fit.posterior.solve(fit.posterior.curvature, fit.posterior.descent)
    return {n.hypothesis.name: max(_between_windows(problem, fit.posterior, step, n), _within_windows(problem, fit.posterior, step, n)) for n in causes}


def drifting(problem: Problem, fit: HypothesisFit, causes: Sequence[SelectedCause]) -> tuple[str, ...]:
    """Names of causes whose main parameter, the one that most windows show, surely moves by a good part of its value along the log, as the weight
    of a housing that fills does."""
    step = fit.posterior.solve(fit.posterior.curvature, fit.posterior.descent)
    found = []
    for n in causes:
        own = [_by_window(problem, fit.posterior, step, slot) for slot in _sized(problem, fit.posterior, n)]
        if own and _drifts(*max(own, key=lambda one: float(one[1].sum()) * one[0] ** 2), problem.design_effect):
            found.append(n.hypothesis.name)
    return tuple(found)


def _drifts(value: float, A: Array, b: Array, design_effect: float) -> bool:
    """Whether a line through what each window adds to a value moves it, over the windows that show it, by a good part of the value."""
    at, shown = np.arange(len(A), dtype=np.float64), np.flatnonzero(A * value**2 > design_effect)
    if len(shown) < FEW_WINDOWS:
        return False
    away = at - (A @ at) / A.sum()
    slope, information = float(b @ away) / float(A @ away**2), float(A @ away**2) / design_effect
    return abs(slope) * float(np.ptp(shown)) > DRIFTING_SHARE * abs(value) and abs(slope) * np.sqrt(information) > DRIFTING_SIGMA


def _by_window(problem: Problem, point: Posterior, step: Array, slot: int) -> tuple[float, Array, Array]:
    """A parameter's departure from the vehicle's file, and of every window its curvature (m,) and its slope (m,) at the joint fit."""
    j = point.columns.index(slot)
    value = float(point.beta[slot] + step[j] - problem.origin[slot])
    return value, point.total.A[:, j, j], point.total.b[:, j] - point.total.A[:, j] @ step


def _sized(problem: Problem, point: Posterior, cause: SelectedCause) -> list[int]:
    """Slots of a cause that have a size: not those that only place it (an onset), nor one that rests at nothing, nor what wanders by nature."""
    wanders = cause.hypothesis.effect.wanders
    return [s for s in cause.hypothesis.slots if not wanders and point.beta[s] != problem.origin[s] and not only_places(problem, s)]


def _between_windows(problem: Problem, point: Posterior, step: Array, cause: SelectedCause) -> float:
    """Evidence of variation from window to window, of the cause's sized parameter that varies most."""
    found = [0.0]
    for slot in _sized(problem, point, cause):
        value, A, b = _by_window(problem, point, step, slot)
        about = b - A * b.sum() / max(float(A.sum()), 1e-300)  # its mean, which on a bound is not zero
        own = NormalEquations(A[:, None, None], about[:, None], point.total.c, (slot,))
        found.append(variation_evidence(own, value, problem.design_effect))
    return max(found)


def _within_windows(problem: Problem, point: Posterior, step: Array, cause: SelectedCause) -> float:
    """Evidence of variation within windows of the thrust of the thruster that a cause sits in; 0 for other causes."""
    vehicle, target = problem.plant.vehicle, cause.hypothesis.target
    if target not in vehicle.thrusters:
        return 0.0
    unit, parts = list(vehicle.thrusters).index(target), []
    for part, one in zip(problem.runs, point.linear, strict=True):
        wrench = np.outer(part.plant.thrust(part.actuation.inputs.speed)[:, unit], allocation(vehicle)[:, unit])
        bank = np.stack([on[:, None] * wrench for on in segment_indicators(part)])
        left = np.where(part.ok, one.r - one.S @ step, 0.0)
        varied = replace(one, r=left, S=wrench_sensitivities(part, point.beta, bank), columns=tuple(range(len(bank))))
        parts.append(normal_equations(varied, part.ok, problem.likelihood.variance, nuisance_sd(part)))
    return variation_evidence(concatenated(parts), 1.0, problem.design_effect)


def variation_evidence(data: NormalEquations, value: float, design_effect: float) -> float:
    """Twice the log Bayes factor of a normal departure of each window's own in every column over none, at the best of the standard deviations
    `VARIATIONS`, which are shares of ``value``; 0 for a value of nothing, which is what is left of a parameter that no window shows."""
    if (VARIATIONS[0] * value) ** 2 == 0.0:
        return 0.0
    return max(_varies(data, share * value, design_effect) for share in VARIATIONS)


def _varies(data: NormalEquations, size: float, design_effect: float) -> float:
    """The same at a standard deviation of ``size``."""
    ridge = design_effect / size**2 * np.eye(data.A.shape[-1])
    H = data.A + ridge
    explained = np.einsum("wi,wi->", data.b, np.linalg.solve(H, data.b[..., None])[..., 0]) / design_effect
    return float(explained - (np.linalg.slogdet(H)[1] - np.linalg.slogdet(ridge)[1]).sum())
