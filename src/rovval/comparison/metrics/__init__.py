"""Metrics, one file each: what a signed error (simulated minus measured) over a run is worth as one number.

A file has ``NAME``, ``TITLE``, ``UNIT`` ("same" as the channel, "times_s", "s", or "1" for a bare ratio), ``SCALES`` (whether twice
the error gives twice the number), ``PERFECT`` (the number of an error that is zero) and
``compute(error, ok, dt, measured=None)``. Adding a metric is adding a file: `names` finds it and the contract test runs on it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rovval.core.did_you_mean import suggestion
from rovval.core.errors import BadInput, UsageProblem
from rovval.core.units import integral_unit

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
UnitRule = Literal["same", "times_s", "s", "1"]


@dataclass(frozen=True, slots=True)
class Metric:
    """One metric as its file declares it."""

    name: str
    title: str
    unit: UnitRule
    scales: bool
    perfect: float
    meaning: str
    compute: Callable[..., float]

    def unit_of(self, channel_unit: str) -> str:
        """Unit of the number for a channel in ``channel_unit``: an m/s error has an IAE in m."""
        if self.unit in ("1", "s"):
            return self.unit
        if self.unit == "same":
            return channel_unit
        return integral_unit(channel_unit)


def kept(error: Array, ok: Flags, measured: Array | None = None) -> tuple[Array, Array]:
    """The error and the measured values of the samples that are there; refuses when none is."""
    error, ok = np.asarray(error, dtype=float), np.asarray(ok, dtype=bool)
    if error.shape != ok.shape or error.ndim != 1:
        raise BadInput(f"{error.shape} errors under a mask of {ok.shape}")
    if not ok.any():
        raise BadInput("no sample is left to measure an error on", "see the run's coverage and the simulation's stops")
    if not np.isfinite(error[ok]).all():
        raise BadInput("an error that the mask says is there is not a finite number")
    truth = np.zeros(0) if measured is None else np.asarray(measured, dtype=float)[ok]
    return error[ok], truth


def beside(name: str, error: Array, ok: Flags, measured: Array | None) -> tuple[Array, Array]:
    """As `kept`, for a metric that is nothing without the measured values; refuses where there are none."""
    if measured is None:
        raise BadInput(f"{name} needs the measured values beside the error")
    return kept(error, ok, measured)


def theil(name: str, error: Array, ok: Flags, measured: Array | None) -> tuple[float, Array, Array]:
    """What Theil's decomposition is made of: mean squared error, simulated and measured values; refuses where none was measured."""
    e, m = beside(name, error, ok, measured)
    return float(np.mean(np.square(e))), m + e, m


@cache
def names() -> tuple[str, ...]:
    """Names of the metrics of this folder."""
    return tuple(sorted(p.stem for p in Path(__file__).parent.glob("*.py") if not p.stem.startswith("_")))


@cache
def get(name: str) -> Metric:
    """The metric of that name; refuses one that is not there."""
    if name not in names():
        raise UsageProblem(f"no metric named {name!r}", suggestion(name, names(), "`rovval list metric`"))
    m = import_module(f"rovval.comparison.metrics.{name}")
    return Metric(m.NAME, m.TITLE, m.UNIT, m.SCALES, m.PERFECT, (m.__doc__ or "").strip(), m.compute)
