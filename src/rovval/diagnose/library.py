"""The hypotheses that compete for a log: every effect of the library on every axis and thruster, those that it cannot show left out.

Effects that begin at some time, or whose parameters linearisation at the null value cannot see (a period, an onset), enter once for
each of a few starting points; which one is best is part of the contest and is counted in its calibration.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from rovval import effects
from rovval.data import Array
from rovval.diagnose.stretches import Stretches
from rovval.plant import Plant

ONSETS = 9  # starting points for an onset, evenly inside the log
MOST_STARTS = 12  # of a hypothesis with several such parameters


@dataclass(frozen=True, slots=True)
class Hypothesis:
    """``name`` as in the contract (``thruster_degraded[HFP]``); ``slots`` all of its parameters; ``linear`` those that are fitted about
    ``start`` (k,), a parameter point; ``label`` tells starting points apart."""

    name: str
    label: str
    slots: tuple[int, ...]
    linear: tuple[int, ...]
    start: Array
    onset_s: float | None = None


def hypotheses(parts: Sequence[Stretches], only: Sequence[str] | None = None, without: Sequence[str] = ()) -> tuple[list[Hypothesis], dict[str, str]]:
    """The competing hypotheses, and those that this log cannot test with the reason.

    ``only`` and ``without`` name effects (``inflow_loss``) or hypotheses (``thruster_degraded[HFP]``) to keep or leave out.
    """
    plant, found, untestable = parts[0].plant, list[Hypothesis](), dict[str, str]()
    for name, slots in plant.hypotheses.items():
        effect = effects.load(name.partition("[")[0])
        listed = {name, effect.name}
        if (only is not None and not listed & set(only)) or listed & set(without):
            continue
        missing = [c for c in effect.needs if not all(part.run.measured(c) for part in parts)]
        if missing:
            untestable[name] = f"needs {', '.join(missing)}, which this log does not hold"
            continue
        found.extend(_starts(plant, name, effect, slots, parts))
    return found, untestable


def _starts(plant: Plant, name: str, effect: effects.Effect, slots: tuple[int, ...], parts: Sequence[Stretches]) -> list[Hypothesis]:
    start, grids = plant.null.copy(), dict[int, tuple[float, ...]]()
    for slot in slots:
        parameter = plant.slots[slot].parameter
        if parameter.name == "onset":
            first, last = float(parts[0].start[0]), float(parts[0].start[-1])
            dt = parts[0].run.dt
            share = np.arange(1, ONSETS + 1) / (ONSETS + 1)
            grids[slot] = tuple(float((first + (last - first) * s) * dt) for s in share)
        elif parameter.name in effect.grid:
            grids[slot] = tuple(effect.grid[parameter.name])
    linear = tuple(s for s in slots if s not in grids)
    if not grids:
        return [Hypothesis(name, name, slots, linear, start)]
    points = list(product(*grids.values()))
    chosen = points if len(points) <= MOST_STARTS else [points[i] for i in np.linspace(0, len(points) - 1, MOST_STARTS).astype(int)]
    found = []
    for number, point in enumerate(chosen):
        at = start.copy()
        at[list(grids)] = point
        onset = next((v for s, v in zip(grids, point, strict=True) if plant.slots[s].parameter.name == "onset"), None)
        found.append(Hypothesis(name, f"{name}@{number}", slots, linear, at, onset))
    return found
