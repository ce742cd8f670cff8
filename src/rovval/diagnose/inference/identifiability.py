"""Identifiability: which parameters logs can determine, by the covariance of the linearised fit (Ljung 1999, chapter 4), and their joint fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import IDENTIFIABLE_JOINTLY, OBSERVABLE_SIGMA, PRIOR_WIDTH, WIDEST_INTERVAL
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


@dataclass(frozen=True, slots=True)
class Unidentified:
    """Why logs do not determine a parameter.

    Attributes:
        why: the reason in words.
        beside: the parameters that it is most confused with, each with the coherence of the two sensitivities.
    """

    why: str
    beside: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, slots=True)
class IdentifiableFit:
    """A joint fit of the parameters that logs determine.

    Attributes:
        fit: the fit; None where no parameter is left.
        low, high: 90 % interval of each fitted slot (k,), in the parameter's unit.
        unidentified: the others, by slot.
    """

    fit: HypothesisFit | None
    low: Array
    high: Array
    unidentified: dict[int, Unidentified]


def identifiable(problem: Problem, wanted: Sequence[int]) -> tuple[tuple[int, ...], dict[int, Unidentified]]:
    """Which of the slots ``wanted`` these logs can determine, and why not the others.

    First each by itself (`OBSERVABLE_SIGMA`), then jointly with coefficients within tolerance, by the covariance of the linearised fit; the least
    determined is left out until all that are left are determined (`IDENTIFIABLE_JOINTLY`).
    """
    out, left = dict[int, Unidentified](), list(wanted)
    information = problem.likelihood.total.A.sum(axis=0) / problem.design_effect
    typical = {s: problem.plant.slots[s].parameter.typical for s in (*wanted, *problem.tolerance.sd)}
    for slot in wanted:
        at = int(problem.likelihood.total.place((slot,))[0])
        if (errors := float(np.sqrt(information[at, at])) * typical[slot]) < OBSERVABLE_SIGMA:
            left.remove(slot)
            why = f"not excited: a typical size would show with {errors:.1f} standard errors in these logs, {OBSERVABLE_SIGMA:g} are needed"
            out[slot] = Unidentified(why)
    while left:
        tolerated = [c for c in problem.tolerance.sd if c not in left]
        free = problem.likelihood.total.place((*left, *tolerated))
        prior = [PRIOR_WIDTH * typical[s] for s in left] + [problem.tolerance.sd[c] for c in tolerated]
        covariance = np.linalg.inv(information[np.ix_(free, free)] + np.diag(1.0 / np.array(prior) ** 2))
        errors_of = np.array([typical[s] for s in left]) / np.sqrt(np.diag(covariance)[: len(left)])
        if errors_of.min() >= IDENTIFIABLE_JOINTLY:
            break
        worst = left.pop(int(errors_of.argmin()))
        why = f"not told apart: a typical size shows with {errors_of.min():.1f} standard errors while the others move"
        out[worst] = confused_with(problem, worst, (*left, *tolerated), why)
    return tuple(left), out


def confused_with(problem: Problem, slot: int, others: Sequence[int], why: str) -> Unidentified:
    """A slot with the two of ``others`` whose sensitivities are most coherent with its own; parameters that have no sensitivity at the nominal vehicle (an
    onset, a period of an effect of no size) are passed over."""
    others = [s for s in others if s != slot and s in problem.likelihood.total.columns]
    beside = sorted(((problem.plant.slots[s].key, coherence(problem.likelihood.total, (slot,), (s,))) for s in others), key=lambda x: -x[1])
    named = " and ".join(f"{name} ({value:.2f})" for name, value in beside[:2])
    return Unidentified(f"{why}; most like {named}" if named else why, tuple(beside[:2]))


def fit_identifiable(
    problem: Problem, slots: tuple[int, ...], near: Posterior | None = None, kept: Sequence[int] = ()
) -> IdentifiableFit:
    """The joint fit of ``slots``; one whose interval at the fitted point is too wide (`WIDEST_INTERVAL`) is put back to the file's value and the rest fitted
    again.

    With ``near`` a quick fit that begins there and keeps its sensitivities to coefficients within tolerance; slots ``kept`` are fitted whatever
    their interval.
    """
    out = dict[int, Unidentified]()
    while slots:
        fitted = fit_hypothesis(problem, problem.origin, slots) if near is None else fit_quickly(problem, near.beta, slots, near.whitened)
        errors = standard_errors(problem, fitted)
        bounds = [confidence_interval(float(fitted.beta[s]), float(e), problem.window_count) for s, e in zip(slots, errors, strict=True)]
        low, high = np.array(bounds).T
        half = 0.5 * (high - low) / [problem.plant.slots[s].parameter.typical for s in slots]
        half[[s in kept for s in slots]] = 0.0
        if half.max() <= WIDEST_INTERVAL:
            return IdentifiableFit(fitted, low, high, out)
        worst = slots[int(half.argmax())]
        why = f"not told apart: its 90 % interval with tolerance of the others is +-{half.max():.1f} typical sizes"
        out[worst] = confused_with(problem, worst, tuple(dict.fromkeys((*slots, *problem.tolerance.sd))), why)
        slots = tuple(s for s in slots if s != worst)
    return IdentifiableFit(None, np.zeros(0), np.zeros(0), out)
