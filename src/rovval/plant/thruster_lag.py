"""Answers of a thruster's speed to its command, applied to a whole log before it goes into the plant, and its limit.

The plant itself has a first-order lag (effect ``thrust_lag``); the third-order one is the published answer of the T200.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

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
