"""The simulations that a linearisation is made of: every window at the point itself, and one finite difference away from it in each variable.

Variables are the initial states, the parameters, and displaced columns: directions that begin at another point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.residuals.nuisances import POSE_INDEX
from rovval.diagnose.windows.windows import Windows
from rovval.plant.sensors import moves_the_vehicle

STEP = 0.25  # finite-difference step as a share of a parameter's typical size, of central differences, whose error goes with its square,
STEP_NEAR = 0.02  # and where a fit has come near its optimum: towards a point nearby a pull turns within a tenth of its typical size
STEP_ONE_SIDED = 0.05  # the same of one-sided ones, whose error goes with the step itself


@dataclass(frozen=True, slots=True)
class DisplacedColumn:
    """A column of a linearisation that is taken at another point: an effect has no sensitivity to its onset, say, while its size is zero.

    Attributes:
        id: its column number, beyond the plant's slots.
        at: the other point: (slot, value) of each parameter that differs.
        slot: the parameter whose sensitivity is taken there; -1 for the change of the residual from here to there.
    """

    id: int
    at: tuple[tuple[int, float], ...]
    slot: int


@dataclass(frozen=True, slots=True)
class Columns:
    """The columns of a linearisation: the plant ``slots``, and ``displaced`` columns that are taken at other points."""

    slots: tuple[int, ...] = ()
    displaced: tuple[DisplacedColumn, ...] = ()


@dataclass(frozen=True, slots=True)
class Perturbation:
    """One simulation of every window, and the derivative that is taken from it: (its output less that of perturbation ``against``) / ``step``.

    Attributes:
        beta: parameters (k,).
        nu, eta: what is added to the initial velocities and pose (6,).
        state: nuisance parameter that the derivative is of, -1 for none.
        column: column that it is of, -1 for none.
        step: finite difference, in the unit of the variable; 0 where no derivative is taken.
        against: number of the perturbation that is subtracted.
    """

    beta: Array
    nu: Array
    eta: Array
    state: int = -1
    column: int = -1
    step: float = 0.0
    against: int = 0


def perturbations(
    windows: Windows, beta: Array, states: list[tuple[int, float]], columns: tuple[int, ...], directions: Sequence[DisplacedColumn], share: float = STEP
) -> list[Perturbation]:
    """The simulations of a linearisation about ``beta`` (k,): the point itself, the initial ``states`` (index, step), the parameters of ``columns`` (central
    differences where bounds allow, by a ``share`` of their typical size, of onsets by `STEP`), the displaced columns ``directions``."""
    still = np.zeros(6)
    lanes = [Perturbation(beta, still, still)]
    for i, (index, step) in enumerate(states):
        unit = np.zeros(6)
        unit[index if index < 6 else POSE_INDEX[index]] = step
        lanes.append(Perturbation(beta, unit if index < 6 else still, still if index < 6 else unit, state=i, step=step))
    for column in columns:
        up, down = _steps(windows, beta, column, STEP if windows.plant.slots[column].parameter.role == "onset" else share)
        lanes.append(Perturbation(_moved(beta, [(column, beta[column] + down)]), still, still) if down else lanes[0])
        lanes.append(Perturbation(_moved(beta, [(column, beta[column] + up)]), still, still, column=column, step=up - down, against=len(lanes) - 1))
    bases = dict.fromkeys(_unchanged(windows, beta, directions), 0)
    for d in directions:
        there = _moved(beta, list(d.at))
        if d.slot < 0:
            lanes.append(Perturbation(there, still, still, column=d.id, step=1.0))
            continue
        if d.at not in bases:
            bases[d.at] = len(lanes)
            lanes.append(Perturbation(there, still, still))
        up, _ = _steps(windows, there, d.slot, STEP)
        lanes.append(Perturbation(_moved(there, [(d.slot, there[d.slot] + up)]), still, still, column=d.id, step=up, against=bases[d.at]))
    return lanes


def _unchanged(windows: Windows, beta: Array, directions: Sequence[DisplacedColumn]) -> set[tuple[tuple[int, float], ...]]:
    """Points at which the simulation is that at ``beta``: they differ in parameters that only place an effect whose size is zero."""
    sized: dict[tuple[tuple[int, float], ...], list[int]] = {}
    for d in directions:
        sized.setdefault(d.at, []).append(d.slot)
    slots = windows.plant.slots
    return {at for at, own in sized.items() if all(s >= 0 and beta[s] == slots[s].parameter.null for s in own)}


def coarse_differences(windows: Windows, beta: Array, columns: tuple[int, ...], first: int) -> list[Perturbation]:
    """One-sided differences of the parameters of ``columns`` about ``beta`` (k,), away from a bound that ``beta`` lies on; central ones of an offset of the
    thrusters' clock: their log is linear between samples, and where these are met, at no offset for one, its slope is another on either side. They stand from
    the ``first`` simulation on."""
    still, lanes = np.zeros(6), list[Perturbation]()
    for column in columns:
        clock = moves_the_vehicle(windows.plant.slots[column])
        up, down = _steps(windows, beta, column, STEP if clock else STEP_ONE_SIDED)
        central = clock and up and down
        if central:
            lanes.append(Perturbation(_moved(beta, [(column, beta[column] + down)]), still, still))
        step, against = (up - down, first + len(lanes) - 1) if central else (up or down, 0)
        lanes.append(Perturbation(_moved(beta, [(column, beta[column] + (up or down))]), still, still, column=column, step=step, against=against))
    return lanes


def _steps(windows: Windows, beta: Array, column: int, share: float) -> tuple[float, float]:
    """Steps up and down of a parameter, a ``share`` of its typical size, that stay within its bounds; 0 where a bound is in the way."""
    parameter = windows.plant.slots[column].parameter
    step = share * parameter.typical
    up = step if beta[column] + step <= parameter.high else 0.0
    down = -step if beta[column] - step >= parameter.low else 0.0
    return (up, down) if up or down else (parameter.high - beta[column], 0.0)


def _moved(beta: Array, to: Sequence[tuple[int, float]]) -> Array:
    """``beta`` (k,) with other values of some slots."""
    there = beta.copy()
    for slot, value in to:
        there[slot] = value
    return there
