"""Identifiability: which parameters logs can determine, by the covariance of the linearised fit (Ljung 1999, chapter 4), and their joint fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import CORRELATED, WIDEST_INTERVAL
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


def seen_together(names: Sequence[str], correlation: Array) -> tuple[tuple[str, str, float], ...]:
    """Pairs of names that logs show together only, by their ``correlation`` (k, k), the closest first: the later name, the earlier, and that."""
    pairs = [(names[i], names[j], float(correlation[i, j])) for i in range(len(names)) for j in range(i)]
    return tuple(sorted((p for p in pairs if abs(p[2]) >= CORRELATED), key=lambda p: -abs(p[2])))


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
    """The joint fit of ``slots``. One that these logs do not determine, its interval at the fitted point wider than `WIDEST_INTERVAL` and about the file's
    value, is put back to that, and the rest is fitted again.

    With ``near`` a quick fit that begins there and keeps its sensitivities to coefficients within tolerance; slots ``kept`` are fitted whatever
    their interval.
    """
    out = dict[int, Unidentified]()
    while slots:
        fitted = fit_hypothesis(problem, problem.origin, slots) if near is None else fit_quickly(problem, near.beta, slots, near.whitened)
        at, half = fitted.beta[list(slots)], _half_intervals(problem, fitted)
        differs = np.abs(at - problem.origin[list(slots)]) > half
        size = half / [problem.plant.slots[s].parameter.typical for s in slots]
        size[differs | np.isin(slots, kept)] = 0.0
        if size.max() <= WIDEST_INTERVAL:
            return IdentifiableFit(fitted, at - half, at + half, out)
        worst = slots[int(size.argmax())]
        out[worst] = _why(problem, fitted, worst, float(size.max()))
        slots = tuple(s for s in slots if s != worst)
    return IdentifiableFit(None, np.zeros(0), np.zeros(0), out)


def _why(problem: Problem, fitted: HypothesisFit, slot: int, size: float) -> Unidentified:
    """Why a slot is not determined whose interval is +- ``size`` typical sizes: not even with all others held, or while they move."""
    others = [s for s in fitted.slots if s != slot]
    alone = float(_half_intervals(problem, fitted, others)[fitted.slots.index(slot)]) / problem.plant.slots[slot].parameter.typical
    if alone > WIDEST_INTERVAL:
        return Unidentified(f"not excited: its 90 % interval by itself is +-{alone:.1f} typical sizes")
    said = f"not told apart: its 90 % interval while the others move is +-{size:.1f} typical sizes"
    return confused_with(problem, slot, (*others, *(s for s in problem.tolerance.sd if s not in others)), said)


def _half_intervals(problem: Problem, fitted: HypothesisFit, fixed: Sequence[int] = ()) -> Array:
    """Half of the 90 % interval (k,) of each fitted slot, in its unit, where slots ``fixed`` are as they are."""
    return np.array([confidence_interval(0.0, float(e), problem.window_count)[1] for e in standard_errors(problem, fitted, fixed)])
