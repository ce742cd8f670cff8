"""Lanes one sample at a time, for a loop that is closed: what the thrusters do next depends on where the vehicle is now."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rovval.core.frames import wrap
from rovval.effects.lanes import reference_speed
from rovval.plant import slots
from rovval.plant.codegen.spec import LOGGED
from rovval.plant.inputs import UNSEEN, Prepared, load
from rovval.plant.integration import Starts
from rovval.plant.lowering import lower
from rovval.plant.model import REASONS, Plant

Array = NDArray[np.float64]
LAG_MEMORY = 40.0  # time constants after which a lag has forgotten, to the last bit; the kernel looks as far back


class Stepper:
    """``B`` lanes of a plant, each under its own parameters and thruster speeds, from rest of the thrusters on.

    A run of steps is the motion that `Plant.simulate` gives for the same speeds, linear between samples, to rounding. ``nu`` and ``eta`` (B, 6) are the
    true motion now, ``stopped`` (B,) the sample from which on a lane keeps its last sane state (-1: it goes on), ``why`` what stopped it.
    """

    def __init__(self, plant: Plant, beta: Array, nu: Array, eta: Array, dt: float) -> None:
        """``beta`` (B, K) parameters in the order of the plant's slots, ``nu`` and ``eta`` (B, 6) the first state, ``dt`` s a sample.

        Raises UsageProblem for parameters out of bounds.
        """
        slots.check_bounds(plant.slots, beta)
        size, k = len(beta), len(plant.vehicle.thruster)
        self.nu, self.eta, self.stopped = nu.copy(), eta.copy(), np.full(size, -1)
        self.why = [""] * size
        lowered = lower(plant.nominal, plant.slots, plant.index, plant.null, beta)
        self._integrator, self._reference = plant.integrator, reference_speed(plant.vehicle)
        self._dt, self._step = dt, 0
        self._turned = np.zeros(size)
        lanes = lowered.lanes
        back = int(LAG_MEMORY * lanes.lag.max() / dt) + 1 + int(np.ceil(np.abs(lanes.shift).max() / dt)) if lanes.lag.any() or lanes.shift.any() else 0
        self._speed = np.zeros((size, back + 2, k))
        packed = self._integrator.packed(lowered, dt, self._starts(np.zeros(size, dtype=np.int64)))
        self._packed = packed[bool(lowered.full.any())]

    def step(self, speed: Array, altitude: Array | None = None) -> None:
        """One sample on, the thrusters turning linearly from their last speed to ``speed`` (B, k) rev/s; ``altitude`` (B,) m, where effects ask for it."""
        self._speed = np.concatenate([self._speed[:, 1:], speed[:, None]], axis=1)
        size, rows, k = self._speed.shape
        first = np.arange(size) * rows + rows - 2
        log = np.repeat([[UNSEEN[name] for name in LOGGED]], size * rows, axis=0)
        log[:, LOGGED.index("load")] = load(self._speed, self._reference).reshape(-1)
        turned = np.tile(self._turned[:, None], rows)
        turned[:, -1] += self._dt * self.nu[:, 5]
        log[:, LOGGED.index("turned")] = turned.reshape(-1)
        if altitude is not None:
            log[:, LOGGED.index("altitude")] = np.repeat(altitude, rows)
        t = np.tile((self._step - (rows - 2) + np.arange(rows)) * self._dt, size)
        prepared = Prepared(self._speed.reshape(size * rows, k), log, t, np.zeros((1, 1, 6)), np.full(size * rows, size * rows))
        starts = self._starts(first)
        out, stopped, codes = self._integrator.one_kernel(self._packed, prepared, starts, self._dt, False, 1)
        self._step += 1
        here = (self.stopped < 0) & (stopped >= 0)
        for b in np.flatnonzero(here):
            self.why[b] = f"stopped at {self._step * self._dt:.1f} s: {REASONS[codes[b]]}"
        self.stopped = np.where(here, self._step, self.stopped)
        self._turned = self._turned + wrap(out[:, 1, 11] - self.eta[:, 5])
        self.nu, self.eta = out[:, 1, :6], out[:, 1, 6:]

    def _starts(self, sample: NDArray[np.int64]) -> Starts:
        """Every lane where it is now, at the samples ``sample`` (B,) of a log."""
        size = len(self.nu)
        return Starts(sample, self.nu, self.eta, np.full(size, -1), np.ones(size), np.arange(size))
