"""The autopilot: PID depth (or altitude) and heading, PI speed ahead and aside (thesis 3.3.2), placed from the vehicle's own mass and drag.

Depth and heading: m x'' + d x' = F with a PID has its three poles at -w for Kp = 3 m w^2, Ki = m w^3, Kd = 3 m w - d (pole placement on the axis
linearised at rest: Fossen 2011, 12.2.3). Speed: m u' + d u = F with a PI by the rules of Skogestad (2003, SIMC): Kp = m w, Ki = max(d w, m w^2 / 4), d
linearised at the speed that is wanted. m is the vehicle's mass with added mass, d its drag. Set-points pass through a reference model with the same poles
(Fossen 2011, 10.2), whose velocity and acceleration give the force that the motion takes beforehand. An integral waits while its axis gets less than it
asks for. Roll and pitch are kept level by the same PID with faster poles: a light vehicle under way does not right itself (Munk's moment).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rovval.core.channels import AXES
from rovval.core.data import Array
from rovval.core.frames import rotation_from_euler, wrap
from rovval.fly.loop.allocation import Thrusters
from rovval.fly.mission import Control, Gains
from rovval.vehicle.model import Vehicle, as_matrix, rigid_body_mass

SPARE = 0.5  # of an axis's thrust is left to the feedback when a set-point moves: the ramp is no faster than the other half drives (chosen)
STEADIER = 3.0  # times the bandwidth of the other loops, which push with a level vehicle (chosen: of the order of Skogestad's 4, as fast as 10 Hz allows)


@dataclass(frozen=True, slots=True)
class State:
    """Where the vehicle is as the loop knows it: ``nu`` and ``eta`` (B, 6), ``altitude`` (B,) m or None without a bottom."""

    nu: Array
    eta: Array
    altitude: Array | None


@dataclass(frozen=True, slots=True)
class SetPoints:
    """What the autopilot is asked for, (B,) each; None: that axis is left alone. ``depth`` or ``altitude`` m, ``heading`` rad, ``surge`` and ``sway`` m/s."""

    depth: Array | None = None
    altitude: Array | None = None
    heading: Array | None = None
    surge: Array | None = None
    sway: Array | None = None

    @property
    def axes(self) -> tuple[str, ...]:
        """Axes that it controls."""
        given = {"heave": self.depth if self.altitude is None else self.altitude, "yaw": self.heading, "surge": self.surge, "sway": self.sway}
        return tuple(axis for axis in AXES if given.get(axis) is not None)


@dataclass(frozen=True, slots=True)
class Axis:
    """One axis of the vehicle, linearised for its controller: mass with added mass, linear and quadratic drag; SI."""

    mass: float
    linear: float
    quadratic: float

    def drag(self, speed: Array) -> Array:
        """Force that a steady speed takes."""
        return np.asarray((self.linear + self.quadratic * np.abs(speed)) * speed)

    def speed(self, force: float) -> float:
        """Steady speed under a force; infinite without any drag."""
        if not np.isfinite(force) or self.quadratic == 0.0:
            return force / self.linear if self.linear > 0 else np.inf
        return float((np.sqrt(self.linear**2 + 4 * self.quadratic * force) - self.linear) / (2 * self.quadratic))


def axis_of(vehicle: Vehicle, name: str) -> Axis:
    """An axis of a vehicle, from its file, whatever platform flies it: the same controller then flies all of them."""
    i = AXES.index(name)
    mass = rigid_body_mass(vehicle.body) + as_matrix(vehicle.body.added_mass)
    return Axis(float(mass[i, i]), *(float(as_matrix(d)[i, i]) for d in (vehicle.body.linear_drag, vehicle.body.quadratic_drag)))


def placed(axis: Axis, pole: float) -> Gains:
    """PID gains that put all three poles of an axis at -``pole`` rad/s, or where drag alone already damps more than that."""
    w = max(pole, axis.linear / (3.0 * axis.mass))
    return Gains(kp=3.0 * axis.mass * w**2, ki=axis.mass * w**3, kd=3.0 * axis.mass * w - axis.linear)


def strongest(thrusters: Thrusters, axis: str) -> float:
    """Greatest force N or moment N m along one axis alone, the weaker way; infinite where no limit is known, 0 where there is none."""
    part = thrusters.inverse[:, AXES.index(axis)]
    used = np.abs(part) > 1e-12
    return float((thrusters.most[used].min(axis=1) / np.abs(part[used])).min()) if used.any() else 0.0


class Tracking:
    """Depth or heading of ``B`` lanes: a smooth set-point and a PID about it."""

    def __init__(self, axis: Axis, control: Control, gains: Gains | None, force: float, dt: float, smooth: bool = True) -> None:
        """``gains`` in place of those that follow from the axis; ``force``: the greatest that there is, which limits how fast a set-point moves."""
        self._axis, self._gains, self._dt = axis, gains or placed(axis, control.bandwidth_rad_s), dt
        self._smooth, self._fastest = control.feedforward and smooth, axis.speed(SPARE * force)
        self._advance = _transition(control.bandwidth_rad_s, dt)
        self._reference: Array | None = None  # set-point as it moves: value, velocity, acceleration (B, 3)
        self._ramp = np.zeros(0)
        self._integral = np.zeros(0)

    def leave(self) -> None:
        """The axis is not controlled now: the next set-point starts from where the vehicle then is."""
        self._reference = None

    def force(self, wanted: Array, now: Array, rate: Array, angle: bool = False, fastest: float = np.inf) -> Array:
        """Force (B,) towards ``wanted`` (B,) where the vehicle is at ``now`` and moves at ``rate``; ``fastest`` limits the set-point's speed further."""
        if self._reference is None:
            self._reference, self._ramp = np.stack([now, rate, np.zeros_like(now)], axis=1), now.copy()
            self._integral = self._integral if len(self._integral) == len(now) else np.zeros_like(now)
        way = wrap(wanted - self._ramp) if angle else wanted - self._ramp
        most = min(self._fastest, fastest) * self._dt
        self._ramp = self._ramp + (np.clip(way, -most, most) if self._smooth else way)
        if self._smooth:
            self._reference = (self._reference - _at(self._ramp)) @ self._advance.T + _at(self._ramp)
            beforehand = self._axis.mass * self._reference[:, 2] + self._axis.drag(self._reference[:, 1])
        else:
            self._reference, beforehand = _at(self._ramp), np.zeros_like(now)
        error = self._reference[:, 0] - now
        self._error = wrap(error) if angle else error
        return np.asarray(
            beforehand + self._gains.kp * self._error + self._gains.kd * (self._reference[:, 1] - rate) + self._integral
        )  # fmt: skip

    def integrate(self, given: Array) -> None:
        """The integral goes on in lanes whose axis was ``given`` (B,) all of what it asked for."""
        if self._reference is not None:
            self._integral = self._integral + np.where(given >= 1.0, self._gains.ki * self._error * self._dt, 0.0)


class Cruise:
    """Speed along one axis of ``B`` lanes: a set-point that a first-order filter smooths, and a PI about it."""

    def __init__(self, axis: Axis, control: Control, gains: Gains | None, dt: float) -> None:
        """``gains`` in place of those that follow from the axis."""
        self._axis, self._given, self._pole, self._smooth, self._dt = axis, gains, control.bandwidth_rad_s, control.feedforward, dt
        self._reference: Array | None = None
        self._integral = np.zeros(0)

    def leave(self) -> None:
        """The axis is not controlled now."""
        self._reference = None

    def force(self, wanted: Array, now: Array) -> Array:
        """Force (B,) towards the speed ``wanted`` (B,) of a vehicle that goes at ``now``, m/s."""
        if self._reference is None:
            self._reference = now.copy()
            self._integral = self._integral if len(self._integral) == len(now) else np.zeros_like(now)
        step = (1.0 - np.exp(-self._pole * self._dt)) * (wanted - self._reference)
        self._reference = self._reference + step if self._smooth else wanted
        beforehand = self._axis.mass * step / self._dt + self._axis.drag(self._reference) if self._smooth else np.zeros_like(now)
        self._error = self._reference - now
        kp = self._given.kp if self._given else self._axis.mass * self._pole
        return np.asarray(beforehand + kp * self._error + self._integral)

    def integrate(self, given: Array) -> None:
        """The integral goes on in lanes whose axis was ``given`` (B,) all of what it asked for."""
        if self._reference is not None:
            slope = self._axis.linear + 2.0 * self._axis.quadratic * np.abs(self._reference)
            ki = self._given.ki if self._given else np.maximum(slope * self._pole, 0.25 * self._axis.mass * self._pole**2)
            self._integral = self._integral + np.where(given >= 1.0, ki * self._error * self._dt, 0.0)


class Autopilot:
    """All loops of ``B`` lanes together."""

    def __init__(self, vehicle: Vehicle, control: Control, thrusters: Thrusters, dt: float) -> None:
        """``dt`` s a sample."""
        heave, yaw, surge, sway = (axis_of(vehicle, name) for name in ("heave", "yaw", "surge", "sway"))
        self._depth = Tracking(heave, control, control.depth, strongest(thrusters, "heave"), dt)
        self._heading = Tracking(yaw, control, control.heading, strongest(thrusters, "yaw"), dt)
        self._surge, self._sway = Cruise(surge, control, control.surge, dt), Cruise(sway, control, control.sway, dt)
        able = [i for i in (3, 4) if control.level and thrusters.controlled[i]]
        level = {i: axis_of(vehicle, AXES[i]) for i in able}
        self._level = {i: Tracking(a, control, placed(a, STEADIER * control.bandwidth_rad_s), np.inf, dt, smooth=False) for i, a in level.items()}
        self._by_altitude = False

    def wrench(self, wanted: SetPoints, state: State, fastest: float = np.inf) -> Array:
        """Wrench (B, 6) N and N m, body axes; ``fastest`` m/s limits how fast a set-point of depth moves."""
        if self._by_altitude != (wanted.altitude is not None):
            self._by_altitude = not self._by_altitude
            self._depth.leave()
        rotation = rotation_from_euler(state.eta[:, 3:])
        wrench, body = np.zeros_like(state.nu), np.zeros((len(state.nu), 3))
        down = np.einsum("bj,bj->b", rotation[:, 2], state.nu[:, :3])
        height = wanted.depth if wanted.altitude is None else -wanted.altitude
        at = state.eta[:, 2] if wanted.altitude is None or state.altitude is None else -state.altitude
        loops: Sequence[tuple[Tracking | Cruise, Array | None]] = (
            (self._depth, height), (self._heading, wanted.heading), (self._surge, wanted.surge), (self._sway, wanted.sway),
        )  # fmt: skip
        for loop, asked in loops:
            if asked is None:
                loop.leave()
        if height is not None:
            body += rotation[:, 2] * self._depth.force(height, at, down, fastest=fastest)[:, None]
        if wanted.heading is not None:
            wrench[:, 5] = self._heading.force(wanted.heading, state.eta[:, 5], state.nu[:, 5], angle=True)
        if wanted.surge is not None:
            body[:, 0] += self._surge.force(wanted.surge, state.nu[:, 0])
        if wanted.sway is not None:
            body[:, 1] += self._sway.force(wanted.sway, state.nu[:, 1])
        wrench[:, :3] = body
        for i, loop in self._level.items():
            if wanted.axes:
                wrench[:, i] = loop.force(np.zeros(len(wrench)), state.eta[:, i], state.nu[:, i], angle=True)
            else:
                loop.leave()
        return wrench

    def integrate(self, given: Array) -> None:
        """The integrals go on, knowing which share of each axis (B, 6) the thrusters gave."""
        for loop, axis in ((self._depth, 2), (self._heading, 5), (self._surge, 0), (self._sway, 1)):
            loop.integrate(given[:, axis])
        for axis, level in self._level.items():
            level.integrate(given[:, axis])


def _at(value: Array) -> Array:
    """A reference (B, 3) at rest at a value (B,)."""
    return np.stack([value, np.zeros_like(value), np.zeros_like(value)], axis=1)


def _transition(pole: float, dt: float) -> Array:
    """Matrix (3, 3) that takes value, velocity and acceleration of x''' = -w^3 x - 3 w^2 x' - 3 w x'' through ``dt``: exp(A dt) by its series."""
    a = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-(pole**3), -3.0 * pole**2, -3.0 * pole]]) * dt
    term = total = np.eye(3)
    for n in range(1, 20):
        term = term @ a / n
        total = total + term
    return np.asarray(total)
