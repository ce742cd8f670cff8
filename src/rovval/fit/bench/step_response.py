"""The first-order answer of a thruster to a step of its command, found in a record on a bench.

tau dy/dt = u - y with a step of u between two levels; the effect `thrust_lag` has the same equation.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput

Array = NDArray[np.float64]

LOW, HIGH = 0.05, 0.95  # quantiles of a record that are its two levels: each holds for more than a twentieth of it
FEWEST = 40  # samples of a step: ten for each of the four numbers that are fitted to it (chosen)


@dataclass(frozen=True, slots=True)
class Step:
    """A first-order answer found in a record of one step: from ``before`` to ``after`` (the record's unit), beginning ``at`` s, with the time constant
    ``tau`` s. ``rms`` error over ``n`` samples as a share of the step: what is far from first order (a speed loop, a current limit) shows here."""

    at: float
    tau: float
    before: float
    after: float
    rms: float
    n: int

    def __str__(self) -> str:
        return (
            f"step at {self.at:.3f} s from {self.before:.4g} to {self.after:.4g}: time constant {self.tau:.3f} s, "
            f"rms error {100 * self.rms:.1f} % of the step over {self.n} samples"
        )


def steps(t: Array, y: Array) -> tuple[Step, ...]:
    """First-order answers to the steps of a record ``y`` (n,) at ``t`` (n,) s between two levels, in their order.

    Raises BadInput where the record has no step, ends within it, or swings between its levels too fast to hold any.
    """
    low, high = (float(np.quantile(y, q)) for q in (LOW, HIGH))
    middle, quarter = 0.5 * (low + high), 0.25 * (high - low)
    side = np.where(y > middle + quarter, 1, np.where(y < middle - quarter, -1, 0))
    known = np.flatnonzero(side)
    turns = known[1:][side[known[1:]] != side[known[:-1]]] if len(known) else known
    if not len(turns):
        raise BadInput(f"no step in {len(y)} samples between {low:.4g} and {high:.4g}", "give a record that holds both levels")
    edges = [0, *((a + b) // 2 for a, b in pairwise(turns)), len(t)]
    if (held := float(np.median(np.diff(edges)))) < FEWEST:
        raise BadInput(
            f"{len(turns)} swings between {low:.4g} and {high:.4g} in {len(y)} samples, every {held:g} samples: an oscillation or noise, no steps",
            "give a record of steps that are held, of the thruster's speed or thrust; --columns says which column it is",
        )
    return tuple(_step(t[a:b], y[a:b]) for a, b in pairwise(edges))


def _step(t: Array, y: Array) -> Step:
    from scipy.optimize import least_squares

    ends = max(len(y) // 10, 1)
    before, after = float(np.median(y[:ends])), float(np.median(y[-ends:]))
    first = float(t[np.argmax(np.abs(y - before) > 0.5 * abs(after - before))])
    span = float(t[-1] - t[0])

    def error(p: Array) -> Array:
        at, tau, b, a = p
        since = np.maximum(t - at, 0.0)
        return np.asarray(b + (a - b) * -np.expm1(-since / tau) - y)

    shortest = float(np.median(np.diff(t)))
    found = least_squares(
        error, [first, 0.05 * span, before, after], bounds=([t[0], 0.1 * shortest, -np.inf, -np.inf], [t[-1], span, np.inf, np.inf]),
        x_scale=[span, span, abs(after - before), abs(after - before)],
    )  # fmt: skip
    at, tau, before, after = (float(x) for x in found.x)
    return Step(at, tau, before, after, float(np.sqrt(np.mean(found.fun**2)) / abs(after - before)), len(y))
