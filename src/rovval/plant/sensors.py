"""The sensors of the log: the true motion as they would write it, and the truth back out of a measured first state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rovval import effects
from rovval.effects.effect import STAGES
from rovval.effects.log import Log
from rovval.plant import slots
from rovval.plant.sensor_delay import Delay
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]
Part = NDArray[np.int64] | slice  # of the lanes; those that lie side by side are a view


@cache
def order() -> tuple[str, ...]:
    """Effects that act on the log, in the order in which they act on the true motion: by the stage that each states."""
    acting = [n for n in effects.names() if hasattr(effects.module(n), "observe")]
    return tuple(sorted(acting, key=lambda n: STAGES.index(effects.load(n).stage)))


def observe(vehicle: Vehicle, index: Mapping[str, int], null: Array, beta: Array, log: Log) -> Log:
    """The log as written."""
    return overwritten(vehicle, index, null, beta, replace(log, nu=log.nu.copy(), eta=log.eta.copy()))


def overwritten(vehicle: Vehicle, index: Mapping[str, int], null: Array, beta: Array, log: Log) -> Log:
    """The same in the arrays of ``log`` themselves, which the caller gives away: they are the bulk of a simulation, of which few lanes have a
    sensor effect."""
    for name, lanes in _acting(order(), index, null, beta):
        part = Log(log.nu[lanes], log.eta[lanes], log.dt, log.nu0[lanes], log.eta0[lanes], log.first)
        seen = effects.module(name).observe(part, slots.gather(vehicle, index, name, beta[lanes]))
        for whole, before, after in ((log.nu, part.nu, seen.nu), (log.eta, part.eta, seen.eta)):
            if after is not before:
                whole[lanes] = after
    return log


def unobserve(vehicle: Vehicle, index: Mapping[str, int], null: Array, beta: Array, nu0: Array, eta0: Array) -> tuple[Array, Array]:
    """True first state (B, 6), (B, 6) behind a measured one."""
    nu, eta = nu0, eta0
    for name, lanes in _acting(tuple(reversed(order())), index, null, beta):
        a, b = effects.module(name).unobserve(nu[lanes], eta[lanes], slots.gather(vehicle, index, name, beta[lanes]))
        nu, eta = nu.copy(), eta.copy()
        nu[lanes], eta[lanes] = a, b
    return nu, eta


def delays(index: Mapping[str, int], null: Array, beta: Array) -> tuple[Delay, ...]:
    """By how much sensors are late (B,), those that are in any lane."""
    found = list[Delay]()
    for name, _ in _acting(order(), index, null, beta):
        for parameters, columns in getattr(effects.module(name), "LATE", {}).items():
            seconds = np.sum([beta[:, index[_key(name, parameter)]] for parameter in parameters], axis=0)
            if seconds.any():
                found.append(Delay(seconds, columns))
    return tuple(found)


def moves_the_vehicle(slot: slots.Slot) -> bool:
    """Whether a parameter of an effect on the log changes the motion itself, not what sensors write of it: an offset of the thrusters' clock does."""
    module = effects.module(slot.effect)
    written = {_key(slot.effect, parameter) for parameters in getattr(module, "LATE", {}) for parameter in parameters}
    return hasattr(module, "lower") and slot.key not in written


def _key(name: str, parameter: str) -> str:
    """``time_offset[velocity].delay`` of ``delay[velocity]``."""
    plain, _, target = parameter.partition("[")
    return f"{name}[{target}.{plain}" if target else f"{name}.{plain}"


def _acting(wanted: tuple[str, ...], index: Mapping[str, int], null: Array, beta: Array) -> list[tuple[str, Part]]:
    """Effects and the lanes in which they are not null."""
    found = list[tuple[str, Part]]()
    columns = _columns(tuple(index))
    for name in wanted:
        lanes = np.flatnonzero((beta[:, columns[name]] != null[columns[name]]).any(axis=1))
        if len(lanes):
            first, last = int(lanes[0]), int(lanes[-1])
            found.append((name, slice(first, last + 1) if last - first < len(lanes) else lanes))
    return found


@cache
def _columns(keys: tuple[str, ...]) -> Mapping[str, list[int]]:
    """Where each effect's parameters stand among the keys of the slots."""
    found: dict[str, list[int]] = {}
    for column, key in enumerate(keys):
        found.setdefault(key.partition(".")[0].partition("[")[0], []).append(column)
    return MappingProxyType(found)
