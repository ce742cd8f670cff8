"""Assembly of the typed diagnosis from what was posed, found and decided."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.version import __version__
from rovval.diagnose.criteria import SLICES
from rovval.diagnose.decision.consistency import inconsistencies
from rovval.diagnose.decision.finding import Finding
from rovval.diagnose.decision.resemblance import evidence_by_force
from rovval.diagnose.decision.unexplained import Unexplained as Rest
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.hypotheses.change_points import change_points
from rovval.diagnose.inference.gap import gap_by_axis, weighted_errors
from rovval.diagnose.inference.shrinkage import shrinkage, worsened_axes
from rovval.diagnose.inference.unlogged_forces import ForceLeft
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.result.attribution import slices, worst
from rovval.diagnose.result.causes import causes, settings
from rovval.diagnose.result.diagnosis import (
    AxisGap,
    AxisHarm,
    Candidate,
    Departure,
    Dependence,
    Detection,
    Diagnosis,
    Disturbance,
    Gap,
    GapSlice,
    Indications,
    LogRemark,
    NotTestable,
    Oscillation,
    Probabilities,
    Reduction,
    Score,
    SensorFault,
    Shrinkage,
    Unexplained,
    UnloggedForce,
)
from rovval.diagnose.result.experiment import next_experiment
from rovval.diagnose.result.figures import coherence_matrix, heat_map, traces
from rovval.diagnose.result.recalibration import recalibration
from rovval.diagnose.search.baseline import healthy_without, reduction_beside
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.windows.conditioning import NO_MEASUREMENT
from rovval.vehicle.write import with_effects

WRENCH_UNITS = ("N", "N", "N", "N m", "N m", "N m")


def assemble(
    finding: Finding, left_out: tuple[str, ...], tolerance: float, seed: int, progress: Callable[[str, float], None]
) -> Diagnosis:
    """The typed diagnosis of what was found.

    Args:
        finding: the problem, what the search found in it, and the decision.
        left_out: runs that could not be used, each with the reason.
        tolerance: relative standard deviation of a healthy simulator's coefficients.
        seed: of the bootstrap of intervals.
        progress: called with what is being done and the share of the work that is done (0 to 1).
    """
    problem, selection, before, decision = finding.problem, finding.selection, finding.residuals, finding.decision
    shrunk = shrinkage(problem, decision.fit, before, seed)
    experiment = next_experiment(problem, decision)
    found = settings(problem, decision.fit)
    return Diagnosis(
        **_settings(problem, tolerance),
        since_s=decision.since,
        verdict=decision.verdict,
        gap=_gap(problem, before, seed),
        causes=causes(problem, decision, before, decision.since, seed),
        shrinkage=Shrinkage(**asdict(shrunk)),
        within_tolerance=_within_tolerance(problem, selection, decision, seed),
        ranking=tuple(Score(effect=name, score=score) for name, score in selection.ranking),
        not_testable=tuple(
            NotTestable(effect=name, why=why) for name, why in sorted(finding.untestable.items()) if name not in decision.groups
        ),
        next_experiment=experiment.summary() if experiment else None,
        manoeuvre=experiment.schedule(problem.plant.vehicle.thrusters) if experiment else None,
        probabilities=_probabilities(decision),
        detection=_detection(decision),
        finalists=tuple(tuple(Candidate(effect=n, evidence=e, gain=g) for n, e, g in step) for step in selection.steps),
        disturbance=_disturbance(problem),
        left=_unexplained(decision.unexplained),
        calibration=recalibration(problem, selection, decision, before, tolerance, seed, progress),
        harm=tuple(AxisHarm(axis=axis, change=change) for axis, change in worsened_axes(shrunk).items()),
        parity=tuple(SensorFault.model_validate(fault, from_attributes=True) for fault in finding.faults),
        indications=Indications.model_validate(decision.indications, from_attributes=True) if decision.indications else None,
        heatmap=heat_map(problem.runs[0], before[0], seed),
        traces=traces(problem, decision.fit, before),
        coherence=coherence_matrix(problem, selection, decision),
        inputs=problem.runs[0].actuation.source,
        log=_remarks(problem, before),
        runs_left_out=left_out,
        left_out_s=sum(part.contact_s for part in problem.runs),
        windows_stopped=sum(part.stopped for part in problem.runs),
        outliers=sum(part.outliers for part in problem.runs),
        settings=found,
        vehicle_fixed=with_effects(problem.plant.vehicle, found) if found else "",
    )


def _settings(problem: Problem, tolerance: float) -> dict[str, Any]:
    """What was diagnosed, and with which settings."""
    runs = [part.run for part in problem.runs]
    return {
        "rovval": __version__,
        "run": ", ".join(run.id for run in runs),
        "runs": tuple(run.id for run in runs),
        "vehicle": problem.plant.vehicle.name,
        "vehicle_hash": problem.plant.vehicle.hash,
        "model": problem.plant.model,
        "window_s": round((problem.runs[0].steps + 1) * runs[0].dt, 6),
        "windows": problem.window_count,
        "calibration_slop": tolerance,
        "synthetic": next((run.properties["synthetic"] for run in runs if "synthetic" in run.properties), ""),
    }


def _gap(problem: Problem, before: list[Array], seed: int) -> Gap:
    """How large the gap is, in which regimes it lies and when it changes; ``before`` are the nominal simulator's residuals."""
    axes = {axis: AxisGap(**asdict(row)) for axis, row in gap_by_axis(problem, before).items()}
    changes = list[float]()
    for part, error in zip(problem.runs, before, strict=True):
        mean = np.where(part.ok, error, 0.0).sum(axis=1) / np.maximum(part.ok.sum(axis=1), 1)
        changes.extend(change_points(part, mean, seed))
    return Gap(axes=axes, where=_where(problem, before, axes, seed), change_points_s=tuple(changes))


def _where(problem: Problem, before: list[Array], axes: Mapping[str, AxisGap], seed: int) -> tuple[GapSlice, ...]:
    """The regimes of axes that hold more of the gap than their time would."""
    shares = {axis: row.share for axis, row in axes.items()}
    found = [s for part, error in zip(problem.runs, before, strict=True) for s in worst(slices(part, error, part.ok, seed), shares)]
    return tuple(
        GapSlice(axis=s.axis, regime=s.regime, share=s.share, time_share=s.time_share, lift=s.lift, low=s.low, high=s.high)
        for s in found[:SLICES]
    )


def _within_tolerance(problem: Problem, selection: Selection, decision: Decision, seed: int) -> Reduction | None:
    """What the causes take away of the error that coefficients fitted within their tolerances leave; None without causes."""
    if decision.fit is None:
        return None
    others = healthy_without(problem, selection.healthy, decision.fit.slots)
    total, low, high = reduction_beside(problem, decision.fit, others, seed)
    return Reduction(total=total, low=low, high=high)


def _probabilities(decision: Decision) -> Probabilities:
    """Of the four kinds of model."""
    found = decision.probabilities
    return Probabilities(
        healthy=found.healthy, causes=found.causes, miscalibrated_file=found.file, something_else=found.something_else, not_found=found.not_found,
    )  # fmt: skip


def _detection(decision: Decision) -> Detection:
    return Detection(
        noise=decision.accounted.noise,
        tolerance_share=decision.accounted.tolerance,
        causes=decision.evidence,
        generic_instead=decision.generic_instead,
        generic_beside=decision.generic_beside,
        largest_departure=decision.departure,
        open_gap=decision.open_gap,
        unlogged_force=_unlogged(decision.unlogged),
        calibration_left=decision.accounted.calibrated,
    )


def _unlogged(left: ForceLeft | None) -> UnloggedForce | None:
    """The force that nobody logged where causes act."""
    return UnloggedForce(size=left.size, expected=left.expected, alike=left.alike, evidence=evidence_by_force(left)) if left else None


def _disturbance(problem: Problem) -> dict[str, Disturbance]:
    """The forces that nobody logged: rms and correlation time by axis."""
    found = problem.disturbance
    rows = zip(AXES, WRENCH_UNITS, found.rms, found.memory_s, strict=True)
    return {axis: Disturbance(rms=float(rms), unit=unit, memory_s=float(memory)) for axis, unit, rms, memory in rows}


def _unexplained(rest: Rest | None) -> Unexplained | None:
    if rest is None:
        return None
    departed = Departure(coefficient=rest.departed[0], departure=rest.departed[1]) if rest.departed else None
    goes_with = Dependence(effect=rest.goes_with[0], covariate=rest.goes_with[1]) if rest.goes_with else None
    swings = Oscillation(period_s=rest.oscillation.period, share=rest.oscillation.share) if rest.oscillation else None
    return Unexplained(
        axes=rest.axes, depends_on=rest.depends_on, share=rest.share, departed=departed, inconstant=rest.inconstant, goes_with=goes_with,
        oscillation=swings, accounted=rest.accounted,
    )  # fmt: skip


def _remarks(problem: Problem, before: list[Array]) -> tuple[LogRemark, ...]:
    """What of the logs is no plain measurement: saturated, held or repeated channels, and angles that contradict their rates."""
    found = [(part.run.id, f) for part in problem.runs for f in part.run.findings if f.code in NO_MEASUREMENT]
    rows = [LogRemark(run=run, channel=f.where, finding=f.code, detail=f.detail) for run, f in found]
    text = "and {} contradict each other by {:.2g} degrees within a window, whatever fault of a sensor is assumed"
    opposed = inconsistencies(problem, weighted_errors(problem, before))
    own = [LogRemark(run=i.run, channel=i.angle, finding="contradicted", detail=text.format(i.rate, np.degrees(i.drift))) for i in opposed]
    return (*rows, *own)
