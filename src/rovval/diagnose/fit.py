"""Fit: a chosen set of a vehicle's parameters tuned to logs by re-simulation, as the thesis does by hand in 6.5.

The rest of the vehicle stays as its file says, within calibration slop. What these logs cannot determine is named, with the reason
(not excited, or not told apart from what) and left where it was. Intervals hold under autocorrelated residuals.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rovval import __version__, effects
from rovval.data import Array
from rovval.diagnose.confirm import Confirmed, confirm, interval
from rovval.diagnose.gap import axis_squares, noise_loss
from rovval.diagnose.library import PRIOR_WIDTH, hypotheses
from rovval.diagnose.problem import Problem, corrected_residuals, pose
from rovval.diagnose.separate import coherence
from rovval.diagnose.separate import interval as shrink_interval
from rovval.diagnose.stretches import cut_all
from rovval.errors import UsageProblem, all_at_once
from rovval.plant import Plant
from rovval.vehicle.write import to_toml, with_effects

if TYPE_CHECKING:
    from rovval.data import Run
    from rovval.vehicle.model import Vehicle

FAMILIES = {
    "drag": "linear_drag quadratic_drag", "thrust": "thruster_degraded", "allocation": "thruster_misaligned",
    "mass": "added_mass inertia_error", "trim": "buoyancy_error cg_offset",
}  # fmt: skip
EXCITED = 3.0  # a typical size shows with this many standard errors while nothing else moves (research E.6)
TOLD_APART = 1.5  # the same while everything else that is tuned, and slop, moves with it (chosen: a 90 % interval within a typical size)
WIDEST = 2.0  # typical sizes: a half interval beyond it, at the fitted point, is no answer
HARM = 0.05  # an axis that gets worse by more is reported


@dataclass(frozen=True, slots=True)
class FitResult:
    """``vehicle``: TOML with the tuned parameters in its [effects]; ``document``: rovval.fit/1; ``text``: the same to be read."""

    vehicle: str
    document: dict[str, Any]
    text: str


def fit(
    runs: Sequence[Run],
    vehicle: Vehicle,
    parameters: Sequence[str],
    *,
    model: str = "fossen",
    window_s: float = 10.0,
    calibration_slop: float = 0.05,
    seed: int = 0,
    progress: Callable[[str, float], None] | None = None,
) -> FitResult:
    """Tune ``parameters`` of ``vehicle`` to one or several of its logs.

    ``parameters`` are parameters (``thruster_degraded[HFP].loss``), hypotheses (``quadratic_drag[surge]``), effects
    (``quadratic_drag``), patterns with * or families (`FAMILIES`). ``calibration_slop`` is what the rest may be off by.

    Raises:
        UsageProblem: names every parameter that does not exist, or that needs `diagnose`, at once.
        BadInput: too little of a log can be simulated, or thruster inputs are missing.
    """
    say = progress or (lambda text, share: None)
    wanted = chosen(Plant(vehicle, model), parameters)
    parts, left_out = cut_all(runs, vehicle, model, window_s)
    library, missing = hypotheses(parts)
    plant = parts[0].plant
    out = {s: _undetermined(missing[plant.slots[s].hypothesis]) for s in wanted if plant.slots[s].hypothesis in missing}
    able = tuple(s for s in wanted if s not in out)
    say(f"simulating {len(able)} parameters on {sum(p.count for p in parts)} windows", 0.1)
    names = {plant.slots[s].hypothesis for s in able}
    kept = [h for h in library if not h.directions and (h.name in names or effects.load(h.name.partition("[")[0]).place == "sensor")]
    problem = pose(parts, kept, calibration_slop)
    able, blind = determinable(problem, able)
    out |= blind
    say(f"tuning {len(able)} parameters by re-simulation", 0.4)
    fitted, low, high, vague = _tuned(problem, able)
    out |= vague
    say("asking how far the gap shrinks on held-out windows", 0.9)
    document = _document(problem, fitted, low, high, {s: out[s] for s in wanted if s in out}, calibration_slop, seed)
    document["left_out"] = list(left_out)
    settings = document["settings"]
    return FitResult(with_effects(vehicle, settings) if settings else to_toml(vehicle), document, text(document))


def chosen(plant: Plant, parameters: Sequence[str]) -> tuple[int, ...]:
    """Slots that the names mean, in the plant's order.

    Raises:
        UsageProblem: names every unknown one with near matches, and those that are not a matter of tuning.
    """
    found, problems = set[int](), []
    for asked in parameters:
        slots = [s for one in FAMILIES.get(asked, asked).split() for s in _meant(plant, one)]
        searched = sorted({plant.slots[s].hypothesis for s in slots if _searched(plant, s)})
        if not slots:
            problems.append(f"{asked!r}: no such parameter{_near(plant, asked)}")
        elif searched:
            problems.append(f"{asked!r}: {', '.join(searched)} begins or turns at a place or time that is searched for, not tuned; see `rovval diagnose`")
        found.update(slots)
    if not parameters:
        problems.append("none was named")
    if problems:
        hint = f"`rovval list effect` has the names; families: {', '.join(FAMILIES)}; * stands for any axis or thruster"
        raise UsageProblem(all_at_once(problems, "parameters to tune"), hint)
    return tuple(sorted(found))


def _meant(plant: Plant, one: str) -> list[int]:
    pattern = re.compile(".*".join(re.escape(part) for part in one.split("*")))
    return [i for i, s in enumerate(plant.slots) if any(pattern.fullmatch(name) for name in (s.key, s.hypothesis, s.effect))]


def _searched(plant: Plant, slot: int) -> bool:
    effect = effects.load(plant.slots[slot].effect)
    return bool(effect.grid) or any(p.name == "onset" for p in effect.parameters)


def _near(plant: Plant, asked: str) -> str:
    names = dict.fromkeys([*FAMILIES, *(n for s in plant.slots for n in (s.effect, s.hypothesis, s.key))])
    close = difflib.get_close_matches(asked, list(names), n=3, cutoff=0.6)
    return f", perhaps {' or '.join(close)}" if close else ""


def _undetermined(why: str, beside: Sequence[tuple[str, float]] = ()) -> dict[str, Any]:
    return {"why": why, "with": [{"parameter": name, "coherence": value} for name, value in beside]}


def determinable(problem: Problem, wanted: Sequence[int]) -> tuple[tuple[int, ...], dict[int, dict[str, Any]]]:
    """Which slots these logs can determine, and why not the others; the least determined leaves first."""
    out, left = dict[int, dict[str, Any]](), list(wanted)
    information = problem.data.A.sum(axis=0) / problem.inflation
    typical = {s: problem.plant.slots[s].parameter.typical for s in problem.data.columns}
    for slot in wanted:
        at = int(problem.data.place((slot,))[0])
        if (seen := float(np.sqrt(information[at, at])) * typical[slot]) < EXCITED:
            left.remove(slot)
            out[slot] = _undetermined(f"not excited: a typical size would show with {seen:.1f} standard errors in these logs, {EXCITED:g} are needed")
    while left:
        slop = [c for c in problem.slop.sd if c not in left]
        free = problem.data.place((*left, *slop))
        prior = [PRIOR_WIDTH * typical[s] for s in left] + [problem.slop.sd[c] for c in slop]
        covariance = np.linalg.inv(information[np.ix_(free, free)] + np.diag(1.0 / np.array(prior) ** 2))
        shown = np.array([typical[s] for s in left]) / np.sqrt(np.diag(covariance)[: len(left)])
        if shown.min() >= TOLD_APART:
            break
        worst = left.pop(int(shown.argmin()))
        why = f"not told apart: a typical size shows with {shown.min():.1f} standard errors while the others move"
        out[worst] = _confused(problem, worst, (*left, *slop), why)
    return tuple(left), out


def _confused(problem: Problem, slot: int, others: Sequence[int], why: str) -> dict[str, Any]:
    """What a slot that is excited is confused with: tuned ones and coefficients within slop, by coherence."""
    beside = sorted(((problem.plant.slots[s].key, coherence(problem.data, (slot,), (s,))) for s in others if s != slot), key=lambda x: -x[1])
    named = " and ".join(f"{name} ({value:.2f})" for name, value in beside[:2])
    return _undetermined(f"{why}; most like {named}" if named else why, beside[:2])


def _tuned(problem: Problem, slots: tuple[int, ...]) -> tuple[Confirmed | None, Array, Array, dict[int, dict[str, Any]]]:
    """The joint fit with its 90 % intervals; slots whose interval says nothing at the fitted point are put back and the rest refitted."""
    out = dict[int, dict[str, Any]]()
    while slots:
        fitted = confirm(problem, problem.origin, slots)
        bounds = [interval(float(fitted.beta[s]), float(e), problem.blocks) for s, e in zip(slots, joint_errors(problem, fitted), strict=True)]
        low, high = np.array(bounds).T
        half = 0.5 * (high - low) / [problem.plant.slots[s].parameter.typical for s in slots]
        if half.max() <= WIDEST:
            return fitted, low, high, out
        worst = slots[int(half.argmax())]
        why = f"not told apart: its 90 % interval with slop of the others is +-{half.max():.1f} typical sizes"
        out[worst] = _confused(problem, worst, tuple(dict.fromkeys((*slots, *problem.slop.sd))), why)
        slots = tuple(s for s in slots if s != worst)
    return None, np.zeros(0), np.zeros(0), out


def joint_errors(problem: Problem, fitted: Confirmed) -> Array:
    """Standard errors (k,) of the tuned slots: the sandwich of the estimator that `confirm` is, which lets slop move beside them.

    Residuals may be autocorrelated (scores are summed over pairs of windows; where these are few, never less than the inflated covariance), and the other
    coefficients are off by the declared slop, of which the joint fit takes out what the logs show.
    """
    k, data, precision = len(fitted.slots), fitted.point.data, fitted.point.precision
    bread = np.linalg.inv(data.A.sum(axis=0) + np.diag(precision))
    step = bread @ (data.b.sum(axis=0) - precision * fitted.point.offset)
    step[:k] = 0.0
    score = data.b - np.einsum("wij,j->wi", data.A, step)
    pairs = score[: len(score) // 2 * 2].reshape(-1, 2, len(step)).sum(axis=1)
    half = bread[:k] @ pairs.T
    sandwich = (half**2).sum(axis=1) * (len(score) / max(2 * len(pairs), 1)) * len(pairs) / max(len(pairs) - k, 1)
    white = problem.inflation * np.einsum("ij,jk,ik->i", bread[:k], data.A.sum(axis=0), bread[:k])
    slop = bread[:k, k:] * precision[k:] * [problem.slop.sd[c] for c in data.columns[k:]]
    spread = sandwich if len(pairs) > k + 1 else np.maximum(sandwich, white)
    return np.asarray(np.sqrt(spread + (slop**2).sum(axis=1)))


def _document(
    problem: Problem, fitted: Confirmed | None, low: Array, high: Array, out: dict[int, dict[str, Any]], slop: float, seed: int
) -> dict[str, Any]:
    plant, rows = problem.plant, dict[str, Any]()
    for i, slot in enumerate(fitted.slots if fitted else ()):
        assert fitted is not None
        p, value, was = plant.slots[slot].parameter, float(fitted.beta[slot]), float(problem.origin[slot])
        bottom, top = max(float(low[i]), p.low), min(float(high[i]), p.high)
        rows[plant.slots[slot].key] = {
            "value": value, "low": bottom, "high": top, "unit": p.unit, "was": was,
            "at_bound": slot in fitted.at_bound, "differs": not bottom <= was <= top,
        }  # fmt: skip
    return {
        "schema": "rovval.fit/1",
        "rovval": __version__,
        "run": ", ".join(part.run.id for part in problem.parts),
        "vehicle": plant.vehicle.name,
        "vehicle_hash": plant.vehicle.hash,
        "model": plant.model,
        "window_s": round((problem.parts[0].steps + 1) * problem.parts[0].run.dt, 6),
        "windows": problem.blocks,
        "calibration_slop": slop,
        "parameters": rows,
        "undetermined": [{"parameter": plant.slots[s].key, **why, "left_at": float(problem.origin[s])} for s, why in out.items()],
        **_shrinkage(problem, fitted, seed),
        "settings": list(_settings(problem, fitted)) if fitted else [],
    }


def _shrinkage(problem: Problem, fitted: Confirmed | None, seed: int) -> dict[str, Any]:
    if fitted is None:
        return {"shrinkage": {"total": 0.0, "low": 0.0, "high": 0.0, "of_explainable": 0.0, "axes": {}, "held_out": True}, "harm": []}
    value, low, high = shrink_interval(problem.dynamic.c, fitted.dynamic_loss, seed)
    gap, floor = float(problem.dynamic.c.sum()), float(noise_loss(problem).sum())
    before, after = (axis_squares(problem, corrected_residuals(problem, b)) for b in (None, fitted.beta))
    axes = {a: float(1.0 - after[a].sum() / before[a].sum()) for a in before if before[a].sum() > 0}
    of = min((gap - float(fitted.dynamic_loss.sum())) / max(gap - floor, 1e-12), 1.0)
    return {
        "shrinkage": {"total": value, "low": low, "high": high, "of_explainable": float(of), "axes": axes, "held_out": True},
        "harm": [{"axis": a, "change": -s} for a, s in axes.items() if s < -HARM],
    }


def _settings(problem: Problem, fitted: Confirmed) -> tuple[str, ...]:
    """Every tuned hypothesis as ``--effect`` takes it, with what the vehicle's file says of its other parameters."""
    plant, found = problem.plant, []
    for name in dict.fromkeys(plant.slots[s].hypothesis for s in fitted.slots):
        own = [s for s in plant.hypotheses[name] if s in fitted.slots or fitted.beta[s] != plant.null[s]]
        found.append(f"{name}:" + ",".join(f"{plant.slots[s].parameter.name}={float(fitted.beta[s])!r}" for s in own))
    return tuple(found)


def text(document: dict[str, Any]) -> str:
    """The document to be read in a terminal."""
    rows, shrunk = document["parameters"], document["shrinkage"]
    lines = [f"{document['run']}: {document['vehicle']}, model {document['model']}, {document['windows']} windows of {document['window_s']:g} s"]
    if rows:
        lines.append(
            f"The gap shrinks by {100 * shrunk['total']:.0f} % [{100 * shrunk['low']:.0f}, {100 * shrunk['high']:.0f}] on held-out windows with "
            f"{len(rows)} parameter{'s' if len(rows) > 1 else ''} tuned."
        )
        width = max(map(len, rows))
        lines += ["", f"{'tuned':{width}}       was      value   90 % interval"]
    for name, row in rows.items():
        unit = "" if row["unit"] == "1" else f" {row['unit']}"
        note = "  rests at its bound" if row["at_bound"] else "" if row["differs"] else "  not distinguishable from what it was"
        lines.append(f"{name:{width}}  {row['was']:8.3g}  {row['value']:9.3g}   [{row['low']:.3g}, {row['high']:.3g}]{unit}{note}")
    if document["undetermined"]:
        lines += ["", "These logs cannot determine (left as they were):", *(f"  {u['parameter']}: {u['why']}" for u in document["undetermined"])]
    if document["harm"]:
        lines += ["", "Worse with it: " + ", ".join(f"{h['axis']} by {100 * h['change']:.0f} %" for h in document["harm"]) + "."]
    if rows and shrunk["low"] <= 0:
        lines += ["", "Not shown to be better on held-out windows: use fewer parameters, shorter windows or more logs before using this vehicle."]
    lines += [f"Left out: {why}" for why in document["left_out"]]
    if not rows:
        lines += ["", "Nothing was tuned. Next: a log that moves on the axes, or turns the thrusters, that these parameters act on."]
    return "\n".join([*lines, ""])
