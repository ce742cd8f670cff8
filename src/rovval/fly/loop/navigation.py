"""An INS-like filter: inertial sensors carry the state forward, everything else corrects it as it arrives (Kalman 1960; Fossen 2011, 11.3 and 11.4).

Attitude: each Euler angle and the bias of its rate, driven by the gyro, corrected by the AHRS. Motion: position, velocity and the bias of the
acceleration along north, east and down, driven by the accelerometer turned by the attitude, corrected by DVL, depth and position fix. That bias, and the
gravity that leaks through a bias of the attitude, are fixed to the body and turn with it. A measurement that is late corrects by what the filter said when
it was taken (Larsen et al. 1998, without their correction of the gain).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import numpy as np

from rovval.core.data import Array, Flags
from rovval.core.frames import euler_rates, rotation_from_euler, wrap
from rovval.fly.loop.controllers import State
from rovval.fly.loop.sensors import Measurement
from rovval.fly.mission import Sensor, Sensors

BIAS_TIME_S = 600.0  # in which a bias of an inertial sensor wanders by its own size (chosen; data sheets give it within an hour)
MANOEUVRE = 1e-4  # (m/s2)^2, (rad/s)^2: least variance of a driven step, where a mission states sensors without noise


class Kalman:
    """``B`` lanes of ``A`` alike systems of ``n`` numbers: x <- F x + u, measured one number at a time."""

    def __init__(self, x: Array, p: Array, f: Array, q: Array) -> None:
        """``x`` (B, A, n), its covariance ``p`` (n, n), F and Q (n, n) of a sample."""
        self.x, self._p, self._f, self._q = x, np.tile(p, (*x.shape[:2], 1, 1)), f, q

    def predict(self, change: Array) -> None:
        """One sample on; ``change`` (B, A, n) is what drives it."""
        self.x = self.x @ self._f.T + change
        self._p = self._f @ self._p @ self._f.T + self._q

    def correct(self, number: int, systems: slice, off: Array, variance: float, there: Flags) -> None:
        """Number ``number`` of some systems is measured ``off`` (B, a) from what the filter says, with a ``variance``, in the lanes that are ``there`` (B,)."""
        p = self._p[:, systems]
        gain = np.where(there[:, None, None], p[..., number] / (p[..., number, number] + variance)[..., None], 0.0)
        x = self.x.copy()
        x[:, systems] += gain * off[..., None]
        all_p = self._p.copy()
        all_p[:, systems] = p - gain[..., None] * p[..., number, :][..., None, :]
        self.x, self._p = x, all_p


class Navigation:
    """State of ``B`` lanes from their instruments, begun where the vehicle is (an INS is aligned before the dive)."""

    def __init__(self, sensors: Sensors, nu: Array, eta: Array, gravity: float, dt: float, factor: float = 1.0) -> None:
        """``factor``: as the instruments' own."""
        self._sensors, self._gravity, self._dt, self._factor = sensors, gravity, dt, factor
        size, rotation = len(nu), rotation_from_euler(eta[:, 3:])
        gyro, accelerometer = self._variances(sensors.gyro), self._variances(sensors.accelerometer)
        wander = 2.0 * dt / BIAS_TIME_S
        f = np.array([[1.0, -dt], [0.0, 1.0]])
        attitude = np.stack([eta[:, 3:], np.zeros((size, 3))], axis=2)
        self._attitude = Kalman(attitude, np.diag([1e-6, gyro[1]]), f, np.diag([gyro[0] * dt**2, gyro[1] * wander]))
        f = np.array([[1.0, dt, -0.5 * dt**2], [0.0, 1.0, -dt], [0.0, 0.0, 1.0]])
        motion = np.stack([eta[:, :3], np.einsum("bij,bj->bi", rotation, nu[:, :3]), np.zeros((size, 3))], axis=2)
        tilt = (gravity * (self._variances(sensors.attitude)[0] ** 0.5 + self._variances(sensors.attitude)[1] ** 0.5)) ** 2  # gravity leaks through it
        leak = 2.0 * gravity**2 * self._variances(sensors.attitude)[0] * max(1.0, sensors.attitude.period_s / dt)  # through the filtered attitude's noise
        q = np.diag([0.0, (accelerometer[0] + leak) * dt**2, (accelerometer[1] + tilt) * wander])
        self._motion = Kalman(motion, np.diag([1e-4, 1e-4, accelerometer[1] + tilt]), f, q)
        self._rotation = rotation
        self._past: deque[tuple[Array, Array]] = deque(maxlen=64)
        self._rate = nu[:, 3:]
        self._sounded: tuple[Array, Array] | None = None  # altitude as last measured, and the depth there

    def _variances(self, sensor: Sensor) -> tuple[float, float]:
        return max((self._factor * sensor.noise) ** 2, MANOEUVRE * self._dt), (self._factor * sensor.bias) ** 2 + MANOEUVRE * self._dt

    def update(self, seen: Mapping[str, Measurement]) -> State:
        """The state now, from what arrived at this sample; the inertial sensors always do."""
        euler = self._attitude.x[:, :, 0]
        self._rate = np.where(seen["gyro"].there[:, None], seen["gyro"].values, self._rate)
        self._attitude.predict(np.stack([euler_rates(euler, self._rate) * self._dt, np.zeros_like(euler)], axis=2))
        self._measured(self._attitude, seen, "attitude", 0, slice(0, 3), angle=True)
        rotation = rotation_from_euler(self._attitude.x[:, :, 0])
        turn, self._rotation = rotation @ np.swapaxes(self._rotation, 1, 2), rotation
        self._motion.x[:, :, 2] = np.einsum("bij,bj->bi", turn, self._motion.x[:, :, 2])
        push = np.einsum("bij,bj->bi", rotation, seen["accelerometer"].values) + np.array([0.0, 0.0, self._gravity])
        push = np.where(seen["accelerometer"].there[:, None], push, 0.0)
        self._motion.predict(np.stack([0.5 * push * self._dt**2, push * self._dt, np.zeros_like(push)], axis=2))
        self._past.appendleft((self._motion.x, self._attitude.x))
        self._measured(self._motion, seen, "velocity", 1, slice(0, 3))
        self._measured(self._motion, seen, "depth", 0, slice(2, 3))
        self._measured(self._motion, seen, "position", 0, slice(0, 2))
        return self._state(seen.get("altitude"))

    def _measured(self, of: Kalman, seen: Mapping[str, Measurement], kind: str, number: int, systems: slice, angle: bool = False) -> None:
        if kind not in seen:
            return
        m, sensor = seen[kind], getattr(self._sensors, kind)
        back = m.age - 1 if angle else m.age  # the attitude is corrected before this sample joins the past
        then, attitude = self._past[min(back, len(self._past) - 1)][::-1 if angle else 1] if back >= 0 and self._past else (of.x, of.x)
        values = np.einsum("bij,bj->bi", rotation_from_euler(attitude[:, :, 0]), m.values) if kind == "velocity" else m.values
        off = values - then[:, systems, number]
        variance = max((self._factor * sensor.noise) ** 2, 1e-8)
        of.correct(number, systems, wrap(off) if angle else off, variance, m.there)

    def _state(self, sounded: Measurement | None) -> State:
        euler, depth = self._attitude.x[:, :, 0], self._motion.x[:, 2, 0]
        body = np.einsum("bji,bj->bi", rotation_from_euler(euler), self._motion.x[:, :, 1])
        nu = np.concatenate([body, self._rate - self._attitude.x[:, :, 1]], axis=1)
        eta = np.concatenate([self._motion.x[:, :, 0], wrap(euler)], axis=1)
        if sounded is not None:
            value, where = self._sounded or (sounded.values[:, 0], depth)
            self._sounded = (np.where(sounded.there, sounded.values[:, 0], value), np.where(sounded.there, depth, where))
        return State(nu, eta, None if self._sounded is None else self._sounded[0] - (depth - self._sounded[1]))
