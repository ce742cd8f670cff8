"""A joint recalibration: a vehicle's file that is off in many coefficients at once, tuned together with the causes that are named.

Asked only where the causes are not all of the answer. The numbers are those that a file that is off has in the comparison of models
(`decision.miscalibration`). It is never a cause: an effect that the library lacks, which many coefficients imitate, looks the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, replace

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.criteria import (
    FEW_WINDOWS,
    PARAMETER_FORM_ERROR,
    RECALIBRATION_LEAST,
)
from rovval.diagnose.decision.miscalibration import numbers_off
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.inference.hypothesis_fit import (
    HypothesisFit,
    confidence_interval,
    fit_hypothesis,
    standard_errors,
)
from rovval.diagnose.inference.identifiability import fit_identifiable
from rovval.diagnose.inference.shrinkage import refitted_shrinkage, shrinkage, worsened_axes
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.result.diagnosis import AxisHarm, Coefficient, Recalibration, Shrinkage
from rovval.diagnose.search.forward import Selection
from rovval.effects import Effect


def recalibration(
    problem: Problem,
    selection: Selection,
    decision: Decision,
    before: list[Array],
    tolerance: float,
    seed: int,
    progress: Callable[[str, float], None],
) -> Recalibration | None:
    """The coefficients tuned jointly, and how far the gap shrinks on data that they were not fitted to.

    None where it is not asked, or where the interval of its shrinkage does not stay above what the causes close. ``before`` are the nominal simulator's
    residuals, ``tolerance`` is relative.
    """
    causes = decision.fit.slots if decision.fit else ()
    if not _asked(problem, decision):
        return None
    progress("tuning the numbers of the file that are off jointly", 0.9)
    fitted = _fitted(problem, selection, decision)
    if fitted is None:
        return None
    rows = _coefficients(problem, fitted, causes)
    beyond = tuple(name for name, row in rows.items() if row.beyond)
    if len(beyond) < RECALIBRATION_LEAST:
        return None
    progress("fitting them anew without the windows that they are scored on", 0.95)
    shrunk = refitted_shrinkage(problem, fitted, before, tolerance, seed)
    by_causes = max(shrinkage(problem, decision.fit, before, seed).total, 0.0)
    if shrunk.low <= by_causes:
        return None
    searched = {problem.plant.slots[s].hypothesis for s in fitted.slots if _effect(problem, s).searched}
    tuned = [s for s in fitted.slots if problem.plant.slots[s].hypothesis not in searched]
    return Recalibration(
        parameters=rows,
        beyond=beyond,
        shrinkage=Shrinkage(**asdict(shrunk)),
        held_out="runs" if len(problem.runs) > 1 and len(problem.folds) == len(problem.runs) else "windows",
        harm=tuple(AxisHarm(axis=axis, change=change) for axis, change in worsened_axes(shrunk).items()),
        fitted=tuple(problem.plant.slots[s].key for s in tuned),
        diagnosed=tuple(sorted(searched)),
    )


def _asked(problem: Problem, decision: Decision) -> bool:
    """Whether something is at work that no cause which is named explains: the verdict is unknown, or causes leave something, or the file is likelier off
    beside them than not."""
    if problem.window_count < FEW_WINDOWS or decision.verdict == "no_gap":
        return False
    off = decision.probabilities.off_beside(frozenset(h.name for h in decision.causes))
    return not decision.causes or decision.unexplained is not None or off


def _fitted(problem: Problem, selection: Selection, decision: Decision) -> HypothesisFit | None:
    """The joint fit of the named causes and of the numbers of the file that are off beside them, those that these logs determine; None without."""
    final = decision.fit
    causes = final.slots if final else ()
    point = final.posterior if final else selection.healthy
    off = numbers_off(problem, selection, point, len(decision.causes))
    slots = [s for s in off.slots if _effect(problem, s).place != "sensor" and not _effect(problem, s).searched] if off else []
    if len(slots) < RECALIBRATION_LEAST:
        return None
    beta = selection.healthy.beta.copy()
    beta[list(causes)] = point.beta[list(causes)]
    rough = fit_identifiable(problem, (*causes, *slots), replace(selection.healthy, beta=beta), causes).fit
    return fit_hypothesis(problem, rough.posterior.beta, rough.slots) if rough else None


def _coefficients(problem: Problem, fitted: HypothesisFit, causes: Sequence[int]) -> dict[str, Coefficient]:
    """Every tuned parameter, the largest departure first; those of the named causes, which are no matter of the file, last."""
    rows, error = dict[str, Coefficient](), standard_errors(problem, fitted)
    for slot, se in zip(fitted.slots, error, strict=True):
        p, value, was = problem.plant.slots[slot].parameter, float(fitted.beta[slot]), float(problem.origin[slot])
        low, high = confidence_interval(value, float(np.hypot(se, PARAMETER_FORM_ERROR * abs(value - was))), problem.window_count)
        low, high, tolerance = max(low, p.low), min(high, p.high), problem.tolerance.sd.get(slot)
        rows[problem.plant.slots[slot].key] = Coefficient(
            value=value, low=low, high=high, unit=p.unit, was=was, tolerance=tolerance,
            departure=None if tolerance is None else (value - was) / tolerance,
            beyond=tolerance is not None and slot not in causes and not low - tolerance <= was <= high + tolerance,
            at_bound=slot in fitted.at_bound, of_cause=slot in causes,
        )  # fmt: skip
    return dict(sorted(rows.items(), key=lambda item: (item[1].of_cause, -abs(item[1].departure or 0.0))))


def _effect(problem: Problem, slot: int) -> Effect:
    return effects.load(problem.plant.slots[slot].effect)
