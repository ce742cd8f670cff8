"""Vehicles that a file could as well describe: parameters drawn within the tolerances that the effects state of a healthy vehicle."""

from __future__ import annotations

import numpy as np

from rovval import effects
from rovval.core.data import Array
from rovval.core.errors import UsageProblem
from rovval.plant import Plant


def drawn(plant: Plant, beta: Array, draws: int, slop: float, rng: np.random.Generator) -> Array:
    """``draws`` parameter vectors (draws, K) about ``beta`` (K,): each parameter of a healthy vehicle that has a tolerance, normal with that standard
    deviation and drawn again where it falls out of bounds; sensors are the mission's own.

    Args:
        slop: relative standard deviation of calibrated coefficients (`--calibration-slop`).

    Raises UsageProblem for a tolerance so wide that hardly a draw is within bounds.
    """
    lanes = np.tile(beta, (draws, 1))
    for column, slot in enumerate(plant.slots):
        p = slot.parameter
        if p.tolerance is None or effects.load(slot.effect).place == "sensor":
            continue
        sd = p.tolerance.of(p, plant.vehicle, slot.target, slop)
        if sd > 0:
            lanes[:, column] = _normal(rng, beta[column], sd, p.low, p.high, draws, slot.key)
    return lanes


def tolerated(plant: Plant) -> tuple[str, ...]:
    """Effects whose parameters are drawn."""
    return tuple(dict.fromkeys(s.effect for s in plant.slots if s.parameter.tolerance is not None and effects.load(s.effect).place != "sensor"))


def _normal(rng: np.random.Generator, mean: float, sd: float, low: float, high: float, draws: int, key: str) -> Array:
    """Normal numbers within bounds: what falls out is drawn again."""
    values = rng.normal(mean, sd, draws)
    for _ in range(100):
        out = (values < low) | (values > high)
        if not out.any():
            return values
        values[out] = rng.normal(mean, sd, int(out.sum()))
    raise UsageProblem(f"{key}: hardly a draw of {mean:g} +- {sd:g} is within {low:g} to {high:g}", "choose a smaller calibration slop")
