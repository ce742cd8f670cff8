"""A set with a stated share of healthy logs, by either plant: healthy ones, single effects each as often as any other, effects that begin in mid-log,
two at once, and effects that the library lacks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from typing import TypeVar

import numpy as np

from rovval.blind.cases.grid import Case
from rovval.blind.missions.manoeuvres import MISSIONS
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.spec import Planted, PlantName, stream
from rovval.blind.planted import catalogue as first
from rovval.blind.second import catalogue as second
from rovval.blind.second.pilots import PILOTS

HEALTHY = 0.3  # share of healthy logs unless told: 100 of them beside 150 single effects in a set of `FULL`
FULL = 360  # logs
TWO, LACKING, BEGINS = 0.15, 0.12, 0.1  # of the logs that are not healthy: two effects, one that the library lacks, one that begins in mid-log (chosen)
SEVERITY = (0.7, 2.2)  # drawn evenly between: from hard to see to plain (chosen)
T = TypeVar("T")
LATE = (0.3, 0.55)  # share of the log that has gone by when an effect begins in mid-log


@dataclass(frozen=True, slots=True)
class Kind:
    """An effect of a plant: its targets (none, names, or ``("thruster",)``), and what a severity may be."""

    name: str
    targets: tuple[str, ...]
    lacking: bool
    event: bool
    signed: bool


def kinds(plant: PlantName) -> tuple[Kind, ...]:
    """All effects of a plant."""
    if plant == "b":
        return tuple(Kind(n, f.targets, not f.known, f.event, f.both_signs) for n, f in second.catalogue().items())
    return tuple(Kind(n, e.targets, e.place == "foreign", e.event, e.least <= -SEVERITY[1]) for n, e in first.catalogue().items())


def missions(plant: PlantName) -> tuple[str, ...]:
    """Names of its missions."""
    return tuple(PILOTS) if plant == "b" else tuple(MISSIONS)


def mixed(vehicle: Path, seed: int, count: int, healthy: float, seconds: float, plant: PlantName) -> list[Case]:
    """The cases, in random order. Numbers of each sort are rounded, and none of a sort is left out of a set of ten or more."""
    rng = stream(seed, "mixed", plant)
    units = read_vehicle(vehicle).thrusters
    known, lacking = (_dealt([k for k in kinds(plant) if k.lacking == is_lacking], rng) for is_lacking in (False, True))
    lasting = _dealt([k for k in kinds(plant) if not k.lacking and not k.event and k.name != "thruster_degraded"], rng)
    sort = _counts(count, healthy)
    plans: list[tuple[Planted, ...]] = [()] * sort["healthy"]
    plans += [(_planted(next(lacking), units, rng),) for _ in range(sort["lacking"])]
    plans += [_two(known, units, rng) for _ in range(sort["two"])]
    plans += [(_planted(next(lasting), units, rng, round(seconds * float(rng.uniform(*LATE)), 1)),) for _ in range(sort["begins"])]
    plans += [(_planted(next(known), units, rng),) for _ in range(count - len(plans))]
    flown = _dealt(list(missions(plant)), rng)
    seeds = rng.choice(2**31 - 1, len(plans), replace=False)
    slop = 0.05 if plant == "b" else 0.03
    return [Case(next(flown), plans[i], int(seeds[i]), seconds, slop, plant) for i in rng.permutation(len(plans))]


def _counts(count: int, healthy: float) -> dict[str, int]:
    """Logs of each sort."""
    well = round(healthy * count)
    least = 1 if count >= 10 else 0
    return {"healthy": well, **{name: max(least, round(share * (count - well))) for name, share in (("two", TWO), ("lacking", LACKING), ("begins", BEGINS))}}


def _dealt(items: Sequence[T], rng: np.random.Generator) -> Iterator[T]:
    """Items for ever, each as often as any other: shuffled once and dealt in turn."""
    return cycle([items[i] for i in rng.permutation(len(items))])


def _two(known: Iterator[Kind], units: Sequence[str], rng: np.random.Generator) -> tuple[Planted, ...]:
    """Two effects of different names."""
    one, other = next(known), next(known)
    return _planted(one, units, rng), _planted(other, units, rng)


def _planted(kind: Kind, units: Sequence[str], rng: np.random.Generator, onset_s: float | None = None) -> Planted:
    """Target, severity and sign at random."""
    choices = units if kind.targets == ("thruster",) else kind.targets
    target = str(rng.choice(choices)) if choices else None
    sign = float(rng.choice([-1.0, 1.0])) if kind.signed else 1.0
    return Planted(kind.name, target, round(sign * float(rng.uniform(*SEVERITY)), 3), onset_s)
