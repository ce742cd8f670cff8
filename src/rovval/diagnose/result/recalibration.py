"""A joint recalibration: a vehicle's file that is off in many coefficients at once, tuned together with the causes that are named.

Asked only where the search ends without an explanation and healthy coefficients depart well beyond their tolerance. It is never a cause: an
effect that the library lacks, which many coefficients imitate, looks the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, replace

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.criteria import (
    FEW_WINDOWS,
    OUT_OF_TOLERANCE,
    PARAMETER_FORM_ERROR,
    RECALIBRATION_LEAST,
)
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.effort import RECALIBRATION_ROUNDS
from rovval.diagnose.inference.hypothesis_fit import (
    HypothesisFit,
    confidence_interval,
    fit_hypothesis,
    fit_quickly,
    standard_errors,
)
from rovval.diagnose.inference.identifiability import fit_identifiable, identifiable
from rovval.diagnose.inference.laplace import Posterior
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
    if not _asked(problem, selection, decision):
        return None
    progress("tuning the vehicle's departing coefficients jointly", 0.9)
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
    slots = [problem.plant.slots[s] for s in fitted.slots]
    return Recalibration(
        parameters=rows,
        beyond=beyond,
        shrinkage=Shrinkage(**asdict(shrunk)),
        held_out="runs" if len(problem.runs) > 1 and len(problem.folds) == len(problem.runs) else "windows",
        harm=tuple(AxisHarm(axis=axis, change=change) for axis, change in worsened_axes(shrunk).items()),
        fitted=tuple(s.key for s in slots if s.hypothesis not in searched),
        diagnosed=tuple(sorted(searched)),
    )


def departing(problem: Problem, point: Posterior) -> list[int]:
    """Slots of the vehicle's own coefficients that are out of tolerance at ``point`` (`OUT_OF_TOLERANCE`)."""
    off = zip(point.columns[point.effect_count :], point.standardised_departures(), strict=True)
    return [slot for slot, z in off if abs(z) > OUT_OF_TOLERANCE and _effect(problem, slot).place != "sensor"]


def _asked(problem: Problem, selection: Selection, decision: Decision) -> bool:
    """Whether something is surely at work that the causes leave unexplained, or the file is off beside them, and enough coefficients depart."""
    rest, point = decision.unexplained, decision.fit.posterior if decision.fit else selection.healthy
    left = rest is not None and rest.accounted is None
    off = decision.probabilities.off_beside(frozenset(h.name for h in decision.causes))
    if not (left or off) or problem.window_count < FEW_WINDOWS:
        return False
    return len(departing(problem, point)) >= RECALIBRATION_LEAST


def _fitted(problem: Problem, selection: Selection, decision: Decision) -> HypothesisFit | None:
    """The joint fit of the named causes and of the coefficients beyond tolerance, until no other that these logs determine is."""
    final = decision.fit
    causes = final.slots if final else ()
    point, beta = final.posterior if final else selection.healthy, selection.healthy.beta.copy()
    beta[list(causes)] = point.beta[list(causes)]
    near, free, refused = replace(selection.healthy, beta=beta), tuple[int, ...](), set[int]()
    for _ in range(RECALIBRATION_ROUNDS):
        more = [s for s in departing(problem, point) if s not in refused and not _effect(problem, s).searched]
        able, out = identifiable(problem, (*free, *more))
        refused |= out.keys()
        if set(able) == set(free):
            break
        free = able
        point = fit_quickly(problem, near.beta, (*causes, *free), near.whitened).posterior
    rough = fit_identifiable(problem, (*causes, *free), near, causes).fit
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
