"""Which parameters logs can determine, their joint fit by re-simulation, and intervals that hold under autocorrelated residuals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import IDENTIFIABLE_ALONE, IDENTIFIABLE_JOINTLY, PRIOR_WIDTH, WIDEST_INTERVAL
from rovval.diagnose.inference.hypothesis_fit import (
    HypothesisFit,
    confidence_interval,
    fit_hypothesis,
    fit_quickly,
    standard_errors,
)
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.coherence import coherence


def identifiable(problem: Problem, wanted: Sequence[int]) -> tuple[tuple[int, ...], dict[int, dict[str, Any]]]:
    """Which slots these logs can determine, and why not the others; the least determined leaves first."""
    out, left = dict[int, dict[str, Any]](), list(wanted)
    information = problem.likelihood.total.A.sum(axis=0) / problem.design_effect
    typical = {s: problem.plant.slots[s].parameter.typical for s in (*wanted, *problem.tolerance.sd)}
    for slot in wanted:
        at = int(problem.likelihood.total.place((slot,))[0])
        if (seen := float(np.sqrt(information[at, at])) * typical[slot]) < IDENTIFIABLE_ALONE:
            left.remove(slot)
            why = f"not excited: a typical size would show with {seen:.1f} standard errors in these logs, {IDENTIFIABLE_ALONE:g} are needed"
            out[slot] = unidentified_row(why)
    while left:
        tolerated = [c for c in problem.tolerance.sd if c not in left]
        free = problem.likelihood.total.place((*left, *tolerated))
        prior = [PRIOR_WIDTH * typical[s] for s in left] + [problem.tolerance.sd[c] for c in tolerated]
        covariance = np.linalg.inv(information[np.ix_(free, free)] + np.diag(1.0 / np.array(prior) ** 2))
        shown = np.array([typical[s] for s in left]) / np.sqrt(np.diag(covariance)[: len(left)])
        if shown.min() >= IDENTIFIABLE_JOINTLY:
            break
        worst = left.pop(int(shown.argmin()))
        why = f"not told apart: a typical size shows with {shown.min():.1f} standard errors while the others move"
        out[worst] = confused_with(problem, worst, (*left, *tolerated), why)
    return tuple(left), out


def confused_with(problem: Problem, slot: int, others: Sequence[int], why: str) -> dict[str, Any]:
    """What a slot that is excited is confused with: tuned ones and coefficients within tolerance, by coherence; what only a start elsewhere shows (an
    onset, a period) has no signature of its own."""
    others = [s for s in others if s != slot and s in problem.likelihood.total.columns]
    beside = sorted(((problem.plant.slots[s].key, coherence(problem.likelihood.total, (slot,), (s,))) for s in others), key=lambda x: -x[1])
    named = " and ".join(f"{name} ({value:.2f})" for name, value in beside[:2])
    return unidentified_row(f"{why}; most like {named}" if named else why, beside[:2])


def fit_identifiable(
    problem: Problem, slots: tuple[int, ...], near: Posterior | None = None, kept: Sequence[int] = ()
) -> tuple[HypothesisFit | None, Array, Array, dict[int, dict[str, Any]]]:
    """The joint fit with its 90 % intervals; slots whose interval says nothing at the fitted point are put back and the rest refitted.

    With ``near``, quickly, from there and with frozen sensitivities of the tolerances there; ``kept`` are fitted whatever their interval.
    """
    out = dict[int, dict[str, Any]]()
    while slots:
        fitted = fit_hypothesis(problem, problem.origin, slots) if near is None else fit_quickly(problem, near.beta, slots, near.whitened)
        errors = standard_errors(problem, fitted)
        bounds = [confidence_interval(float(fitted.beta[s]), float(e), problem.window_count) for s, e in zip(slots, errors, strict=True)]
        low, high = np.array(bounds).T
        half = 0.5 * (high - low) / [problem.plant.slots[s].parameter.typical for s in slots]
        half[[s in kept for s in slots]] = 0.0
        if half.max() <= WIDEST_INTERVAL:
            return fitted, low, high, out
        worst = slots[int(half.argmax())]
        why = f"not told apart: its 90 % interval with slop of the others is +-{half.max():.1f} typical sizes"
        out[worst] = confused_with(problem, worst, tuple(dict.fromkeys((*slots, *problem.tolerance.sd))), why)
        slots = tuple(s for s in slots if s != worst)
    return None, np.zeros(0), np.zeros(0), out


def unidentified_row(why: str, beside: Sequence[tuple[str, float]] = ()) -> dict[str, Any]:
    """The row of a parameter that is left where it was: why, and what it is confused with."""
    return {"why": why, "with": [{"parameter": name, "coherence": value} for name, value in beside]}
