"""Fit: a chosen set of a vehicle's parameters tuned to logs by re-simulation, as the thesis does by hand in 6.5.

The rest of the vehicle stays as its file says, within the calibration tolerance. What these logs cannot determine is named, with the reason
(not excited, or not told apart from what) and left where it was. Intervals hold under autocorrelated residuals.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from rovval import effects
from rovval.core.counts import counted
from rovval.core.version import __version__
from rovval.diagnose.hypotheses.hypothesis import columns_of
from rovval.diagnose.hypotheses.library import hypotheses
from rovval.diagnose.inference.hypothesis_fit import HypothesisFit
from rovval.diagnose.inference.identifiability import IdentifiableFit, Unidentified, fit_identifiable
from rovval.diagnose.inference.shrinkage import GapReduction, refitted_shrinkage, worsened_axes
from rovval.diagnose.problem.problem import Problem, corrected_residuals, pose
from rovval.diagnose.windows.multiple_shooting import cut
from rovval.fit.tunable import chosen
from rovval.plant import Plant
from rovval.vehicle.write import to_toml, with_effects

if TYPE_CHECKING:
    from rovval.core.data import Run
    from rovval.vehicle.model import Vehicle


@dataclass(frozen=True, slots=True)
class FitResult:
    """``vehicle``: TOML with the tuned parameters in its [effects]; ``document``: rovval.fit/1, which `rovval.report.fit` writes to be read."""

    vehicle: str
    document: dict[str, Any]


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
    (``quadratic_drag``), patterns with * or families (`tunable.families`). ``calibration_slop``: tolerance, relative standard
    deviation of all coefficients that are not tuned.

    Raises:
        UsageProblem: names every parameter that does not exist, or that needs `diagnose`, at once.
        BadInput: too little of a log can be simulated, or thruster inputs are missing.
    """
    say = progress or (lambda text, share: None)
    wanted = chosen(Plant(vehicle, model), parameters)
    windows, left_out = cut(runs, vehicle, model, window_s)
    library, missing = hypotheses(windows)
    plant = windows[0].plant
    why = {s: missing.get(plant.slots[s].hypothesis) or missing.get(plant.slots[s].key) for s in wanted}
    out = {s: Unidentified(reason) for s, reason in why.items() if reason}
    able = tuple(s for s in wanted if s not in out)
    say(f"simulating {counted(len(able), 'parameter')} on {counted(sum(p.count for p in windows), 'window')}", 0.1)
    names = {plant.slots[s].hypothesis for s in able}
    kept = [h for h in library if not h.displaced and (h.name in names or effects.load(h.name.partition("[")[0]).place == "sensor")]
    problem = pose(windows, columns_of(kept), calibration_slop)
    say(f"tuning {counted(len(able), 'parameter')} by re-simulation", 0.4)
    found = fit_identifiable(problem, able)
    out |= found.unidentified
    say("asking how far the gap shrinks on held-out windows", 0.9)
    document = _document(problem, found, {s: out[s] for s in wanted if s in out}, calibration_slop, seed)
    document["left_out"] = list(left_out)
    settings = document["settings"]
    return FitResult(with_effects(vehicle, settings) if settings else to_toml(vehicle), document)


def _document(
    problem: Problem, found: IdentifiableFit, undetermined: dict[int, Unidentified], tolerance: float, seed: int
) -> dict[str, Any]:
    """The document of a fit (rovval.fit/1)."""
    plant, fitted, rows = problem.plant, found.fit, dict[str, Any]()
    reduction = refitted_shrinkage(problem, fitted, corrected_residuals(problem), tolerance, seed) if fitted else GapReduction()
    for i, slot in enumerate(fitted.slots if fitted else ()):
        assert fitted is not None
        p, value, was = plant.slots[slot].parameter, float(fitted.beta[slot]), float(problem.origin[slot])
        bottom, top = max(float(found.low[i]), p.low), min(float(found.high[i]), p.high)
        rows[plant.slots[slot].key] = {
            "value": value, "low": bottom, "high": top, "unit": p.unit, "was": was,
            "at_bound": slot in fitted.at_bound, "differs": not bottom <= was <= top,
        }  # fmt: skip
    return {
        "schema": "rovval.fit/1",
        "rovval": __version__,
        "run": ", ".join(part.run.id for part in problem.runs),
        "vehicle": plant.vehicle.name,
        "vehicle_hash": plant.vehicle.hash,
        "model": plant.model,
        "window_s": round((problem.runs[0].steps + 1) * problem.runs[0].run.dt, 6),
        "windows": problem.window_count,
        "calibration_slop": tolerance,
        "parameters": rows,
        "undetermined": [_undetermined(problem, s, why) for s, why in undetermined.items()],
        "shrinkage": asdict(reduction),
        "harm": [{"axis": axis, "change": change} for axis, change in worsened_axes(reduction).items()],
        "settings": list(_settings(problem, fitted)) if fitted else [],
    }


def _undetermined(problem: Problem, slot: int, why: Unidentified) -> dict[str, Any]:
    """The row of a parameter that is left as the file has it."""
    beside = [{"parameter": name, "coherence": value} for name, value in why.beside]
    return {"parameter": problem.plant.slots[slot].key, "why": why.why, "with": beside, "left_at": float(problem.origin[slot])}


def _settings(problem: Problem, fitted: HypothesisFit) -> tuple[str, ...]:
    """Every tuned hypothesis as ``--effect`` takes it, with what the vehicle's file says of its other parameters."""
    plant, found = problem.plant, []
    for name in dict.fromkeys(plant.slots[s].hypothesis for s in fitted.slots):
        own = [s for s in plant.hypotheses[name] if s in fitted.slots or fitted.beta[s] != plant.null[s]]
        found.append(f"{name}:" + ",".join(f"{plant.slots[s].parameter.name}={float(fitted.beta[s])!r}" for s in own))
    return tuple(found)
