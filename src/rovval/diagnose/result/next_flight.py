"""What to fly next, as rows of the document: for the first cause that this log does not tell from another."""

from __future__ import annotations

import numpy as np

from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.result.causes import members, only
from rovval.diagnose.result.experiment import Advice, best_manoeuvre

BUSY, LEAST_BUSY = 0.98, 0.2  # chosen: quantile of a thruster's speed in the log that counts as its most, and least share of its peak


def advise(problem: Problem, decision: Decision) -> Advice | None:
    """The manoeuvre that would decide, None where every cause stands alone."""
    for named in decision.causes if decision.fit else ():
        assert decision.fit is not None
        group = members(decision, named.hypothesis)
        if len(group) > 1:
            speed = np.concatenate([np.abs(p.driven.inputs.speed) for p in problem.parts])
            most = np.maximum(np.quantile(speed, BUSY, axis=0), LEAST_BUSY * speed.max())
            return best_manoeuvre(problem, only(problem, decision.fit, named.hypothesis), group, most)
    return None


def rows(problem: Problem, advice: Advice | None) -> dict[str, object]:
    """``next_experiment`` of the contract, and ``manoeuvre`` with the thruster schedule where there is one."""
    if advice is None:
        return {"next_experiment": None}
    told = {"manoeuvre": f"{advice.manoeuvre.name}: {advice.manoeuvre.text}", "separates": list(advice.separates), "misfit": advice.misfit}
    return {"next_experiment": told, "manoeuvre": _schedule(problem, advice)}


def _schedule(problem: Problem, advice: Advice) -> dict[str, object]:
    t, steps = 0.0, []
    for leg in advice.manoeuvre.legs:
        rpm = {name: round(60.0 * s, 1) for name, s in zip(problem.plant.vehicle.thrusters, leg.speed, strict=True)}
        steps.append({"t_s": t, "duration_s": leg.seconds, "thrusters": rpm})
        t += leg.seconds
    return {"name": advice.manoeuvre.name, "text": advice.manoeuvre.text, "unit": "rpm", "schedule": steps}
