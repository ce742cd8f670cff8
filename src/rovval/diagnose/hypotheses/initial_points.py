"""Where the fit of an effect begins.

A linearisation at no effect does not see a period, an onset or a place, and no slope leads from there to what is large. An effect with such
parameters enters once for each of a few initial points (multi-start); which one is best is part of the comparison of hypotheses.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from rovval import effects
from rovval.diagnose.effort import (
    CHANGE_STARTS,
    DATUM_QUANTILES,
    LEVER_SHARE,
    MOST_STARTS,
    ONSET_STARTS,
    PERIOD_STARTS,
    SPEED_QUANTILES,
    WHOLE_STARTS,
)
from rovval.diagnose.hypotheses.hypothesis import START_SCALE, Hypothesis, columns_of, displaced, from_nothing
from rovval.diagnose.hypotheses.snag import from_pulls, from_springs, mid_log_spring
from rovval.diagnose.hypotheses.towed_line import from_line
from rovval.diagnose.problem.prior import prior_mean, wide_sd
from rovval.diagnose.windows.windows import Windows
from rovval.plant import Plant


@dataclass(frozen=True, slots=True)
class Hints:
    """Where a log itself suggests that fits begin, the most promising first.

    Attributes:
        periods: periods (s) at which the residual oscillates; those of waves by the direction (rad from north) towards which they run, None for
            what does not travel.
        changes_s: times (s since the first run's start) at which its windows begin to err more, or less.
        springs: what may hold the vehicle, as parameters of `tether_snag`, with the ``share`` of the gap that it takes.
        line: what the vehicle may drag along (`towed_line`).
    """

    periods: Mapping[float | None, Sequence[float]] = field(default_factory=dict)
    changes_s: Sequence[float] = ()
    springs: Sequence[Mapping[str, float]] = ()
    line: Mapping[str, float] | None = None


@dataclass(frozen=True, slots=True)
class Target:
    """One effect on one axis or thruster of a plant: its ``name`` as in ``--effect``, and the ``slots`` of its parameters that the log can show."""

    plant: Plant
    name: str
    effect: effects.Effect
    slots: tuple[int, ...]

    def parameter(self, slot: int) -> effects.Parameter:
        """The parameter of a slot."""
        return self.plant.slots[slot].parameter


def initial_points(target: Target, windows: Sequence[Windows], hints: Hints, next_id: int) -> list[Hypothesis]:
    """One hypothesis, or one for each initial point of the parameters that a linearisation at no effect cannot see; their columns are numbered from
    ``next_id`` on."""
    plant, name, effect, slots = target.plant, target.name, target.effect, target.slots
    placed = _placed(target, windows)
    if effect.has("anchor"):
        return from_springs(plant, name, slots, hints.springs or [mid_log_spring(windows, plant, slots)], next_id)
    grids = _grids(target, windows, hints)
    if not grids:
        far = _away_from_no_effect(target, next_id)
        plain = [replace(h, at=tuple(placed.items())) for h in (*_from_no_effect(target, placed), *_one_at_a_time(target))]
        levers = _with_levers(target, placed, next_id + len(far))
        after = next_id + len(columns_of([*far, *levers]).displaced)
        depth = next((value for s, value in placed.items() if target.parameter(s).role == "level"), None)
        pulls = from_pulls(plant, name, slots, hints.springs, depth, after) if effect.held and depth is not None else []
        towed = [from_line(plant, name, slots, hints.line, depth, after)] if effect.towed and hints.line and depth is not None else []
        return [*plain, *far, *levers, *pulls, *towed]
    free = tuple(s for s in _plain_and_fine(target)[""] if s not in grids and s not in placed) or (START_SCALE,)
    points = [dict(zip(grids, point, strict=True)) for point in product(*grids.values())]
    most = WHOLE_STARTS if free == (START_SCALE,) else MOST_STARTS
    chosen = points if len(points) <= most else [points[i] for i in np.linspace(0, len(points) - 1, most).astype(int)]
    found = list[Hypothesis]()
    for i, point in enumerate(chosen):
        found += _begun(target, f"{name}@{i}", free, placed | point, hints, next_id + len(columns_of(found).displaced))
    return found


def _begun(target: Target, label: str, free: tuple[int, ...], at: Mapping[int, float], hints: Hints, next_id: int) -> list[Hypothesis]:
    """The hypothesis that begins ``at`` some point. Waves begin at the period of those that run in its direction, since a vehicle under way sees them at
    their period of encounter, which is another; and a second time with as many further trains as there are further periods, their sizes free as well. What has
    other parameters that only refine it begins a second time with them, by the slopes that they have at no effect."""
    by_role = {target.parameter(s).role: s for s in target.slots}
    trains = [s for s in target.slots if target.parameter(s).role == "further period"]
    lines = hints.periods.get(at.get(by_role.get("direction", -1)), ()) if {"period", "direction"} <= set(by_role) else ()
    first = {**at, **({by_role["period"]: lines[0]} if lines else {})}
    plain = _plain_and_fine(target)[""]
    alone = tuple(s for s in target.slots if s in plain or s in at)
    found = [displaced(target.plant, label, alone, free, tuple(first.items()), next_id)]
    refined = tuple(s for s in target.slots if s not in alone)
    if further := dict(zip(trains, lines[1:], strict=False)):
        used = refined[: len(refined) // len(trains) * len(further)]  # train by train
        sizes = (*free, *(s for s in used if s not in trains))
        found.append(displaced(target.plant, f"{label} further", (*alone, *used), sizes, (*first.items(), *further.items()), next_id + len(free)))
    elif refined and not trains:
        columns, sd = (*found[0].columns, *refined), (*found[0].sd, *wide_sd(target.plant, refined).values())
        found.append(replace(found[0], label=f"{label} fine", slots=(*alone, *refined), columns=columns, sd=sd))
    return found


def _placed(target: Target, windows: Sequence[Windows]) -> dict[int, float]:
    """Depths that an effect is placed at wherever its search begins, by slot: what the logs say of them (`prior_mean`)."""
    parameters = ((s, target.parameter(s)) for s in target.slots)
    return {s: prior_mean(p, windows, p.null) for s, p in parameters if p.role in ("level", "bottom")}


def _from_no_effect(target: Target, placed: Mapping[int, float]) -> list[Hypothesis]:
    """All parameters from no effect; where some only refine the others, these without them first, and not with them where each of them is tried
    alone: an axis on which nothing moves would fit whatever is left."""
    found = list[Hypothesis]()
    for kind, slots in _plain_and_fine(target).items():
        if not (kind and target.effect.separable):
            label, free = f"{target.name}@{kind}" if kind else target.name, tuple(s for s in slots if s not in placed)
            found.append(replace(from_nothing(target.plant, target.name, label, free), slots=slots))
    return found


def _one_at_a_time(target: Target) -> list[Hypothesis]:
    """Each parameter without the others, where the effect is separable: three that are free for one that is off cost evidence."""
    each = [(s, f"{target.name}@{target.parameter(s).name}") for s in target.slots if target.effect.separable]
    return [from_nothing(target.plant, target.name, label, (s,)) for s, label in each]


def _away_from_no_effect(target: Target, next_id: int) -> list[Hypothesis]:
    """Initial points well away from no effect: a vehicle that tumbles in simulation shows no useful slope of its trim there, nor do
    commands that came a second late and step from one level to the next; a lag of half a second is no multiple of a short one."""
    found = list[Hypothesis]()
    for slot in target.slots:
        p = target.parameter(slot)
        for value in (p.null + size * p.typical for size in target.effect.far):
            if p.low <= value <= p.high:
                label = f"{target.name}@far{len(found)}"
                found.append(displaced(target.plant, label, target.slots, (START_SCALE,), ((slot, value),), next_id + len(found)))
    return found


def _with_levers(target: Target, placed: Mapping[int, float], next_id: int) -> list[Hypothesis]:
    """Initial points with the force well away from the origin, ahead and astern by `LEVER_SHARE` of the thrusters' reach: a force that is not there
    yet has no moment, wherever it would act; once it is there its other levers have a slope. Without the parameters that only refine the others, and with
    them: what a log shows of where a force acts it may show of nothing else."""
    lever = next((s for s in target.slots if target.parameter(s).role == "lever"), None)
    if lever is None:
        return []
    p, reach, found = target.parameter(lever), LEVER_SHARE * target.plant.vehicle.longest_arm, list[Hypothesis]()
    for kind, slots in _plain_and_fine(target).items():
        free = tuple(s for s in slots if target.parameter(s).role != "lever" and s not in placed)
        for i, x in enumerate((-reach, reach)):
            at = ((lever, float(np.clip(x, p.low, p.high))), *((s, value) for s, value in placed.items() if s in slots))
            found.append(displaced(target.plant, f"{target.name}@{kind}lever{i}", slots, free, at, next_id + len(columns_of(found).displaced)))
    return found


def _plain_and_fine(target: Target) -> dict[str, tuple[int, ...]]:
    """The slots without the parameters that only refine the others, and all of them, by the label of each; all of them, where none only refines."""
    plain = tuple(s for s in target.slots if target.parameter(s).name not in target.effect.refines)
    return {"": plain} | ({"fine": target.slots} if len(plain) < len(target.slots) else {})


def _depths(datum: effects.Parameter, windows: Sequence[Windows]) -> tuple[float, ...]:
    """Depths (m, down) high, in the middle and low in what the logs went through, and its typical size above and below all of that: a datum outside makes a
    change with depth look like a constant, which is all that a vehicle shows which keeps its depth."""
    z = np.concatenate([part.eta0[:, 2] for part in windows])
    depths = (*np.quantile(z, DATUM_QUANTILES), z.min() - datum.typical, z.max() + datum.typical)
    return tuple(dict.fromkeys(datum.within(float(d)) for d in depths))


def _speeds(target: Target, windows: Sequence[Windows]) -> tuple[float, ...]:
    """Shaft speeds (rev/s) slow, middling and fast among those at which a thruster turns in the logs, or all do: a threshold below all of them changes
    nothing, and above all of them it makes a dead thruster. None where it stands still."""
    own = [i for i, thruster in enumerate(target.plant.vehicle.thrusters) if target.name == f"{target.effect.name}[{thruster}]"]
    speed = np.abs(np.concatenate([part.actuation.inputs.speed[part.actuation.known] for part in windows])[:, own or slice(None)])
    turning = speed[speed > 0.0]
    return tuple(dict.fromkeys(float(n) for n in np.quantile(turning, SPEED_QUANTILES))) if turning.size else ()


def _onsets(windows: Sequence[Windows], changes_s: Sequence[float]) -> tuple[float, ...]:
    """Onsets (s since the first run's start) at its first changes, and others spread over it, `MOST_STARTS` in all."""
    first, last = float(windows[0].start[0]), float(windows[0].start[-1])
    near = [t for t in changes_s[:CHANGE_STARTS] if t > first * windows[0].run.dt]
    spread = min(ONSET_STARTS, MOST_STARTS - len(near))
    share = np.arange(1, spread + 1) / (spread + 1)
    return (*near, *(float((first + (last - first) * s) * windows[0].run.dt) for s in share))


def _grids(target: Target, windows: Sequence[Windows], hints: Hints) -> dict[int, tuple[float, ...]]:
    """Initial values by slot: onsets over the log and at its changes, depths within and about those of the log, shaft speeds within its own, the best periods
    as far as `MOST_STARTS` lets them, and other grids as the effect states them, held within the bounds."""
    found, periods = {}, hints.periods.get(None, ())
    for slot in target.slots:
        parameter = target.parameter(slot)
        if parameter.role == "onset":
            found[slot] = _onsets(windows, hints.changes_s)
        elif parameter.role == "datum":
            found[slot] = _depths(parameter, windows)
        elif parameter.role == "threshold":
            found[slot] = tuple(parameter.within(speed) for speed in _speeds(target, windows))
        elif parameter.starts:
            found[slot] = tuple(v for v in parameter.starts if parameter.low <= v <= parameter.high)
            if parameter.role == "period" and (here := [p for p in periods if parameter.low <= p <= parameter.high]):
                others = int(np.prod([len(p.starts) for p in target.effect.parameters if p.starts and p.role != "period"]))
                most = 1 if target.effect.has("direction") else min(PERIOD_STARTS, max(MOST_STARTS // others, 1))  # waves have one for each direction
                found[slot] = tuple(here[:most])
    return {slot: values for slot, values in found.items() if values}
