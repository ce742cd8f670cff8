"""The isolated causes: confusion group, probability, onset, parameters with intervals, and what each alone does to the gap."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.criteria import GROUP_NAMES, PARAMETER_FORM_ERROR
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.inference.heterogeneity import ByRun, by_run
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit, confidence_interval, fit_quickly, standard_errors
from rovval.diagnose.inference.identifiability import seen_together
from rovval.diagnose.inference.shrinkage import shrinkage
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.residuals.ridge import Prior
from rovval.diagnose.result.diagnosis import Cause, Correlation, Parameter, RunValue, Shrinkage


def causes(problem: Problem, decision: Decision, before: list[Array], since: float | None, seed: int) -> tuple[Cause, ...]:
    """Every cause of the most probable model, the surest first: what one of several closes by itself is no measure of it, where the others hide it.

    ``before`` are the nominal simulator's residuals; ``since`` (s) is when the part of the log begins that was searched, None for all of it.
    """
    each = by_run(problem, decision.fit) if decision.fit else {}
    return tuple(_cause(problem, decision, h, each, before, since, seed) for h in decision.causes)


def members(decision: Decision, h: Hypothesis) -> tuple[str, ...]:
    """The cause's confusion group, itself first, as many as are printed."""
    return tuple(name for name, _ in decision.groups[h.name][:GROUP_NAMES])


def alone(problem: Problem, fitted: HypothesisFit, h: Hypothesis) -> Array:
    """Parameters (k,) of the joint fit with every other cause put back to the vehicle's file."""
    beta = problem.origin.copy()
    beta[list(h.slots)] = fitted.beta[list(h.slots)]
    return beta


def settings(problem: Problem, fitted: HypothesisFit | None) -> tuple[str, ...]:
    """The causes as the command line's ``--effect`` takes them, numbers in full."""
    if fitted is None:
        return ()
    by_name: dict[str, list[str]] = {}
    for slot in fitted.slots:
        s = problem.plant.slots[slot]
        by_name.setdefault(s.hypothesis, []).append(f"{s.parameter.name}={float(fitted.beta[slot])!r}")
    return tuple(f"{name}:{','.join(values)}" for name, values in by_name.items())


def _cause(
    problem: Problem, decision: Decision, h: Hypothesis, each: Mapping[int, ByRun], before: list[Array], since: float | None, seed: int
) -> Cause:
    assert decision.fit is not None
    joint = decision.fit
    single = joint if len(decision.causes) == 1 else _by_itself(problem, joint, h)
    return Cause(
        effect=h.name,
        kind="file" if h.effect.in_file else "effect",
        title=h.effect.title,
        group=members(decision, h),
        probability=decision.probability[h.name],
        onset_s=next((float(joint.beta[s]) for s in h.slots if problem.plant.slots[s].parameter.role == "onset"), since),
        parameters=_parameters(problem, joint, h, each),
        together=_together(problem, joint, h),
        evidence=decision.added[h.name],
        shrinkage=Shrinkage(**asdict(shrinkage(problem, single, before, seed))),
    )


def _by_itself(problem: Problem, joint: HypothesisFit, h: Hypothesis) -> HypothesisFit:
    """The cause fitted by itself, all else as the file has it: tolerances would take up what the other causes did, and are not there when it is scored."""
    return fit_quickly(replace(problem, tolerance=Prior({})), alone(problem, joint, h), h.slots, joint.posterior.whitened)


def _parameters(problem: Problem, fitted: HypothesisFit, h: Hypothesis, each: Mapping[int, ByRun]) -> dict[str, Parameter]:
    """Values of the joint fit; their intervals add the form error of the equations and stay within the parameters' bounds."""
    found, error = dict[str, Parameter](), standard_errors(problem, fitted)
    for slot in h.slots:
        p, value = problem.plant.slots[slot].parameter, float(fitted.beta[slot])
        form = PARAMETER_FORM_ERROR * abs(value - float(problem.origin[slot]))
        low, high = confidence_interval(value, float(np.hypot(error[fitted.slots.index(slot)], form)), problem.window_count)
        found[p.name] = Parameter(
            value=value, low=max(low, p.low), high=min(high, p.high), unit=p.unit, null=p.null, at_bound=slot in fitted.at_bound,
            by_run=_run_values(problem, each[slot]) if slot in each else {}, homogeneity=each[slot].homogeneity if slot in each else None,
        )  # fmt: skip
    return found


def _together(problem: Problem, fitted: HypothesisFit, h: Hypothesis) -> tuple[Correlation, ...]:
    """Pairs of the cause's parameters that the log shows together only."""
    at, names = [fitted.slots.index(s) for s in h.slots], [problem.plant.slots[s].parameter.name for s in h.slots]
    pairs = seen_together(names, fitted.posterior.effect_correlation()[np.ix_(at, at)])
    return tuple(Correlation(of=(earlier, later), value=value) for later, earlier, value in pairs)


def _run_values(problem: Problem, each: ByRun) -> dict[str, RunValue]:
    """What the runs say that say something, by their ids."""
    found = dict[str, RunValue]()
    for i, part in enumerate(problem.runs):
        if np.isfinite(each.values[i]):
            low, high = confidence_interval(float(each.values[i]), float(each.errors[i]), part.count)
            found[part.run.id] = RunValue(value=float(each.values[i]), low=low, high=high)
    return found
