"""Inputs: what the log gives the plant, once per run, and its preparation for the kernel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput
from rovval.effects.lanes import reference_speed
from rovval.plant.codegen.spec import LOGGED
from rovval.vehicle.model import Vehicle

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
FAR = 1e6  # m; a bottom or wall that the log does not see is taken to be this far, where no effect reaches
UNSEEN = {"altitude": FAR, "wall_distance": FAR, "voltage": 1.0, "tether_length": 0.0, "load": 0.0, "turned": 0.0}  # of `LOGGED`: values without effect


@dataclass(frozen=True)
class Inputs:
    """One run on its grid of ``S`` samples, ``dt`` s apart; lanes begin at samples of it.

    ``speed`` (S, k) rev/s. ``hold`` True: a command, held until the next sample; False: a measured speed, linear between
    samples, taken at the Runge-Kutta stage times. ``altitude``, ``wall_distance``, ``tether_length`` (S,) m and ``voltage`` (S,) V or None;
    NaN where the log has none. ``turned`` (S,) rad of yaw since the run's start, whole turns counted, or None. ``t`` (S,) s since then. ``extra``
    (E, S, 6) body wrenches, N and N m, linear between samples.
    """

    dt: float
    speed: Array
    hold: bool
    altitude: Array | None = None
    wall_distance: Array | None = None
    voltage: Array | None = None
    tether_length: Array | None = None
    turned: Array | None = None
    t: Array | None = None
    extra: Array | None = None

    def __post_init__(self) -> None:
        speed = np.asarray(self.speed, dtype=float)
        object.__setattr__(self, "speed", speed)
        if speed.ndim != 2 or not len(speed) or not self.dt > 0:
            raise BadInput(f"thruster speeds are {speed.shape} at {self.dt} s, not (samples, thrusters)")
        for name in ("altitude", "wall_distance", "voltage", "tether_length", "turned", "t"):
            value = getattr(self, name)
            if value is not None and np.shape(value) != (len(speed),):
                raise BadInput(f"{name} is {np.shape(value)} for {len(speed)} samples")
        if self.extra is not None and (np.ndim(self.extra) != 3 or np.shape(self.extra)[1:] != (len(speed), 6)):
            raise BadInput(f"extra is {np.shape(self.extra)}, not (E, {len(speed)}, 6)")


@dataclass(frozen=True, slots=True)
class Prepared:
    """Arrays as the kernel reads them: no NaN; ``log`` (S, c) as `codegen.spec.LOGGED`, the voltage over its reference;
    ``next_gap`` (S,) the first sample from each one on whose thruster speed is missing (S where there is none)."""

    speed: Array
    log: Array
    t: Array
    extra: Array
    next_gap: Indices

    def steps_before_gap(self, start: Indices, hold: bool) -> Indices:
        """Steps a lane can take from ``start`` with every speed it needs known."""
        free = self.next_gap[np.minimum(start, len(self.next_gap) - 1)] - start
        unlimited = self.next_gap[np.minimum(start, len(self.next_gap) - 1)] >= len(self.next_gap)
        return np.where(unlimited, np.iinfo(np.int64).max // 2, np.maximum(free - (0 if hold else 1), 0))


def prepare(inputs: Inputs, vehicle: Vehicle) -> Prepared:
    """Fill what is missing so that no NaN reaches the kernel. A missing speed keeps its last value for the memory of lags, and
    stops the lane that runs into it; a bottom, wall or tether that is not seen has no effect; voltage and turns keep their last value."""
    samples = len(inputs.speed)
    missing = ~np.isfinite(inputs.speed).all(axis=1)
    places = np.where(missing, np.arange(samples), samples)
    next_gap = np.minimum.accumulate(places[::-1])[::-1].astype(np.int64)
    voltage = _held(inputs.voltage, samples, UNSEEN["voltage"])
    reference = vehicle.pulse_table.voltage if vehicle.pulse_table and inputs.voltage is not None else float(voltage[0])
    speed = np.stack([_held(column, samples, 0.0) for column in inputs.speed.T], axis=1)
    logged = {name: _or(getattr(inputs, name), samples, UNSEEN[name]) for name in ("altitude", "wall_distance", "tether_length")}
    logged |= {"voltage": voltage / reference, "load": load(speed, reference_speed(vehicle)), "turned": _held(inputs.turned, samples, UNSEEN["turned"])}
    log = np.stack([logged[name] for name in LOGGED], axis=1)
    t = np.asarray(np.arange(samples) * inputs.dt if inputs.t is None else inputs.t, dtype=np.float64)
    extra = np.zeros((1, 1, 6)) if inputs.extra is None else np.ascontiguousarray(inputs.extra, dtype=float)
    return Prepared(np.ascontiguousarray(speed), np.ascontiguousarray(log), t, extra, next_gap)


def load(speed: Array, reference: float) -> Array:
    """Power (...,) that all thrusters draw at ``speed`` (..., k) rev/s, over what they draw at the ``reference``, which holds the vehicle at 1 m/s ahead."""
    share = np.abs(speed / reference)
    return np.asarray(np.mean(share * share * share, axis=-1))


def _or(values: Array | None, samples: int, fill: float) -> Array:
    if values is None:
        return np.full(samples, fill)
    return np.where(np.isfinite(values), values, fill)


def _held(values: Array | None, samples: int, fill: float) -> Array:
    """Missing samples keep the last value before them (the first known one at the start; ``fill`` if none is known)."""
    known = np.zeros(samples, dtype=bool) if values is None else np.isfinite(values)
    if values is None or not known.any():
        return np.full(samples, fill)
    if known.all():
        return values
    last = np.maximum.accumulate(np.where(known, np.arange(samples), -1))
    first = int(np.argmax(known))
    return np.asarray(values, dtype=float)[np.where(last < 0, first, last)]
