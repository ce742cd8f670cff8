"""What the instruments measure of the true motion: noise, bias, their period, how late it arrives, and what is lost on the way."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array, Flags
from rovval.core.frames import rotation_from_euler
from rovval.fly.mission import Sensor, Sensors

KINDS = ("gyro", "accelerometer", "attitude", "depth", "velocity", "position", "altitude")
WIDTH = {"gyro": 3, "accelerometer": 3, "attitude": 3, "depth": 1, "velocity": 3, "position": 2, "altitude": 1}


@dataclass(frozen=True, slots=True)
class Measurement:
    """What arrives now: ``values`` (B, width), in which lanes (B,), and how many samples old it is."""

    values: Array
    there: Flags
    age: int


class Instruments:
    """The instruments of ``B`` lanes. Lane 0 draws from a generator of its own, so that it measures the same however many lanes fly beside it."""

    def __init__(self, sensors: Sensors, lanes: int, gravity: float, dt: float, seed: np.random.SeedSequence, factor: float = 1.0) -> None:
        """``factor``: all noise and bias times this."""
        self._sensors, self._gravity, self._dt, self._factor = sensors, gravity, dt, factor
        self._of = [np.random.default_rng(s) for s in seed.spawn(2)]
        self._lanes = lanes
        self._bias = {kind: factor * self._sensor(kind).bias * self._normal(WIDTH[kind]) for kind in KINDS}
        longest = max(round(self._sensor(kind).delay_s / dt) for kind in KINDS)
        self._on_the_way: Mapping[str, deque[tuple[Array, Flags] | None]] = {kind: deque([None] * (longest + 1), longest + 1) for kind in KINDS}
        self._step = -1

    def _sensor(self, kind: str) -> Sensor:
        sensor: Sensor = getattr(self._sensors, kind)
        return sensor

    def _normal(self, width: int) -> Array:
        return np.concatenate([self._of[0].normal(size=(1, width)), self._of[1].normal(size=(self._lanes - 1, width))])

    def _uniform(self) -> Array:
        return np.concatenate([self._of[0].uniform(size=1), self._of[1].uniform(size=self._lanes - 1)])

    def measure(self, nu: Array, eta: Array, before: Array, altitude: Array | None) -> dict[str, Measurement]:
        """What arrives at this sample; ``nu`` and ``eta`` (B, 6) are the truth, ``before`` (B, 3) the velocity north-east-down a sample ago."""
        self._step += 1
        rotation = rotation_from_euler(eta[:, 3:])
        force = (np.einsum("bij,bj->bi", rotation, nu[:, :3]) - before) / self._dt - [0.0, 0.0, self._gravity]
        truth = {
            "gyro": nu[:, 3:], "accelerometer": np.einsum("bji,bj->bi", rotation, force), "attitude": eta[:, 3:], "depth": eta[:, 2:3],
            "velocity": nu[:, :3], "position": eta[:, :2],
        }  # fmt: skip
        if altitude is not None:
            truth["altitude"] = altitude[:, None]
        return {kind: m for kind, value in truth.items() if (m := self._arriving(kind, value)) is not None}

    def _arriving(self, kind: str, truth: Array) -> Measurement | None:
        sensor, now = self._sensor(kind), self._step * self._dt
        every, age = max(1, round(sensor.period_s / self._dt)), round(sensor.delay_s / self._dt)
        queue = self._on_the_way[kind]
        queue.appendleft(None)
        if self._step % every == 0:
            values = truth + self._bias[kind] + self._factor * sensor.noise * self._normal(truth.shape[1])
            there = (self._uniform() >= sensor.dropout) & (not any(a <= now < b for a, b in sensor.outages))
            queue[0] = (values, there)
        arrived = queue[age]
        return None if arrived is None else Measurement(*arrived, age)
