"""Slots: every parameter of every effect for one vehicle, axes and thrusters spelt out, in a fixed order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.core.channels import AXES
from rovval.core.did_you_mean import suggestion
from rovval.core.errors import UsageProblem, all_at_once
from rovval.effects import Parameter
from rovval.effects.lanes import reference_drag_force, reference_speed
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]

# The vehicle for which effects with sized parameters give their numbers: BlueROV2 Heavy, 13.5 kg; 154.7 N of drag and
# 64.4 rev/s at 1 m/s ahead.
REFERENCE_WEIGHT = 132.57
REFERENCE_DRAG = 154.7
REFERENCE_SPEED = 64.43


@dataclass(frozen=True, slots=True)
class Slot:
    """One number of a lane's parameter vector: ``quadratic_drag[surge].scale``."""

    key: str
    hypothesis: str
    effect: str
    target: str
    parameter: Parameter


def sizes(vehicle: Vehicle) -> Mapping[str, float]:
    """Factors from the reference vehicle to this one, by what a parameter grows with."""
    return MappingProxyType(
        {
            "": 1.0,
            "weight": vehicle.weight / REFERENCE_WEIGHT,
            "length": float(np.cbrt(vehicle.weight / REFERENCE_WEIGHT)),
            "drag": reference_drag_force(vehicle) / REFERENCE_DRAG,
            "speed": reference_speed(vehicle) / REFERENCE_SPEED,
        }
    )


def targets(effect: effects.Effect, thrusters: tuple[str, ...]) -> tuple[str, ...]:
    """Axes, groups of axes, or ``thrusters`` that the effect's parameters belong to; one empty name for an effect that has neither."""
    return {"": ("",), "axis": (*effect.axes, *effect.groups), "thruster": thrusters}[effect.per]


def slots(vehicle: Vehicle, model: str) -> tuple[Slot, ...]:
    """Every slot of the library for a vehicle."""
    return _slots(vehicle.thrusters, tuple(sizes(vehicle).items()), model)


@lru_cache(maxsize=16)  # the vehicles that a calibration tries are mostly of one size
def _slots(thrusters: tuple[str, ...], factors: tuple[tuple[str, float], ...], model: str) -> tuple[Slot, ...]:
    """Every slot for a vehicle with these ``thrusters`` that is larger than the reference vehicle by the ``factors``."""
    found, factor = [], dict(factors)
    for name in effects.names():
        effect = effects.load(name)
        for target in targets(effect, thrusters):
            for parameter in effect.parameters:
                hypothesis = _hypothesis(name, target or parameter.target)
                sized = grown(parameter, factor[parameter.sized])
                if model in effect.absent_in:
                    sized = replace(sized, low=0.0)  # there is nothing to take away
                if target in effect.groups:
                    sized = replace(sized, tolerance=None)  # it is the axes' own, one by one
                found.append(Slot(f"{hypothesis}.{parameter.name}", hypothesis, name, target or parameter.target, sized))
    return tuple(found)


def grown(parameter: Parameter, factor: float) -> Parameter:
    """A parameter of a vehicle that is larger by ``factor`` in what it grows with."""
    low, high, null, typical = (factor * x for x in (parameter.low, parameter.high, parameter.null, parameter.typical))
    return replace(parameter, low=low, high=high, null=null, typical=typical, starts=tuple(factor * x for x in parameter.starts))


def _hypothesis(name: str, target: str) -> str:
    return f"{name}[{target}]" if target else name


def gather(vehicle: Vehicle, index: Mapping[str, int], name: str, beta: Array) -> dict[str, Array]:
    """One effect's parameters out of ``beta`` (B, K): (B,), (B, 6) per axis with the null value on axes without, (B, k); a parameter with a target under
    ``delay[velocity]``."""
    effect = effects.load(name)
    values: dict[str, Array] = {}
    for parameter in effect.parameters:
        if effect.per == "":
            values[_hypothesis(parameter.name, parameter.target)] = beta[:, index[f"{_hypothesis(name, parameter.target)}.{parameter.name}"]]
        elif effect.per == "thruster":
            values[parameter.name] = beta[:, [index[f"{name}[{t}].{parameter.name}"] for t in vehicle.thrusters]]
        else:
            full = np.full((len(beta), 6), parameter.null)
            for axis in effect.axes:
                full[:, AXES.index(axis)] = beta[:, index[f"{name}[{axis}].{parameter.name}"]]
            for group, members in effect.groups.items():
                at, more = [AXES.index(axis) for axis in members], beta[:, [index[f"{name}[{group}].{parameter.name}"]]]
                full[:, at] += more + full[:, at] * more
            values[parameter.name] = full
    return values


def check_bounds(found: Sequence[Slot], beta: Array) -> None:
    """Refuse parameters beyond their bounds or not finite, every one by name."""
    low, high = np.array([s.parameter.low for s in found]), np.array([s.parameter.high for s in found])
    with np.errstate(invalid="ignore"):
        wrong = ~((beta >= low) & (beta <= high))
    columns = [int(c) for c in np.flatnonzero(wrong.any(axis=0))]
    if columns:
        problems = []
        for c in columns:
            p, values = found[c].parameter, beta[wrong[:, c], c]
            problems.append(f"{found[c].key} = {_value(values[0], p)}, allowed {p.low:.6g} to {p.high:.6g}")
        raise UsageProblem(all_at_once(problems, "effect parameters out of bounds"), "see `rovval show effect NAME`")


def parse(found: Sequence[Slot], index: Mapping[str, int], null: Array, settings: Sequence[str]) -> Array:
    """(K,) vector of settings like ``inflow_loss:loss=0.3`` or ``thruster_degraded[HFP]:loss=0.4,...``; every problem at once."""
    beta, problems, given = null.copy(), list[str](), set[int]()
    hypotheses = {s.hypothesis for s in found}
    for setting in settings:
        hypothesis, _, pairs = setting.partition(":")
        hypothesis = hypothesis.strip()
        if hypothesis not in hypotheses:
            problems.append(_unknown(hypothesis, hypotheses, setting))
            continue
        known = [s.parameter.name for s in found if s.hypothesis == hypothesis]
        for pair in pairs.split(","):
            name, equals, value = (part.strip() for part in pair.partition("="))
            if name not in known or not equals:
                problems.append(f"{setting!r}: {hypothesis} has {', '.join(known)}; write {hypothesis}:{known[0]}=VALUE")
                continue
            try:
                number = float(value)
            except ValueError:
                problems.append(f"{setting!r}: {value!r} is not a number")
                continue
            column = index[f"{hypothesis}.{name}"]
            p = found[column].parameter
            if column in given:
                problems.append(f"{hypothesis}.{name} is given twice, {_value(beta[column], p)} and {_value(number, p)}")
            given.add(column)
            if not p.low <= number <= p.high:
                problems.append(f"{hypothesis}.{name} = {_value(number, p)}, allowed {p.low:.6g} to {p.high:.6g}")
            beta[column] = number
    if problems:
        raise UsageProblem(all_at_once(problems, "--effect"), "see `rovval list effect` and `rovval show effect NAME`")
    return beta


def _value(number: float, parameter: Parameter) -> str:
    return f"{number:.6g} {parameter.unit}".removesuffix(" 1")


def _unknown(hypothesis: str, known: set[str], setting: str) -> str:
    name = hypothesis.partition("[")[0]
    if name in effects.names():
        return f"{setting!r}: {name} belongs to one of: {', '.join(sorted(h for h in known if h.partition('[')[0] == name))}"
    return f"{setting!r}: no effect named {name!r}; {suggestion(name, effects.names(), '`rovval list effect`')}"
