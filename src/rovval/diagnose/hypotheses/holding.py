"""What holds the vehicle to a point: where it begins in the search, from where it seems to, or from where the vehicle was at a time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from rovval.diagnose.hypotheses.hypothesis import Hypothesis, beginning
from rovval.diagnose.windows.shooting import Stretches
from rovval.plant import Plant

EVIDENT = 0.2  # of the gap, that a spring takes through the forces that are missing (opened sets: eight snags 0.22 to 0.82; of 82 others three)


def holding(plant: Plant, name: str, slots: tuple[int, ...], springs: Sequence[Mapping[str, float]], next_id: int) -> list[Hypothesis]:
    """What holds the vehicle from where it seems to, all of it at once: no slope leads from nothing to a standstill."""
    own = [(slot, plant.slots[slot].parameter) for slot in slots]
    at = [tuple((slot, float(np.clip(spring[p.name], p.low, p.high))) for slot, p in own if p.name in spring) for spring in springs]
    begun = [beginning(plant, f"{name}@{i}", slots, (-1,), one, next_id + i) for i, one in enumerate(at)]
    return [replace(h, evident=spring.get("share", 0.0) >= EVIDENT) for h, spring in zip(begun, springs, strict=True)]


def somewhere(parts: Sequence[Stretches], plant: Plant, slots: tuple[int, ...]) -> dict[str, float]:
    """Caught where the vehicle was in the middle of the log: it competes, until it is known where something seems to hold it."""
    first = plant.slots[slots[0]].parameter
    at = placed(parts, plant, slots, float(parts[0].start[len(parts[0].start) // 2]) * parts[0].run.dt)
    return {first.name: first.typical} | {plant.slots[slot].parameter.name: value for slot, value in at.items()}


def placed(parts: Sequence[Stretches], plant: Plant, slots: tuple[int, ...], t: float) -> dict[int, float]:
    """Values of the slots that an onset at ``t`` s since the first run's start places: itself, and where the vehicle was then."""
    run, found = parts[0].run, dict[int, float]()
    for slot in slots:
        parameter = plant.slots[slot].parameter
        if parameter.role == "onset":
            found[slot] = t
        elif parameter.role == "anchor":
            known = np.flatnonzero(run.ok(parameter.channel))
            found[slot] = float(np.interp(t / run.dt, known, run.get(parameter.channel)[known]))
    return found
