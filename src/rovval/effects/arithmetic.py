"""Arithmetic for an effect's functions of the state: works on arrays here, and compiled, free of branches, in the kernel."""

from __future__ import annotations

from typing import Any

import numpy as np

Number = Any  # a float in the compiled kernel, an array of lanes in the reference plant


def positive(x: Number) -> Number:
    """X where x > 0, else 0; exact, since halving and doubling are."""
    return 0.5 * (x + abs(x))


def clip(x: Number, low: Number, high: Number) -> Number:
    """X held within [low, high]."""
    return np.minimum(np.maximum(x, low), high)


def sqrt(x: Number) -> Number:
    """Square root."""
    return np.sqrt(x)


def exp(x: Number) -> Number:
    """Exponential of x in [-69, 69], held beyond (exp(-69) is 1e-30)."""
    return np.exp(clip(x, -69.0, 69.0))


def sin(x: Number) -> Number:
    """Sine of an angle in rad."""
    return np.sin(x)


def cos(x: Number) -> Number:
    """Cosine of an angle in rad."""
    return np.cos(x)
