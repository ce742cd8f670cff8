"""The sensors of the log: the true motion as they would write it, and the truth back out of a measured first state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.plant import slots
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]

# In the order in which they act on the true motion: where the sensor sits, how it is turned, its scale, then bias, filter and delay.
ORDER = (
    "dvl_lever_arm", "dvl_misalignment", "dvl_scale", "gyro_bias", "attitude_bias", "compass_deviation", "velocity_filter_lag",
    "time_offset",
)


@dataclass(frozen=True, slots=True)
class Log:
    """A motion on its way through the sensors: ``nu`` and ``eta`` (B, T + 1, 6), ``dt`` s, and the first measured ``nu0`` (B, 6)."""

    nu: Array
    eta: Array
    dt: float
    nu0: Array


@cache
def order() -> tuple[str, ...]:
    """Effects that act on the log, in the order in which they act; those of new files come last."""
    acting = [n for n in effects.names() if hasattr(effects.module(n), "observe")]
    return (*(n for n in ORDER if n in acting), *(n for n in acting if n not in ORDER))


def observe(vehicle: Vehicle, index: Mapping[str, int], null: Array, beta: Array, log: Log) -> Log:
    """The log as written; only lanes whose sensor effect is not null are touched."""
    for name, lanes in _acting(order(), index, null, beta):
        part = Log(log.nu[lanes], log.eta[lanes], log.dt, log.nu0[lanes])
        seen = effects.module(name).observe(part, slots.gather(vehicle, index, name, beta[lanes]))
        nu, eta = log.nu.copy(), log.eta.copy()
        nu[lanes], eta[lanes] = seen.nu, seen.eta
        log = Log(nu, eta, log.dt, log.nu0)
    return log


def unobserve(vehicle: Vehicle, index: Mapping[str, int], null: Array, beta: Array, nu0: Array, eta0: Array) -> tuple[Array, Array]:
    """True first state (B, 6), (B, 6) behind a measured one."""
    nu, eta = nu0, eta0
    for name, lanes in _acting(tuple(reversed(order())), index, null, beta):
        a, b = effects.module(name).unobserve(nu[lanes], eta[lanes], slots.gather(vehicle, index, name, beta[lanes]))
        nu, eta = nu.copy(), eta.copy()
        nu[lanes], eta[lanes] = a, b
    return nu, eta


def settling(active: frozenset[str]) -> bool:
    """Whether a sensor with a memory is at work: its first true velocity depends on the acceleration there."""
    return any(hasattr(effects.module(name), "SETTLES") for name in active)


def settle(vehicle: Vehicle, index: Mapping[str, int], null: Array, beta: Array, nu0: Array, acceleration: Array) -> Array:
    """First true velocities behind a filter that has run for long, or a delay: u v w plus its time times the acceleration (B, 6)."""
    nu = nu0
    for name, lanes in _acting(order(), index, null, beta):
        if tau := getattr(effects.module(name), "SETTLES", ""):
            p = slots.gather(vehicle, index, name, beta[lanes])
            nu = nu.copy()
            nu[lanes, :3] += p[tau][:, None] * acceleration[lanes, :3]
    return nu


def _acting(wanted: tuple[str, ...], index: Mapping[str, int], null: Array, beta: Array) -> list[tuple[str, NDArray[np.int64]]]:
    """Effects and the lanes in which they are not null."""
    found = []
    for name in wanted:
        columns = [c for key, c in index.items() if key.partition(".")[0].partition("[")[0] == name]
        lanes = np.flatnonzero((beta[:, columns] != null[columns]).any(axis=1))
        if len(lanes):
            found.append((name, lanes))
    return found
