"""The answer as the JSON document of the contract: verdict, gap, causes, shrinkage, ranking, what is left and what to fly next."""

from __future__ import annotations

import numpy as np

from rovval import __version__, effects
from rovval.data import Array
from rovval.diagnose import Diagnosis
from rovval.diagnose.confirm import Confirmed, confirm, errors, interval
from rovval.diagnose.experiment import Advice, best_manoeuvre
from rovval.diagnose.gap import axis_rows, axis_squares, noise_loss
from rovval.diagnose.library import Hypothesis
from rovval.diagnose.localise import change_points, slices, worst
from rovval.diagnose.parity import faults
from rovval.diagnose.pictures import coherence_matrix, heat_map, traces
from rovval.diagnose.problem import Problem, corrected_residuals
from rovval.diagnose.select import Named, Selection
from rovval.diagnose.separate import interval as shrink_interval
from rovval.diagnose.verdict import Judgement, judge
from rovval.diagnose.words import sentence
from rovval.vehicle.write import with_effects

HARM = 0.05  # an axis that gets this much worse is named (research E.7)
MOST_GROUP = 3  # names printed of a confusion group


def answer(
    problem: Problem, untestable: dict[str, str], left_out: tuple[str, ...], selection: Selection, slop: float, seed: int
) -> Diagnosis:
    """Put everything that was found into one document."""
    before = corrected_residuals(problem)
    judgement = judge(problem, selection, axis_rows(problem, before))
    final = judgement.final
    after = corrected_residuals(problem, final.beta) if final else before
    axes = axis_rows(problem, before)
    shares = {axis: float(str(row["share"])) for axis, row in axes.items()}
    where = [s for part, error in zip(problem.parts, before, strict=True) for s in worst(slices(part, error, part.ok, seed), shares)][:5]
    advice = _advice(problem, judgement)
    document = {
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
        "verdict": judgement.verdict,
        "gap": {
            "axes": axes,
            "where": [
                {"axis": s.axis, "regime": s.regime, "share": s.share, "time_share": s.time_share, "lift": s.lift, "low": s.low, "high": s.high}
                for s in where
            ],
            "change_points_s": _changes(problem, before, seed),
        },
        "causes": [_cause(problem, judgement, named, before, seed) for named in judgement.named],
        "shrinkage": _shrinkage(problem, final, before, after, seed),
        "ranking": [{"effect": name, "score": score} for name, score in selection.ranking],
        "not_testable": [{"effect": name, "why": why} for name, why in sorted(untestable.items())],
        "next_experiment": _experiment(advice),
        "detection": _detection(selection, judgement),
        "finalists": [[{"effect": n, "evidence": e, "gain": g} for n, e, g in one] for one in selection.rounds],
        "left": judgement.left,
        "harm": _harm(problem, before, after),
        "parity": [row for check, part in zip(problem.parity, problem.parts, strict=True) for row in faults(check, part)],
        "heatmap": heat_map(problem.parts[0], before[0], seed),
        "traces": traces(problem, final, before, after),
        "coherence": coherence_matrix(problem, selection, judgement),
        "inputs": problem.parts[0].driven.source,
        "runs_left_out": list(left_out),
        "left_out_s": sum(part.contact_s for part in problem.parts),
        "outliers": sum(part.outliers for part in problem.parts),
    }  # fmt: skip
    if advice:
        document["manoeuvre"] = _schedule(problem, advice)
    document["sentence"] = sentence(document)
    settings = _settings(problem, final)
    return Diagnosis(document, settings, with_effects(problem.plant.vehicle, settings) if settings else "")


def _detection(selection: Selection, judgement: Judgement) -> dict[str, float]:
    """What the verdict rests on: p-values, evidence beside that of healthy logs, and the shares of the gap that slop alone, any systematic
    force, and the causes with slop beside them close on held-out windows."""
    return {
        "p_value": selection.named[0].p_value if selection.named else selection.last_p,
        "last_p": selection.last_p,
        "last_evidence": selection.last_evidence,
        "null_evidence": selection.null_evidence,
        "slop": judgement.slop_share,
        "ceiling": judgement.ceiling_share,
        "cause_and_slop": judgement.cause_share,
    }


def _cause(problem: Problem, judgement: Judgement, named: Named, before: list[Array], seed: int) -> dict[str, object]:
    """One cause: its group, probability, onset, parameters with intervals, and the shrinkage it gives by itself."""
    assert judgement.final is not None
    h, final = named.hypothesis, judgement.final
    alone = final if len(judgement.named) == 1 else confirm(problem, _only(problem, final, h), h.slots)
    value, low, high = shrink_interval(problem.dynamic.c, alone.dynamic_loss, seed)
    after = axis_squares(problem, corrected_residuals(problem, alone.beta))
    nominal = axis_squares(problem, before)
    members = judgement.groups[h.name]
    onset = next((float(final.beta[s]) for s in h.slots if problem.plant.slots[s].parameter.name == "onset"), None)
    parameters, error = {}, errors(problem, final)
    for slot in h.slots:
        i = final.slots.index(slot)
        p = problem.plant.slots[slot].parameter
        bottom, top = interval(float(final.beta[slot]), float(error[i]), problem.blocks)
        parameters[p.name] = {
            "value": float(final.beta[slot]), "low": max(bottom, p.low), "high": min(top, p.high), "unit": p.unit, "at_bound": slot in final.at_bound,
        }  # fmt: skip
    return {
        "effect": h.name,
        "title": effects.load(h.name.partition("[")[0]).title,
        "group": [name for name, _ in members[:MOST_GROUP]],
        "probability": judgement.probability[h.name],
        "onset_s": onset,
        "parameters": parameters,
        "p_value": named.p_value,
        "evidence": named.evidence,
        "shrinkage": {
            "total": value, "low": low, "high": high, "of_explainable": _explainable(problem, alone),
            "axes": {axis: float(1 - after[axis].sum() / nominal[axis].sum()) for axis in nominal if nominal[axis].sum() > 0},
        },
    }  # fmt: skip


def _only(problem: Problem, final: Confirmed, h: Hypothesis) -> Array:
    beta = problem.origin.copy()
    beta[list(h.slots)] = final.beta[list(h.slots)]
    return beta


def _shrinkage(problem: Problem, final: Confirmed | None, before: list[Array], after: list[Array], seed: int) -> dict[str, object]:
    if final is None:
        return {"total": 0.0, "low": 0.0, "high": 0.0, "of_explainable": 0.0, "axes": {}, "held_out": True}
    value, low, high = shrink_interval(problem.dynamic.c, final.dynamic_loss, seed)
    nominal, now = axis_squares(problem, before), axis_squares(problem, after)
    axes = {a: float(1 - now[a].sum() / nominal[a].sum()) for a in nominal if nominal[a].sum() > 0}
    return {"total": value, "low": low, "high": high, "of_explainable": _explainable(problem, final), "axes": axes, "held_out": True}


def _explainable(problem: Problem, fitted: Confirmed) -> float:
    """Share of the gap above the noise floor that is closed, on held-out windows."""
    gap, floor = float(problem.dynamic.c.sum()), float(noise_loss(problem).sum())
    return float(min((gap - float(fitted.dynamic_loss.sum())) / max(gap - floor, 1e-12), 1.0))


def _changes(problem: Problem, before: list[Array], seed: int) -> list[float]:
    times: list[float] = []
    for part, error in zip(problem.parts, before, strict=True):
        mean = np.where(part.ok, error, 0.0).sum(axis=1) / np.maximum(part.ok.sum(axis=1), 1)
        times.extend(change_points(part, mean, seed))
    return times


def _harm(problem: Problem, before: list[Array], after: list[Array]) -> list[dict[str, object]]:
    """Axes that get more than 5 % worse with the effects added."""
    nominal, now = axis_squares(problem, before), axis_squares(problem, after)
    change = {a: float(now[a].sum() / nominal[a].sum() - 1) for a in nominal if nominal[a].sum() > 0}
    return [{"axis": a, "change": value} for a, value in change.items() if value > HARM]


def _advice(problem: Problem, judgement: Judgement) -> Advice | None:
    """A manoeuvre for the first cause that shares its place with others."""
    if judgement.final is None:
        return None
    for named in judgement.named:
        members = tuple(name for name, _ in judgement.groups[named.hypothesis.name][:MOST_GROUP])
        if len(members) > 1:
            speed = np.concatenate([np.abs(p.driven.inputs.speed) for p in problem.parts])
            most = np.maximum(np.quantile(speed, 0.98, axis=0), 0.2 * speed.max())
            return best_manoeuvre(problem, _only(problem, judgement.final, named.hypothesis), members, most)
    return None


def _experiment(advice: Advice | None) -> dict[str, object] | None:
    if advice is None:
        return None
    return {"manoeuvre": f"{advice.manoeuvre.name}: {advice.manoeuvre.text}", "separates": list(advice.separates), "misfit": advice.misfit}


def _schedule(problem: Problem, advice: Advice) -> dict[str, object]:
    t, rows = 0.0, []
    for leg in advice.manoeuvre.legs:
        rpm = {name: round(60.0 * s, 1) for name, s in zip(problem.plant.vehicle.thrusters, leg.speed, strict=True)}
        rows.append({"t_s": t, "duration_s": leg.seconds, "thrusters": rpm})
        t += leg.seconds
    return {"name": advice.manoeuvre.name, "text": advice.manoeuvre.text, "unit": "rpm", "schedule": rows}


def _settings(problem: Problem, final: Confirmed | None) -> tuple[str, ...]:
    """The effects found as command-line settings, numbers in full."""
    if final is None:
        return ()
    by_name: dict[str, list[str]] = {}
    for slot in final.slots:
        s = problem.plant.slots[slot]
        by_name.setdefault(s.hypothesis, []).append(f"{s.parameter.name}={float(final.beta[slot])!r}")
    return tuple(f"{name}:{','.join(values)}" for name, values in by_name.items())


