"""The hypotheses that compete for a log: every effect of the library on every axis and thruster, those that it cannot show left out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from rovval import effects
from rovval.core.channels import channel
from rovval.diagnose.hypotheses.change_points import breaks
from rovval.diagnose.hypotheses.hypothesis import Hypothesis
from rovval.diagnose.hypotheses.initial_points import starts
from rovval.diagnose.hypotheses.snag import caught
from rovval.diagnose.hypotheses.spectrum import lines, waves
from rovval.diagnose.inference.laplace import Point
from rovval.diagnose.inference.problem import Problem
from rovval.diagnose.windows.shooting import Stretches

NO_PERIODS: Mapping[float | None, Sequence[float]] = MappingProxyType({})


def hypotheses(
    parts: Sequence[Stretches], without: Sequence[str] = (), periods: Mapping[float | None, Sequence[float]] = NO_PERIODS, breaks_s: Sequence[float] = (),
    held: Sequence[Mapping[str, float]] = (),
) -> tuple[list[Hypothesis], dict[str, str]]:
    """The competing hypotheses, and those that this log cannot test with the reason.

    ``without`` names effects (``inflow_loss``) or hypotheses (``thruster_degraded[HFP]``) to leave out; ``periods`` (s; of waves by the direction
    towards which they run, None for what does not travel) and ``breaks_s`` (s since the first run's start), the most promising first, are where
    those that swing and those that begin during the log begin; ``held`` where that which holds the vehicle does, by parameter.
    """
    plant, found, untestable = parts[0].plant, list[Hypothesis](), dict[str, str]()

    def logged(channel: str) -> bool:
        return all(part.run.measured(channel) for part in parts)

    def nearest(channel: str) -> float:
        return min(float(np.nanmin(part.run.get(channel))) for part in parts)

    for name, slots in plant.hypotheses.items():
        effect = effects.load(name.partition("[")[0])
        if not effect.competes or {name, effect.name} & set(without):
            continue
        missing = [c for c in effect.needs if not logged(c)]
        if missing:
            untestable[name] = f"needs {', '.join(missing)}, which this log does not hold"
            continue
        far = [f"no {c} below {reach:g} {channel(c).unit}" for c, reach in effect.within.items() if nearest(c) >= reach]
        if far:
            untestable[name] = f"{', '.join(far)} in this log"
            continue
        for slot in (plant.slots[s] for s in slots):
            if (c := slot.parameter.needs) and not logged(c):
                untestable[slot.key] = f"needs {c}, which this log does not hold"
        slots = tuple(s for s in slots if plant.slots[s].key not in untestable)
        if not slots:
            continue
        next_id = len(plant.slots) + sum(len(h.directions) for h in found)
        found.extend(starts(plant, name, effect, slots, parts, next_id, periods, breaks_s, held))
    return found, untestable


def retuned(problem: Problem, library: list[Hypothesis], point: Point) -> list[Hypothesis]:
    """The library with what swings begun at the periods at which the residual about ``point`` swings most, and what begins during the log
    where the log begins to err; what holds the vehicle where the forces that are missing lead."""
    kept = {h.name for h in library}
    met = [period for period, _ in lines(problem, point)]
    periods: dict[float | None, Sequence[float]] = {None: met}
    for slot in problem.plant.slots:
        p, towards = slot.parameter, [d for p in effects.load(slot.effect).parameters if p.role == "direction" for d in p.starts]
        if p.role == "period" and towards and slot.hypothesis in kept:
            periods |= waves(problem, point, met, (p.low, p.high), towards)
    held = caught(problem) if any(h.effect.has("anchor") for h in library) else []
    fresh, _ = hypotheses(problem.parts, periods=periods, breaks_s=breaks(problem), held=held)
    return [h for h in fresh if h.name in kept]
