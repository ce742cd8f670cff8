"""The hypotheses that compete for a log: every effect of the library on every axis and thruster, but for what the log cannot show at all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval import effects
from rovval.core.channels import channel
from rovval.diagnose.hypotheses.change_points import gap_change_points
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, columns_of
from rovval.diagnose.hypotheses.initial_points import Hints, Target, initial_points
from rovval.diagnose.hypotheses.missing_wrench import missing_wrench
from rovval.diagnose.hypotheses.snag import Spring, springs
from rovval.diagnose.hypotheses.spectrum import spectral_lines, wave_periods
from rovval.diagnose.hypotheses.towed_line import Line, towed_line
from rovval.diagnose.inference.laplace import Posterior
from rovval.diagnose.problem.problem import Problem
from rovval.diagnose.windows.windows import Windows

NO_HINTS = Hints()


def hypotheses(windows: Sequence[Windows], without: Sequence[str] = (), hints: Hints = NO_HINTS) -> tuple[list[Hypothesis], dict[str, str]]:
    """(The competing hypotheses, reason by name of effects and parameters that these logs cannot test).

    Args:
        windows: of each log; all of one vehicle.
        without: effects (``inflow_loss``) or hypotheses (``thruster_degraded[HFP]``) to leave out.
        hints: where the logs suggest that fits begin.
    """
    plant, found, untestable = windows[0].plant, list[Hypothesis](), dict[str, str]()
    for name, slots in plant.hypotheses.items():
        effect = effects.load(name.partition("[")[0])
        if not effect.competes or {name, effect.name} & set(without):
            continue
        if why := _untestable(effect, windows):
            untestable[name] = why
            continue
        needless = [plant.slots[s].key for s in slots if (c := plant.slots[s].parameter.instead_of) and _logged(windows, c)]
        for slot in (plant.slots[s] for s in slots):
            if slot.key not in needless and (c := slot.parameter.needs) and not _logged(windows, c):
                untestable[slot.key] = f"needs {c}, which this log does not hold"
        own = tuple(s for s in slots if plant.slots[s].key not in (*untestable, *needless))
        if own:
            next_id = len(plant.slots) + len(columns_of(found).displaced)
            found.extend(initial_points(Target(plant, name, effect, own), windows, hints, next_id))
    return found, untestable


def _untestable(effect: effects.Effect, windows: Sequence[Windows]) -> str:
    """Why the logs cannot test an effect: a channel that it needs is missing, or never near enough, or the water that would have to move stands still by the
    word of their source; "" where they can."""
    if effect.place == "water" and all(part.run.properties.get("water") == "still" for part in windows):
        return "the water stands still, as the profile of these logs says"
    if missing := [c for c in effect.needs if not _logged(windows, c)]:
        return f"needs {', '.join(missing)}, which this log does not hold"
    if effect.needs_one_of and not any(_logged(windows, c) for c in effect.needs_one_of):
        return f"needs one of {', '.join(effect.needs_one_of)}, and this log holds none"
    for p in (p for p in effect.parameters if p.instead_of):
        if not any(_logged(windows, c) for c in (p.instead_of, p.needs) if c):
            return f"needs {p.instead_of} or {p.needs}, and this log holds neither"
    far = [f"no {c} below {reach:g} {channel(c).unit}" for c, reach in effect.within.items() if _logged(windows, c) and _lowest(windows, c) >= reach]
    return f"{', '.join(far)} in this log" if far else ""


def _logged(windows: Sequence[Windows], name: str) -> bool:
    return all(part.run.measured(name) for part in windows)


def _lowest(windows: Sequence[Windows], name: str) -> float:
    return min(float(np.nanmin(part.run.get(name))) for part in windows)


def initialised(problem: Problem, library: Sequence[Hypothesis], healthy: Posterior) -> list[Hypothesis]:
    """The hypotheses of a library with the initial points that the log suggests: what oscillates at the periods of the residual about ``healthy``, the
    vehicle with its coefficients within tolerance; what begins during the log where that begins to err; a spring that holds the vehicle, and
    a line that it drags along, where the missing forces point."""
    names = {h.name for h in library}
    hints = Hints(_periods(problem, names, healthy), gap_change_points(problem), *_held_and_towed(problem, library))
    fresh, _ = hypotheses(problem.runs, hints=hints)
    return [h for h in fresh if h.name in names]


def _held_and_towed(problem: Problem, library: Sequence[Hypothesis]) -> tuple[list[Spring], Line | None]:
    """Springs that may hold the vehicle, and the line that it may drag along, by the forces that are missing; as far as effects of the library ask for them."""
    held, towed = any(h.effect.has("anchor") for h in library), any(h.effect.towed for h in library)
    if not held and not towed:
        return [], None
    lack = missing_wrench(problem.runs[0], problem.nominal[0], problem.origin, problem.gap.variance)
    return springs(problem, lack) if held else [], towed_line(lack) if towed else None


def _periods(problem: Problem, names: set[str], healthy: Posterior) -> dict[float | None, Sequence[float]]:
    """Periods of the residual (s); those of waves by the direction towards which they run."""
    encounter = [period for period, _ in spectral_lines(problem, healthy)]
    periods: dict[float | None, Sequence[float]] = {None: encounter}
    for slot in problem.plant.slots:
        p, effect = slot.parameter, effects.load(slot.effect)
        towards, trains = [d for p in effect.parameters if p.role == "direction" for d in p.starts], 1 + len(effect.names_of("further period"))
        if p.role == "period" and towards and slot.hypothesis in names:
            periods |= wave_periods(problem, healthy, encounter, (p.low, p.high), towards, trains)
    return periods
