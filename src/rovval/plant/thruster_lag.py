"""Answers of a thruster's speed to its command, applied to a whole log before it goes into the plant, and its limit.

The plant itself has a first-order lag (effect ``thrust_lag``); the third-order one is the published answer of the T200.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

LOW, HIGH = 0.05, 0.95  # quantiles of a record that are its two levels: each holds for more than a twentieth of it

# von Benzon et al., J. Mar. Sci. Eng. 2022, 10, 1898: T200 speed over command, highest power of s first.
T200 = ((6136.0, 108700.0), (1.0, 89.0, 9258.0, 108700.0))


def first_order(speed: Array, dt: float, tau: float) -> Array:
    """Answer (S, k) of tau dn/dt = u - n to commands held between samples, from rest at the first command."""
    return transfer(speed, dt, ((1.0,), (tau, 1.0)))


def third_order(speed: Array, dt: float) -> Array:
    """Answer (S, k) of the published T200 to commands held between samples."""
    return transfer(speed, dt, T200)


def transfer(speed: Array, dt: float, law: tuple[tuple[float, ...], tuple[float, ...]]) -> Array:
    """Answer of a transfer function with unit gain at rest, exact for commands held between samples; it begins settled."""
    from scipy import signal

    system = signal.cont2discrete(signal.tf2ss(*law), dt, method="zoh")
    a, b, c, d = system[0], system[1], system[2], system[3]
    state = np.linalg.solve(np.eye(len(a)) - a, b @ speed[:1])
    out = np.empty_like(speed)
    for i, u in enumerate(speed):
        out[i] = (c @ state + d * u)[0]
        state = a @ state + b * u
    return out


def saturate(speed: Array, limit: float) -> tuple[Array, Flags]:
    """Speeds (S, k) held within +-limit rev/s, and where that changed anything: for the caller to report."""
    held = np.clip(speed, -limit, limit)
    return held, np.asarray(held != speed)


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
