"""The answer as the JSON document of the contract: verdict, gap, causes, shrinkage, ranking, what is left and what to fly next."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.version import __version__
from rovval.diagnose.decision.consistency import contradicted
from rovval.diagnose.decision.finding import Finding
from rovval.diagnose.decision.unexplained import Unexplained
from rovval.diagnose.decision.verdict import Decision
from rovval.diagnose.hypotheses.change_points import change_points
from rovval.diagnose.inference.gap import axis_rows, axis_weight
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.inference.shrinkage import harm, shrinkage
from rovval.diagnose.residuals.sensor_faults import faults
from rovval.diagnose.result import next_flight
from rovval.diagnose.result.attribution import slices, worst
from rovval.diagnose.result.causes import causes, settings
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.diagnose.result.figures import coherence_matrix, heat_map, traces
from rovval.diagnose.result.recalibration import calibration
from rovval.diagnose.search.baseline import relief, without_own
from rovval.diagnose.search.forward import Selection
from rovval.diagnose.windows.saturation import NO_MEASUREMENT
from rovval.report.diagnosis.nothing import unexplained
from rovval.report.diagnosis.sentence import first, sentence
from rovval.vehicle.write import with_effects

MOST_SLICES = 5  # named of where the gap lies


def answer(finding: Finding, left_out: tuple[str, ...], slop: float, seed: int, progress: Callable[[str, float], None]) -> Diagnosis:
    """Put everything that was found into one document."""
    problem, selection, before, decision = finding.problem, finding.selection, finding.before, finding.decision
    axes = axis_rows(problem, before)
    shrunk = shrinkage(problem, decision.fit, before, seed)
    document: dict[str, Any] = {
        **_head(problem, slop),
        "since_s": finding.since,
        "verdict": decision.verdict,
        "gap": {"axes": axes, "where": _where(problem, before, axes, seed), "change_points_s": _changes(problem, before, seed)},
        "causes": causes(problem, decision, before, finding.since, seed),
        "shrinkage": shrunk,
        "beside_slop": _beside_slop(problem, selection, decision, seed),
        "ranking": [{"effect": name, "score": score} for name, score in selection.ranking],
        "not_testable": [{"effect": name, "why": why} for name, why in sorted(finding.untestable.items()) if name not in decision.groups],
        **next_flight.rows(problem, next_flight.advise(problem, decision)),
        "detection": _detection(selection, decision),
        "finalists": [[{"effect": n, "evidence": e, "gain": g} for n, e, g in one] for one in selection.rounds],
        "disturbance": _disturbance(problem),
        "left": _left(decision.unexplained),
        "calibration": calibration(problem, selection, decision, before, slop, seed, progress),
        "harm": harm(shrunk),
        "parity": [row for check, part in zip(problem.parity, problem.parts, strict=True) for row in faults(check, part, problem.origin)],
        "heatmap": heat_map(problem.parts[0], before[0], seed),
        "traces": traces(problem, decision.fit, before),
        "coherence": coherence_matrix(problem, selection, decision),
        "inputs": problem.parts[0].driven.source,
        "log": [*_log(problem), *contradicted(problem, axis_weight(problem, before))],
        "runs_left_out": list(left_out),
        "left_out_s": sum(part.contact_s for part in problem.parts),
        "windows_stopped": sum(part.stopped for part in problem.parts),
        "outliers": sum(part.outliers for part in problem.parts),
    }
    if decision.unexplained:
        document["left"] |= {"text": unexplained(document)}
    document |= {"answer": first(document), "sentence": sentence(document)}
    found = settings(problem, decision.fit)
    return Diagnosis(document, found, with_effects(problem.plant.vehicle, found) if found else "")


def _head(problem: Problem, slop: float) -> dict[str, object]:
    """What was diagnosed, and with which settings."""
    return {
        "schema": "rovval.diagnosis/1",
        "rovval": __version__,
        "run": ", ".join(part.run.id for part in problem.parts),
        "vehicle": problem.plant.vehicle.name,
        "vehicle_hash": problem.plant.vehicle.hash,
        "model": problem.plant.model,
        "window_s": round((problem.parts[0].steps + 1) * problem.parts[0].run.dt, 6),
        "windows": problem.blocks,
        "calibration_slop": slop,
        "synthetic": next((p.run.properties["synthetic"] for p in problem.parts if "synthetic" in p.run.properties), ""),
    }


def _log(problem: Problem) -> list[dict[str, str]]:
    """What of the logs was found to be no measurement, and how it was taken (`sensed`)."""
    found = [(part.run.id, f) for part in problem.parts for f in part.run.findings if f.code in NO_MEASUREMENT]
    return [{"run": run, "channel": f.where, "finding": f.code, "detail": f.detail} for run, f in found]


def _disturbance(problem: Problem) -> dict[str, dict[str, float | str]]:
    """What pushed the vehicle that nobody logged: rms force of each axis and the seconds in which it forgets itself."""
    found, units = problem.disturbance, ("N", "N", "N", "N m", "N m", "N m")
    rows = zip(AXES, units, found.rms, found.memory_s, strict=True)
    return {axis: {"rms": float(rms), "unit": unit, "memory_s": float(memory)} for axis, unit, rms, memory in rows}


def _left(rest: Unexplained | None) -> dict[str, Any] | None:
    """What is left unexplained, without its sentence."""
    if rest is None:
        return None
    strained = dict(zip(("coefficient", "departure"), rest.strained, strict=True)) if rest.strained else None
    head = {"axes": list(rest.axes), "depends_on": list(rest.depends_on), "share": rest.share}
    return head | {"strained": strained, "inconstant": list(rest.inconstant), "accounted": rest.accounted}


def _beside_slop(problem: Problem, selection: Selection, decision: Decision, seed: int) -> dict[str, float] | None:
    """What the causes close of the gap that healthy coefficients leave, where these settle beside them."""
    if decision.fit is None:
        return None
    others = without_own(problem, selection.healthy, decision.fit.slots)
    return dict(zip(("total", "low", "high"), relief(problem, decision.fit, others, seed), strict=True))


def _detection(selection: Selection, decision: Decision) -> dict[str, float]:
    """What the verdict rests on: p-values; the share of the gap that is sensor noise, and that healthy coefficients within slop close;
    twice the log Bayes factor of the causes, and of a generic force instead of them and beside them; how many standard deviations
    of its tolerance the most strained healthy coefficient is off."""
    return {
        "noise": decision.accounted.noise,
        "slop": decision.accounted.tolerance,
        "p_value": selection.named[0].p_value if selection.named else selection.last_p,
        "last_p": selection.last_p,
        "last_evidence": selection.last_evidence,
        "null_evidence": selection.null_evidence,
        "causes": decision.evidence,
        "generic_instead": decision.generic_instead,
        "generic_beside": decision.generic_beside,
        "strain": decision.departure,
    }


def _where(problem: Problem, before: list[Array], axes: Mapping[str, Mapping[str, object]], seed: int) -> list[dict[str, object]]:
    """The slices of axis and regime that hold more of the gap than their time would."""
    shares = {axis: float(str(row["share"])) for axis, row in axes.items()}
    found = [s for part, error in zip(problem.parts, before, strict=True) for s in worst(slices(part, error, part.ok, seed), shares)]
    return [
        {"axis": s.axis, "regime": s.regime, "share": s.share, "time_share": s.time_share, "lift": s.lift, "low": s.low, "high": s.high}
        for s in found[:MOST_SLICES]
    ]


def _changes(problem: Problem, before: list[Array], seed: int) -> list[float]:
    """Times at which the mean residual changes level."""
    times: list[float] = []
    for part, error in zip(problem.parts, before, strict=True):
        mean = np.where(part.ok, error, 0.0).sum(axis=1) / np.maximum(part.ok.sum(axis=1), 1)
        times.extend(change_points(part, mean, seed))
    return times
