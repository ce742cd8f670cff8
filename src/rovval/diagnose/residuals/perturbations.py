"""The lanes of a linearisation: which simulations, of every window, its derivatives are taken from.

Nominal, each initial state, each effect parameter one step away; start points away from the point reached count as columns of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.nuisances import POSE_INDEX
from rovval.diagnose.windows.windows import Windows

STEP = 0.25  # finite-difference step as a share of a parameter's typical size


@dataclass(frozen=True, slots=True)
class DisplacedColumn:
    """A column that does not start at the point reached but where the slots ``at`` are moved to (an onset, a period): the sensitivity
    there to ``slot``, or, where ``slot`` is -1, the change from the point reached to there. ``id`` is past the plant's slots."""

    id: int
    at: tuple[tuple[int, float], ...]
    slot: int


@dataclass(frozen=True, slots=True)
class Columns:
    """What a linearisation is asked for: plant ``slots`` that move by themselves, and ``displaced`` from starting points of their own."""

    slots: tuple[int, ...] = ()
    displaced: tuple[DisplacedColumn, ...] = ()


@dataclass(frozen=True, slots=True)
class Perturbation:
    """One simulation of every window: parameters, offset of the start states, and which derivative it serves: (its output less that
    of lane ``against``) / ``step`` for a state or a column; a step of 0 serves none."""

    beta: Array
    nu: Array
    eta: Array
    state: int = -1
    column: int = -1
    step: float = 0.0
    against: int = 0


def perturbations(
    windows: Windows, beta: Array, states: list[tuple[int, float]], columns: tuple[int, ...], directions: Sequence[DisplacedColumn]
) -> list[Perturbation]:
    """Nominal first, then start states, then parameters (central differences inside the bounds), then directions."""
    still = np.zeros(6)
    lanes = [Perturbation(beta, still, still)]
    for i, (index, step) in enumerate(states):
        unit = np.zeros(6)
        unit[index if index < 6 else POSE_INDEX[index]] = step
        lanes.append(Perturbation(beta, unit if index < 6 else still, still if index < 6 else unit, state=i, step=step))
    for column in columns:
        up, down = _both_ways(windows, beta, column)
        lanes.append(Perturbation(_moved(beta, [(column, beta[column] + down)]), still, still) if down else lanes[0])
        lanes.append(Perturbation(_moved(beta, [(column, beta[column] + up)]), still, still, column=column, step=up - down, against=len(lanes) - 1))
    bases = dict.fromkeys(_idle(windows, beta, directions), 0)
    for d in directions:
        there = _moved(beta, list(d.at))
        if d.slot < 0:
            lanes.append(Perturbation(there, still, still, column=d.id, step=1.0))
            continue
        if d.at not in bases:
            bases[d.at] = len(lanes)
            lanes.append(Perturbation(there, still, still))
        up, _ = _both_ways(windows, there, d.slot)
        lanes.append(Perturbation(_moved(there, [(d.slot, there[d.slot] + up)]), still, still, column=d.id, step=up, against=bases[d.at]))
    return lanes


def _idle(windows: Windows, beta: Array, directions: Sequence[DisplacedColumn]) -> set[tuple[tuple[int, float], ...]]:
    """Points at which nothing is there yet: what stands elsewhere only places an effect of no size, and the simulation is the nominal one."""
    sized: dict[tuple[tuple[int, float], ...], list[int]] = {}
    for d in directions:
        sized.setdefault(d.at, []).append(d.slot)
    slots = windows.plant.slots
    return {at for at, own in sized.items() if all(s >= 0 and beta[s] == slots[s].parameter.null for s in own)}


def forward_differences(windows: Windows, beta: Array, columns: tuple[int, ...]) -> list[Perturbation]:
    """One lane a parameter, the way that its bounds leave open."""
    still, lanes = np.zeros(6), []
    for column in columns:
        up, down = _both_ways(windows, beta, column)
        lanes.append(Perturbation(_moved(beta, [(column, beta[column] + (up or down))]), still, still, column=column, step=up or down))
    return lanes


def _both_ways(windows: Windows, beta: Array, column: int) -> tuple[float, float]:
    """Steps up and down of a parameter that stay within its bounds; 0 for the way that is barred."""
    parameter = windows.plant.slots[column].parameter
    step = STEP * parameter.typical
    up = step if beta[column] + step <= parameter.high else 0.0
    down = -step if beta[column] - step >= parameter.low else 0.0
    return (up, down) if up or down else (parameter.high - beta[column], 0.0)


def _moved(beta: Array, to: Sequence[tuple[int, float]]) -> Array:
    there = beta.copy()
    for slot, value in to:
        there[slot] = value
    return there


