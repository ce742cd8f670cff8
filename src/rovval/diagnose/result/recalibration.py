"""No one effect, but a vehicle's file that is off in many coefficients at once: they are tuned together, with the causes that are named.

Asked only where the search ends without an explanation and healthy coefficients are strained well beyond their tolerance. It is never a
cause: an effect that the library lacks, which many coefficients imitate, looks the same.
"""

from __future__ import annotations

import shlex
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.criteria import FEW_WINDOWS
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.inference.hypothesis_fit import Confirmed, confirm, errors, interval, roughly
from rovval.diagnose.inference.identifiability import determinable, tuned
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.prior import STRAINED, WITHIN
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.inference.refit import shrinkage_refitted
from rovval.diagnose.inference.shrinkage import harm, shrinkage
from rovval.diagnose.result.causes import FORM
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.search.joint import LATER_GAIN
from rovval.fit.tunable import is_searched

ROUNDS = 6  # of setting strained coefficients free, which may strain others
LEAST = 3  # strained coefficients: one or two are what an effect of the library, or its nearest relative, leaves (chosen)
BEYOND = 1.0  # tolerances: a coefficient whose whole interval is further off is surely beyond what a healthy file has


def calibration(
    problem: Problem, selection: Selection, decision: Decision, before: list[Array], slop: float, seed: int, progress: Callable[[str, float], None]
) -> dict[str, Any] | None:
    """The coefficients tuned together and how far the gap shrinks where it was not fitted; None where it is not asked, or not shown to be more
    than the named causes do by as much as a further cause has to add. ``before`` are the nominal vehicle's residuals."""
    point = decision.fit.point if decision.fit else selection.healthy
    rest = decision.unexplained
    if rest is None or rest.accounted is not None or problem.blocks < FEW_WINDOWS or len(strained(problem, point, STRAINED)) < LEAST:
        return None
    progress("tuning the strained coefficients of the vehicle's file together", 0.9)
    fitted = _fitted(problem, selection, decision)
    if fitted is None:
        return None
    rows = _rows(problem, fitted, decision.fit.slots if decision.fit else ())
    beyond = [name for name, row in rows.items() if row["beyond"]]
    if len(beyond) < LEAST:
        return None
    progress("fitting it anew without the windows that it is scored on", 0.95)
    shrunk = shrinkage_refitted(problem, fitted, before, slop, seed)
    named = max(shrinkage(problem, decision.fit, before, seed)["total"], 0.0)
    if shrunk["low"] <= named + LATER_GAIN * (1.0 - named):
        return None
    held = "runs" if len(problem.parts) > 1 and len(problem.folds) == len(problem.parts) else "windows"
    return {"parameters": rows, "beyond": beyond, "shrinkage": shrunk, "held_out": held, "harm": harm(shrunk), "command": command(problem, fitted)}


def strained(problem: Problem, point: Point, limit: float) -> list[int]:
    """Slots of the vehicle's own coefficients that are ``limit`` tolerances off where effects and slop settled."""
    off = zip(point.columns[point.own :], point.sigmas(), strict=True)
    return [slot for slot, z in off if abs(z) > limit and _of_vehicle(problem, slot)]


def command(problem: Problem, fitted: Confirmed) -> str:
    """The `rovval fit` that writes this vehicle, with the runs' ids; what fit does not search for is written by `diagnose` first."""
    slots, plant = problem.plant.slots, problem.plant
    found = sorted({slots[s].hypothesis for s in fitted.slots if is_searched(plant, s)})
    names = ",".join(slots[s].key for s in fitted.slots if slots[s].hypothesis not in found)
    logs = " ".join(shlex.quote(part.run.id) for part in problem.parts)
    model = "" if plant.model == "fossen" else f" --model {plant.model}"
    first = f"rovval diagnose {logs} --vehicle {plant.vehicle.name}{model} --write-vehicle mended.toml && " if found else ""
    start = "mended.toml" if found else plant.vehicle.name
    return f"{first}rovval fit {logs} --vehicle {start}{model} --parameters {shlex.quote(names)} --out calibrated.toml"


def _fitted(problem: Problem, selection: Selection, decision: Decision) -> Confirmed | None:
    """The joint fit of the named causes and of the coefficients beyond tolerance, until no other that these logs determine is."""
    final = decision.fit
    causes = final.slots if final else ()
    point, beta = final.point if final else selection.healthy, selection.healthy.beta.copy()
    beta[list(causes)] = point.beta[list(causes)]
    near, free, refused = replace(selection.healthy, beta=beta), tuple[int, ...](), set[int]()
    for _ in range(ROUNDS):
        more = [s for s in strained(problem, point, WITHIN) if s not in refused and not is_searched(problem.plant, s)]
        able, out = determinable(problem, (*free, *more))
        refused |= out.keys()
        if set(able) == set(free):
            break
        free = able
        point = roughly(problem, near.beta, (*causes, *free), near.scaled).point
    rough, *_ = tuned(problem, (*causes, *free), near, causes)
    return confirm(problem, rough.point.beta, rough.slots) if rough else None


def _rows(problem: Problem, fitted: Confirmed, causes: Sequence[int]) -> dict[str, dict[str, Any]]:
    """Every tuned parameter, the one that is most tolerances off first; the named causes' own, which are no matter of the file, last."""
    rows, error = dict[str, dict[str, Any]](), errors(problem, fitted)
    for slot, se in zip(fitted.slots, error, strict=True):
        p, value, was = problem.plant.slots[slot].parameter, float(fitted.beta[slot]), float(problem.origin[slot])
        low, high = interval(value, float(np.hypot(se, FORM * abs(value - was))), problem.blocks)
        low, high, tolerance = max(low, p.low), min(high, p.high), problem.slop.sd.get(slot)
        times = None if tolerance is None else (value - was) / tolerance
        surely = tolerance is not None and slot not in causes and not low - BEYOND * tolerance <= was <= high + BEYOND * tolerance
        rows[problem.plant.slots[slot].key] = {
            "value": value, "low": low, "high": high, "unit": p.unit, "was": was, "tolerance": tolerance, "tolerances": times,
            "beyond": surely, "at_bound": slot in fitted.at_bound, "of_cause": slot in causes,
        }  # fmt: skip
    return dict(sorted(rows.items(), key=lambda item: (item[1]["of_cause"], -abs(item[1]["tolerances"] or 0.0))))


def _of_vehicle(problem: Problem, slot: int) -> bool:
    return effects.load(problem.plant.slots[slot].effect).place != "sensor"
