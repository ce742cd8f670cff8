"""Where the search for an effect begins.

Linearisation at the null value does not see a period, an onset or a place, and no slope leads from nothing to what is large or caught. An
effect with such parameters enters once for each of a few starting points; which one is best is part of the contest.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from rovval import effects
from rovval.diagnose.criteria import PRIOR_WIDTH
from rovval.diagnose.hypotheses.holding import holding, somewhere
from rovval.diagnose.hypotheses.hypothesis import Hypothesis, beginning
from rovval.diagnose.windows.shooting import Stretches
from rovval.plant import Plant

ONSETS = 9  # starting points for an onset, evenly inside the log
LEVER = 0.7  # of the furthest thruster's distance: where a force may act (chosen)
DEPTHS = (0.25, 0.5, 0.75)  # quantiles of a log's depth where what changes with depth may have its datum (chosen)
LINES = 3  # periods that an effect begins from
MOST_STARTS = 12  # of a hypothesis with several such parameters; thrice as many of one whose starts cost a single simulation each
BREAKS = 2  # that an onset begins from


def starts(
    plant: Plant, name: str, effect: effects.Effect, slots: tuple[int, ...], parts: Sequence[Stretches], next_id: int,
    periods: Mapping[float | None, Sequence[float]], breaks_s: Sequence[float], held: Sequence[Mapping[str, float]],
) -> list[Hypothesis]:  # fmt: skip
    """One hypothesis, or one for each starting point of the parameters that linearisation at the null value cannot see."""
    if effect.has("anchor"):
        return holding(plant, name, slots, held or [somewhere(parts, plant, slots)], next_id)
    grids = _grids(plant, effect, slots, parts, periods.get(None, ()), breaks_s)
    if not grids:
        far = _far(plant, name, effect, slots, next_id)
        return [*_near(plant, name, effect, slots), *_alone(plant, name, effect, slots), *far, *_levers(plant, name, effect, slots, next_id + len(far))]
    by_role: dict[str, int] = {plant.slots[s].parameter.role: s for s in slots}
    own = tuple(s for s in slots if s not in grids and plant.slots[s].parameter.name not in effect.refines) or (-1,)
    points, most = [dict(zip(grids, point, strict=True)) for point in product(*grids.values())], MOST_STARTS * (3 if own == (-1,) else 1)
    chosen = points if len(points) <= most else [points[i] for i in np.linspace(0, len(points) - 1, most).astype(int)]
    chosen = [point | _met(by_role, point, periods) for point in chosen]
    return [beginning(plant, f"{name}@{i}", slots, own, tuple(at.items()), next_id + i * len(own)) for i, at in enumerate(chosen)]


def _met(by_role: Mapping[str, int], point: Mapping[int, float], periods: Mapping[float | None, Sequence[float]]) -> dict[int, float]:
    """The period that waves have which run where those of a starting point do: a vehicle under way meets them at another one."""
    of_waves = periods.get(point.get(by_role.get("direction", -1)), ()) if "period" in by_role and "direction" in by_role else ()
    return {by_role["period"]: of_waves[0]} if of_waves else {}


def _near(plant: Plant, name: str, effect: effects.Effect, slots: tuple[int, ...]) -> list[Hypothesis]:
    """All parameters from the null value; where some only refine the others, these without them first, and not with them where each of them is tried
    alone: an axis on which nothing moves would take up whatever is left."""
    plain = tuple(s for s in slots if plant.slots[s].parameter.name not in effect.refines)
    sets = {name: plain} | ({f"{name}@fine": slots} if len(plain) < len(slots) and not effect.separable else {})
    return [Hypothesis(name, label, free, free, tuple(PRIOR_WIDTH * plant.slots[s].parameter.typical for s in free)) for label, free in sets.items()]


def _alone(plant: Plant, name: str, effect: effects.Effect, slots: tuple[int, ...]) -> list[Hypothesis]:
    """Each parameter without the others, where they may be apart: three that are free for one that is off are evidence lost."""
    chosen = [(s, plant.slots[s].parameter) for s in slots if effect.separable]
    return [Hypothesis(name, f"{name}@{p.name}", (s,), (s,), (PRIOR_WIDTH * p.typical,)) for s, p in chosen]


def _far(plant: Plant, name: str, effect: effects.Effect, slots: tuple[int, ...], next_id: int) -> list[Hypothesis]:
    """Starting points well away from the null value: a vehicle that tumbles in simulation shows no useful slope of its trim there, nor do
    commands that came a second late and step from one level to the next; a lag of half a second is no multiple of a short one."""
    found = list[Hypothesis]()
    for slot in slots:
        p = plant.slots[slot].parameter
        for value in (p.null + size * p.typical for size in effect.far):
            if p.low <= value <= p.high:
                found.append(beginning(plant, f"{name}@far{len(found)}", slots, (-1,), ((slot, value),), next_id + len(found)))
    return found


def _levers(plant: Plant, name: str, effect: effects.Effect, slots: tuple[int, ...], next_id: int) -> list[Hypothesis]:
    """Starting points with the force well away from the origin, `LEVER` of the thrusters' reach ahead or astern: a force that is not there
    yet turns nothing, wherever it would act, and once it is there the other levers show."""
    levers = [s for s in slots if plant.slots[s].parameter.role == "lever"]
    if not levers:
        return []
    own, p = tuple(s for s in slots if s not in levers), plant.slots[levers[0]].parameter
    reach = LEVER * max(float(np.linalg.norm(t.position)) for t in plant.vehicle.thruster)
    ends = [((levers[0], float(np.clip(x, p.low, p.high))),) for x in (-reach, reach)]
    return [beginning(plant, f"{name}@lever{i}", slots, own, at, next_id + i * len(own)) for i, at in enumerate(ends)]


def _depths(parts: Sequence[Stretches]) -> tuple[float, ...]:
    """Depths (m, down) high, in the middle and low in what the logs went through: a datum far outside makes a change with depth look like a constant."""
    z = np.concatenate([part.eta0[:, 2] for part in parts])
    return tuple(dict.fromkeys(float(d) for d in np.quantile(z, DEPTHS)))


def _onsets(parts: Sequence[Stretches], breaks_s: Sequence[float]) -> tuple[float, ...]:
    """Onsets (s) at the first breaks of the first log, and others spread over it, `MOST_STARTS` in all."""
    first, last = float(parts[0].start[0]), float(parts[0].start[-1])
    near = [t for t in breaks_s[:BREAKS] if t > first * parts[0].run.dt]
    spread = min(ONSETS, MOST_STARTS - len(near))
    share = np.arange(1, spread + 1) / (spread + 1)
    return (*near, *(float((first + (last - first) * s) * parts[0].run.dt) for s in share))


def _grids(
    plant: Plant, effect: effects.Effect, slots: tuple[int, ...], parts: Sequence[Stretches], periods: Sequence[float], breaks_s: Sequence[float]
) -> dict[int, tuple[float, ...]]:
    """Starting values by slot: onsets spread over the log and at its breaks, the best of ``periods`` as far as `MOST_STARTS` lets them, other grids as the
    effect states them, held within the bounds."""
    found = {}
    for slot in slots:
        parameter = plant.slots[slot].parameter
        if parameter.role == "onset":
            found[slot] = _onsets(parts, breaks_s)
        elif parameter.role == "datum":
            found[slot] = _depths(parts)
        elif parameter.starts:
            found[slot] = tuple(v for v in parameter.starts if parameter.low <= v <= parameter.high)
            if parameter.role == "period" and (here := [p for p in periods if parameter.low <= p <= parameter.high]):
                others = int(np.prod([len(p.starts) for p in effect.parameters if p.starts and p.role != "period"]))
                found[slot] = tuple(here[: min(LINES, max(MOST_STARTS // others, 1))])
    return {slot: values for slot, values in found.items() if values}
