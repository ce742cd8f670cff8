"""The standard set of cases: healthy logs, every effect alone, foreign effects, twos and threes, effects that begin in mid-log, over all missions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from rovval.blind.missions.manoeuvres import MISSIONS
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.spec import Planted, PlantName, stream
from rovval.blind.planted.catalogue import Entry, catalogue, names

SINGLES = (("rich", 1.0), ("rich", 2.0), ("survey", 1.0), ("", 1.5))  # mission ("" = the others in turn) and severity
DURATION_S = 300.0
AXES_A_CASE = 3  # targets of an axis effect taken in turn
BEGIN, BEGINS = 24, (0.3, 0.55)  # logs of a set with an effect that begins during the log, and which shares of it have gone by then


@dataclass(frozen=True, slots=True)
class Case:
    """One log to make."""

    mission: str
    effects: tuple[Planted, ...]
    seed: int
    duration_s: float = DURATION_S
    slop: float = 0.03
    plant: PlantName = "a"


def _targets(entry: Entry, thrusters: Sequence[str], rng: np.random.Generator) -> list[str | None]:
    """Which targets a single effect is flown with: up to three axes, two thrusters, or none."""
    if entry.targets == ("thruster",):
        return [str(x) for x in rng.choice(thrusters, 2, replace=False)]
    return list(entry.targets[:AXES_A_CASE]) or [None]


def draw_planted(name: str, target: str | None, severity: float, rng: np.random.Generator) -> Planted:
    """One planting; the sign is drawn where it means something, the size varies by a fifth."""
    least = catalogue()[name].least
    sign = float(rng.choice([-1.0, 1.0])) if least < 0.0 else 1.0
    return Planted(name, target, round(max(least, sign * severity * float(rng.uniform(0.8, 1.2))), 3))


def grid(vehicle: Path, seed: int, repeats: int = 1, nulls: int = 8) -> list[Case]:
    """The cases, shuffled; every flight has a seed of its own."""
    rng = stream(seed, "grid")
    thrusters = read_vehicle(vehicle).thrusters
    rest = [m for m in MISSIONS if m not in ("rich", "survey")]
    plans: list[tuple[str, tuple[Planted, ...]]] = []
    for _ in range(repeats):
        plans += [(mission, ()) for mission in MISSIONS for _ in range(nulls)]
        for name, entry in catalogue().items():
            for target in _targets(entry, thrusters, rng):
                for mission, severity in SINGLES:
                    where = mission or rest[int(rng.integers(len(rest)))]
                    plans.append((where, (draw_planted(name, target, severity, rng),)))
        known = names(foreign=False)
        for count, many in ((2, 24), (3, 12)):
            for _ in range(many):
                chosen = rng.choice(known, count, replace=False)
                mission = str(rng.choice(["rich", "survey"]))
                plans.append((mission, tuple(draw_planted(str(n), _any(str(n), thrusters, rng), 1.2, rng) for n in chosen)))
        plans += [(str(rng.choice(["rich", "survey"])), (_begun(str(n), thrusters, rng),)) for n in rng.choice(lasting(), BEGIN, replace=False)]
    order = rng.permutation(len(plans))
    seeds = rng.choice(2**31 - 1, len(plans), replace=False)
    return [Case(plans[i][0], plans[i][1], int(s)) for i, s in zip(order, seeds, strict=True)]


def lasting() -> tuple[str, ...]:
    """The library's effects that are there from the start unless an onset is asked for; a thruster degraded later is `thruster_fault_onset`."""
    return tuple(n for n in names(foreign=False) if not catalogue()[n].event and n != "thruster_degraded")


def _begun(name: str, thrusters: Sequence[str], rng: np.random.Generator) -> Planted:
    """An effect that begins during the log."""
    late = round(DURATION_S * float(rng.uniform(*BEGINS)), 1)
    return replace(draw_planted(name, _any(name, thrusters, rng), 1.5, rng), onset_s=late)


def _any(name: str, thrusters: Sequence[str], rng: np.random.Generator) -> str | None:
    """One target of an effect, at random."""
    targets = _targets(catalogue()[name], thrusters, rng)
    return targets[int(rng.integers(len(targets)))]
