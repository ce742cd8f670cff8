"""What a simulation is asked for, checked: shapes, samples that the log holds, parameters within bounds, channels that effects need."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.core.errors import BadInput, UsageProblem, all_at_once
from rovval.plant import slots
from rovval.plant.inputs import Inputs

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
ABSENT = ("altitude", "wall_distance", "voltage", "tether_length")
INPUTS = {c: c for c in ABSENT} | {"psi": "turned"}  # what inputs hold of a channel that a parameter acts by


def checked(
    found: Sequence[slots.Slot], null: Array, thrusters: int, inputs: Inputs, start: Indices, steps: int, nu0: Array, eta0: Array, beta: Array,
    extra: Indices | None, extra_gain: Array | None,
) -> tuple[Indices, Array, Array, Array, Indices, Array, Indices, Indices]:  # fmt: skip
    """Start samples, first states, parameters, extra wrenches and their factors as arrays, (B,) or (B, k); see `Plant.simulate` for what they are. And of each
    row of neighbours with equal parameters the first lane (P,), and the row (B,) that each lane is of.

    Raises:
        BadInput: shapes that do not fit, samples that the log does not hold, states that are not finite; all at once.
        UsageProblem: parameters out of bounds, or effects whose channels the inputs do not hold; all at once.
    """
    start = np.asarray(start, dtype=np.int64)
    nu0, eta0, beta = (np.asarray(a, dtype=float) for a in (nu0, eta0, beta))
    size = len(start)
    which = np.full(size, -1, dtype=np.int64) if extra is None else np.asarray(extra, dtype=np.int64)
    gain = np.ones(size) if extra_gain is None else np.asarray(extra_gain, dtype=float)
    given: dict[str, Array | Indices] = {"nu0": nu0, "eta0": eta0, "beta": beta, "extra": which, "extra_gain": gain}
    if problems := _misfits(given, len(found), thrusters, inputs, start, steps):
        raise BadInput(all_at_once(problems, "simulate"))
    first, numbers = _in_a_row(beta)
    rows = beta[first]
    slots.check_bounds(found, rows)
    moved = [found[int(c)] for c in np.flatnonzero((rows != null).any(axis=0))]
    missing = [f"{n} needs {c}" for n in sorted({s.effect for s in moved}) for c in effects.load(n).needs if c in ABSENT and _absent(inputs, c)]
    missing += [f"{s.key} needs {s.parameter.needs}" for s in moved if s.parameter.needs in INPUTS and _absent(inputs, s.parameter.needs)]
    missing += _nothing_instead(found, null, rows, inputs)
    if missing:
        raise UsageProblem(all_at_once(missing, "channels that the log does not hold"))
    return start, nu0, eta0, beta, which, gain, first, numbers


def _in_a_row(beta: Array) -> tuple[Indices, Indices]:
    """The first lane (P,) of each row of neighbours with equal parameters ``beta`` (B, K), and the row (B,) that each lane is of."""
    begins = np.concatenate([[True], (beta[1:] != beta[:-1]).any(axis=1)])
    return np.flatnonzero(begins), np.cumsum(begins) - 1


def _misfits(given: Mapping[str, Array | Indices], parameters: int, thrusters: int, inputs: Inputs, start: Indices, steps: int) -> list[str]:
    """What of the arguments does not fit the log or one another."""
    size, samples = len(start), len(inputs.speed)
    wanted = {"nu0": (size, 6), "eta0": (size, 6), "beta": (size, parameters), "extra": (size,), "extra_gain": (size,)}
    problems = [f"{name} is {a.shape}, not {wanted[name]}" for name, a in given.items() if a.shape != wanted[name]]
    if inputs.speed.shape[1] != thrusters:
        problems.append(f"{inputs.speed.shape[1]} thruster speeds for {thrusters} thrusters")
    last = start.max(initial=0) + steps - (1 if inputs.hold else 0)
    if start.min(initial=0) < 0 or last >= samples or steps < 0:
        problems.append(f"samples {start.min(initial=0)} to {last} of a log of {samples}")
    if given["extra"].max(initial=-1) >= (0 if inputs.extra is None else len(inputs.extra)):
        problems.append(f"extra wrench {given['extra'].max()} is not in the bank")
    if not problems and not (np.isfinite(given["nu0"]).all() and np.isfinite(given["eta0"]).all()):
        problems.append("a first state is not finite")
    if not size:
        problems.append("no lane at all")
    return problems


def _nothing_instead(found: Sequence[slots.Slot], null: Array, beta: Array, inputs: Inputs) -> list[str]:
    """Effects at work in a lane that has neither a channel nor the parameter which stands in its place."""
    away, problems = beta != null, list[str]()
    for c, slot in enumerate(found):
        if (channel := slot.parameter.instead_of) and _absent(inputs, channel):
            own = [i for i, other in enumerate(found) if other.hypothesis == slot.hypothesis]
            problems += [f"{slot.hypothesis} needs {channel}, or {slot.key}"] if (away[:, own].any(axis=1) & ~away[:, c]).any() else []
    return problems


def _absent(inputs: Inputs, channel: str) -> bool:
    values = getattr(inputs, INPUTS[channel])
    return values is None or not np.isfinite(values).any()
