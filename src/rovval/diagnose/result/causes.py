"""The causes as rows of the document: group, probability, onset, parameters with intervals, and what each shrinks the gap by alone."""

from __future__ import annotations

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.hypothesis_fit import Confirmed, errors, interval, roughly
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.inference.shrinkage import shrinkage
from rovval.diagnose.search.joint import Named

FORM = 0.10  # of a parameter's departure, one standard error: equations that are only nearly right (logs of two independent plants ask for it)
MOST_GROUP = 3  # names printed of a confusion group


def causes(problem: Problem, decision: Decision, before: list[Array], since: float | None, seed: int) -> list[dict[str, object]]:
    """Every cause that stands; ``before`` are the nominal vehicle's residuals, ``since`` (s) where the part of the log begins that is told."""
    return [_cause(problem, decision, named, before, since, seed) for named in decision.causes]


def members(decision: Decision, h: Hypothesis) -> tuple[str, ...]:
    """The cause and what this log does not tell from it, as many as are printed."""
    return tuple(name for name, _ in decision.groups[h.name][:MOST_GROUP])


def only(problem: Problem, final: Confirmed, h: Hypothesis) -> Array:
    """Parameters (k,) of the joint fit with every other cause put back."""
    beta = problem.origin.copy()
    beta[list(h.slots)] = final.beta[list(h.slots)]
    return beta


def settings(problem: Problem, final: Confirmed | None) -> tuple[str, ...]:
    """The effects found as command-line settings, numbers in full."""
    if final is None:
        return ()
    by_name: dict[str, list[str]] = {}
    for slot in final.slots:
        s = problem.plant.slots[slot]
        by_name.setdefault(s.hypothesis, []).append(f"{s.parameter.name}={float(final.beta[slot])!r}")
    return tuple(f"{name}:{','.join(values)}" for name, values in by_name.items())


def _cause(problem: Problem, decision: Decision, named: Named, before: list[Array], since: float | None, seed: int) -> dict[str, object]:
    assert decision.fit is not None
    h, final = named.hypothesis, decision.fit
    alone = final if len(decision.causes) == 1 else roughly(problem, only(problem, final, h), h.slots, final.point.scaled)
    return {
        "effect": h.name,
        "title": effects.load(h.name.partition("[")[0]).title,
        "group": list(members(decision, h)),
        "probability": decision.probability[h.name],
        "onset_s": next((float(final.beta[s]) for s in h.slots if problem.plant.slots[s].parameter.name == "onset"), since),
        "parameters": _parameters(problem, final, h),
        "p_value": named.p_value,
        "evidence": named.evidence,
        "shrinkage": shrinkage(problem, alone, before, seed),
    }


def _parameters(problem: Problem, final: Confirmed, h: Hypothesis) -> dict[str, dict[str, object]]:
    """Values of the joint fit with their intervals, held within the parameters' bounds."""
    rows, error = dict[str, dict[str, object]](), errors(problem, final)
    for slot in h.slots:
        p, value = problem.plant.slots[slot].parameter, float(final.beta[slot])
        form = FORM * abs(value - float(problem.origin[slot]))
        low, high = interval(value, float(np.hypot(error[final.slots.index(slot)], form)), problem.blocks)
        rows[p.name] = {
            "value": value, "low": max(low, p.low), "high": min(high, p.high), "unit": p.unit, "null": p.null, "at_bound": slot in final.at_bound,
        }  # fmt: skip
    return rows
