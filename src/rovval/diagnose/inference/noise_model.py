"""The metric in which residuals are judged: what is white in them, and the disturbances that are not.

Variance per channel and time in the window is noise (from the log) and what no hypothesis of the library explains (model form); in the
metric in which the gap is told, calibration slop and disturbances are part of it. Disturbances are found in what the whole library
leaves, which is fitted again in the metric that knows them, and so on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rovval.core.data import Array
from rovval.diagnose.inference.cross_validation import Fold, Ring, fit, inflation_of
from rovval.diagnose.inference.disturbance import Disturbance, answers, calm, disturbance, shown, undisturbed
from rovval.diagnose.inference.prior import Prior
from rovval.diagnose.residuals.normal_equations import Products, joined, products, start_corrected
from rovval.diagnose.residuals.sensitivities import Linear, spread, state_spread
from rovval.diagnose.windows.noise import BELIEVED
from rovval.diagnose.windows.shooting import Stretches

PASSES = 5  # then sizes stand to within a few per cent
ENOUGH = 6  # windows: in fewer, a steady force and a disturbance cannot be told apart, and none is fitted
SMOOTH = 11  # samples over which the unexplained variance is smoothed along the window (1 s at 10 Hz)


@dataclass(frozen=True, slots=True)
class Metric:
    """``variance`` (n, c) in which the gap is told; ``white`` (n, c) beside the disturbances, which are nuisances of ``linear`` and known to
    ``parts``; ``inflation`` the design effect of what autocorrelation is left."""

    parts: tuple[Stretches, ...]
    linear: tuple[Linear, ...]
    variance: Array
    white: Array
    inflation: float
    disturbance: Disturbance


def metric(
    parts: tuple[Stretches, ...], linear: tuple[Linear, ...], columns: tuple[int, ...], slop: Prior, folds: tuple[Fold, ...], steadied: Array,
    origin: Array,
) -> Metric:  # fmt: skip
    """The metric of windows linearised about ``origin`` (k,), ``columns`` first; ``steadied`` (c,) discounts channels."""
    everything = Prior({c: parts[0].plant.slots[c].parameter.typical for c in columns})
    floor, first = _expected(parts, linear, Prior({})), _expected(parts, linear, slop)
    plain = tuple(replace(one, S=one.S[..., : len(columns)], columns=columns) for one in linear)
    early = joined_of(parts, plain, first, state_spread)
    inflation = inflation_of(early, fit(Ring.of(early, folds), everything, 10.0).step)
    best = fit(Ring.of(early, folds), everything, inflation).step
    white = first + _unexplained(parts, plain, first, best)
    variance = white * steadied
    if sum(part.count for part in parts) < ENOUGH:
        return Metric(parts, linear, variance, variance, _inflation(parts, linear, variance, everything, folds, inflation)[0], calm())
    to = answers(parts, origin)
    pushed = undisturbed(to)
    for _ in range(PASSES):
        left = [replace(one, r=np.where(part.ok, one.r - one.S @ best, 0.0)) for part, one in zip(parts, plain, strict=True)]
        pushed = disturbance(parts, to, left, white, inflation, pushed)
        swayed, loose = _swayed(parts, plain, pushed.pushed)
        white = floor + _unexplained(swayed, loose, first, best)
        inflation, best = _inflation(swayed, loose, white * steadied, everything, folds, inflation)
    parts, linear = _swayed(parts, linear, shown(parts, pushed.pushed, white))
    return Metric(parts, linear, variance, white * steadied, inflation, pushed)


def joined_of(parts: Sequence[Stretches], linear: Sequence[Linear], variance: Array, nuisances: Callable[[Stretches], Array]) -> Products:
    """Products of every run's windows behind one another, ``nuisances`` marginalised."""
    return joined([products(one, part.ok, variance, nuisances(part)) for part, one in zip(parts, linear, strict=True)])


def _inflation(
    parts: Sequence[Stretches], linear: Sequence[Linear], variance: Array, everything: Prior, folds: Sequence[Fold], before: float
) -> tuple[float, Array]:
    """Inflation of what the whole library leaves in this metric, and the step (k,) that fits the library there."""
    data = joined_of(parts, linear, variance, spread)
    step = fit(Ring.of(data, folds), everything, before).step
    return inflation_of(data, step), step


def _swayed(
    parts: Sequence[Stretches], linear: Sequence[Linear], pushed: Sequence[Array]
) -> tuple[tuple[Stretches, ...], tuple[Linear, ...]]:
    """Windows and linearisations that know their disturbances."""
    known = tuple(replace(part, pushed=one) for part, one in zip(parts, pushed, strict=True))
    return known, tuple(replace(one, J=np.concatenate([one.J, push], axis=-1)) for one, push in zip(linear, pushed, strict=True))


def _expected(parts: Sequence[Stretches], linear: Sequence[Linear], slop: Prior) -> Array:
    """Noise and slop of each channel at each time in the window (n, c)."""
    least = np.array([BELIEVED[c] for c in parts[0].channels])
    noise = np.maximum(np.mean([part.noise for part in parts], axis=0), least)
    total = np.tile(noise**2, (parts[0].steps + 1, 1))
    windows = sum(part.count for part in parts)
    for one in linear:
        place = [one.columns.index(c) for c in slop.sd]
        sd = np.array(list(slop.sd.values()))
        total = total + np.einsum("wtck,k->tc", one.S[..., place] ** 2, sd**2) / windows
    return total


def _unexplained(parts: Sequence[Stretches], linear: Sequence[Linear], variance: Array, step: Array) -> Array:
    """Mean square (n, c) of what the whole library leaves, smoothed along the window."""
    total, count = np.zeros_like(variance), np.zeros_like(variance)
    for part, one in zip(parts, linear, strict=True):
        left = replace(one, r=np.where(part.ok, one.r - one.S @ step, 0.0))
        rest = start_corrected(left, part.ok, variance, spread(part))
        total += (rest**2 * part.ok).sum(axis=0)
        count += part.ok.sum(axis=0)
    kernel = np.ones(SMOOTH) / SMOOTH
    mean = total / np.maximum(count, 1)
    padded = np.pad(mean, ((SMOOTH // 2, SMOOTH // 2), (0, 0)), mode="edge")
    return np.stack([np.convolve(padded[:, i], kernel, mode="valid") for i in range(mean.shape[1])], axis=1)
