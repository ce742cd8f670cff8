"""Which questions a sealed set asks: the grid of cases, the leave-one-out cases, and decoys that make those look like the rest.

A question is a log and the effects that are taken out of the library when it is answered. Leave-one-out takes out the true effect
with everything that is the same law under another name; a decoy takes out an effect that is not there, so that the list of what
is taken out tells nothing: the answer without it is the answer with it.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rovval.blind.cases.grid import DURATION_S, Case, draw_planted, grid
from rovval.blind.cases.mixed import FULL, HEALTHY, mixed
from rovval.blind.plant.nominal_vehicle import read_vehicle
from rovval.blind.plant.spec import Planted, PlantName, stream
from rovval.blind.planted.catalogue import catalogue, names
from rovval.core.errors import UsageProblem

DECOY_SHARE = 0.25  # share of the ordinary questions that have an effect taken out that is not there
SMALL_S = 240.0
SHORTEST_S = 30.0  # three windows of a diagnosis
WEAK = ("thruster_degraded", "thruster_fault_onset", "thruster_reversed", "thruster_interaction")
SAME_LAW = {  # taken out together: one is the other at some value, or closes nine tenths of what the other does (Merlin, no slop)
    **dict.fromkeys(WEAK, WEAK),  # interaction is a degradation where the neighbour always runs as hard: 1.00 on a survey, VFP
    "buoyancy_error": ("buoyancy_error", "payload_change"),
    "payload_change": ("buoyancy_error", "payload_change"),
    "added_mass": ("added_mass", "inertia_error"),
    "inertia_error": ("inertia_error", "added_mass", "payload_change"),
    "current_constant": ("current_constant", "current_varying", "current_shear"),
    "time_offset": ("time_offset", "velocity_filter_lag"),  # 0.92 on a rich log
    "velocity_filter_lag": ("velocity_filter_lag", "time_offset"),  # 0.94 on a rich log
    "tether_tension": ("tether_tension", "tether_snag"),  # a soft spring far from its slack pulls alike: 0.74 and 0.72 on rich logs
    "thrust_lag": ("thrust_lag", "time_offset"),  # three lags in a row are nearer to a delay than to one lag: 1.16
}
SMALL: tuple[tuple[str, tuple[tuple[str, str | None, float], ...], bool], ...] = (  # mission; name, target, severity; left out
    ("rich", (), False),
    ("survey", (), False),
    ("protocol", (), False),
    ("station", (), False),
    ("rich", (("buoyancy_error", None, 1.5),), False),
    ("rich", (("quadratic_drag", "surge", 2.0),), False),
    ("rich", (("reverse_asymmetry", None, 1.5),), False),
    ("rich", (("thruster_degraded", "HFS", 1.2),), False),
    ("survey", (("thruster_degraded", "HAP", 1.2),), False),
    ("rich", (("thruster_reversed", "HAS", 1.0),), False),
    ("survey", (("inflow_loss", None, 2.0),), False),
    ("survey", (("current_constant", None, 1.5),), False),
    ("rich", (("thruster_fault_onset", "HFP", 1.2),), False),
    ("rich", (("rpm_scale", None, 2.0),), False),
    ("rich", (("thruster_misaligned", "HFP", 1.5),), False),
    ("rich", (("dvl_misalignment", "yaw", 2.0),), False),
    ("survey", (("time_offset", "thruster_feedback", 1.5),), False),
    ("rich", (("gyro_bias", "yaw", 1.5),), False),
    ("rich", (("buoyancy_error", None, -1.5), ("thruster_degraded", "HFP", 1.2)), False),
    ("survey", (("quadratic_drag", "surge", 2.0), ("current_constant", None, 1.2)), False),
    ("rich", (("memory_drag", None, 2.0),), False),
    ("rich", (("hidden_trim", None, 2.0),), False),
    ("rich", (("thruster_degraded", "HFS", 1.5),), True),
    ("rich", (("reverse_asymmetry", None, 2.0),), True),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Question:
    """One log to make; ``without`` is taken out of the library, ``left_out`` says that it holds the truth."""

    case: Case
    without: tuple[str, ...] = ()
    left_out: bool = False


def questions(
    vehicle: Path, seed: int, size: str, plant: PlantName = "a", healthy: float | None = None, seconds: float | None = None
) -> list[Question]:
    """The set of that size: ``full``, ``small`` (24 logs), or so many.

    Plant a's full set is a grid of effects and missions with leave-one-out questions, and a number is so many drawn from it. With a share of
    ``healthy`` logs, and for plant b always, the set is drawn to measure instead (`mixed`), of logs of ``seconds``, with nothing left out.
    """
    if not (size in ("full", "small") or (size.isdecimal() and int(size) >= 1)):
        raise UsageProblem(f"--size {size} is no size", "use full, small, or a number of logs")
    if plant == "b" or healthy is not None or seconds is not None:
        share, long = HEALTHY if healthy is None else healthy, DURATION_S if seconds is None else seconds
        if not 0.0 <= share <= 1.0 or long < SHORTEST_S:
            raise UsageProblem(
                f"--healthy {share:g} --seconds {long:g} make no set", f"give a share from 0 to 1, and logs of {SHORTEST_S:g} s at least"
            )
        count = {"full": FULL, "small": len(SMALL)}.get(size) or int(size)
        return [Question(case) for case in mixed(vehicle, seed, count, share, long, plant)]
    if size == "small":
        return _small(vehicle, seed)
    everything = _full(vehicle, seed)
    return everything if size == "full" else everything[: int(size)]


def _full(vehicle: Path, seed: int) -> list[Question]:
    rng = stream(seed, "questions")
    asked = [Question(case, _decoy(case, rng)) for case in grid(vehicle, seed)]
    thrusters = read_vehicle(vehicle).thrusters
    left = [
        Question(
            Case(mission, (draw_planted(name, target, 2.0, rng),), int(rng.integers(2**31 - 1))),
            same_law(name),
            True,
        )
        for name in names(foreign=False)
        for mission, target in zip(("rich", "survey"), _two(name, thrusters, rng), strict=True)
    ]
    both = asked + left
    return [both[i] for i in rng.permutation(len(both))]


def _small(vehicle: Path, seed: int) -> list[Question]:
    rng = stream(seed, "questions")
    thrusters = read_vehicle(vehicle).thrusters
    asked = []
    for mission, effects, left_out in SMALL:
        planted = tuple(Planted(n, _on(vehicle, n, t, thrusters), s) for n, t, s in effects)
        case = Case(mission, planted, int(rng.integers(2**31 - 1)), SMALL_S)
        asked.append(Question(case, same_law(effects[0][0]) if left_out else _decoy(case, rng), left_out))
    return [asked[i] for i in rng.permutation(len(asked))]


def _two(name: str, thrusters: tuple[str, ...], rng: np.random.Generator) -> list[str | None]:
    """Two targets out of all that an effect has, different where it has two."""
    entry = catalogue()[name]
    choices = (thrusters if entry.targets == ("thruster",) else entry.targets) or (None,)
    order = rng.permutation(len(choices))
    return [choices[order[i % len(choices)]] for i in range(2)]


def _on(vehicle: Path, name: str, target: str | None, thrusters: tuple[str, ...]) -> str | None:
    """The target, or where this vehicle has no thruster of that name one that stands in for it."""
    if target is None or catalogue()[name].targets != ("thruster",) or target in thrusters:
        return target
    return thrusters[sum(map(ord, target)) % len(thrusters)]


def same_law(name: str) -> tuple[str, ...]:
    """Effects of the library to take out so that this one is really gone."""
    return SAME_LAW.get(name, (name,))


def _decoy(case: Case, rng: np.random.Generator) -> tuple[str, ...]:
    """An effect that is not there and is not the law of one that is."""
    there = {law for e in case.effects for law in same_law(e.name)}
    free = [n for n in names(foreign=False) if not there & set(same_law(n))]
    drawn, chosen = float(rng.random()), str(rng.choice(free))
    return same_law(chosen) if drawn < DECOY_SHARE else ()
