"""What a drive and its propeller make of the speed that the log says."""

from __future__ import annotations

import math

import numpy as np

from rovval.blind.plant.spec import STEP_S, Array
from rovval.blind.second.fault import Fault, Instant
from rovval.blind.second.hull import Hull


class ThrusterDegraded(Fault):
    """A chipped blade or a line about the hub: less thrust, a little more of it lost at high speed."""

    name, place, targets = "thruster_degraded", "input", ("thruster",)
    unit = "0.45 of the unit's thrust lost at working speed"

    def prepare(self) -> None:
        """Loss."""
        self.loss = min(1.0, 0.45 * self.size)
        self.values = {"loss_at_working_speed": self.loss}

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Loss of 0.9 to 1.1 times the stated."""
        out = thrust.copy()
        fast = min(1.0, abs(float(s.spin[self.at_unit])) / self.sheet.rpm)
        out[self.at_unit] *= 1.0 - self.on(s.t) * min(1.0, self.loss * (0.9 + 0.2 * fast * fast))
        return out


class ThrusterFaultOnset(ThrusterDegraded):
    """A blade breaks during the flight."""

    name, event = "thruster_fault_onset", True
    unit = "0.45 of the unit's thrust lost from the onset on"


class ThrusterReversed(Fault):
    """Two phases are swapped and the drive reports the speed it was asked for: the shaft turns the other way."""

    name, place, form, targets = "thruster_reversed", "input", "equal", ("thruster",)
    unit = "the whole speed the other way; more is no more"

    def prepare(self) -> None:
        """Always whole."""
        self.values = {"turn": -1.0}

    def spins(self, n: Array, s: Instant) -> Array:
        """The other way round."""
        out = n.copy()
        out[self.at_unit] *= 1.0 - 2.0 * self.on(s.t)
        return out


class ThrusterDeadband(Fault):
    """No thrust until water moves: thrust is that of the speed less a threshold (a soft shrinkage)."""

    name, place = "thruster_deadband", "input"
    unit = "a threshold of 0.12 of the working speed"

    def prepare(self) -> None:
        """Threshold, rpm."""
        self.dead = 0.12 * self.size * self.sheet.rpm
        self.values = {"threshold_rpm": self.dead}

    def spins(self, n: Array, s: Instant) -> Array:
        """Speeds less the threshold, all of it missing below."""
        soft = np.abs(n) - self.dead
        kept = 0.5 * (soft + np.sqrt(soft * soft + (0.1 * self.dead) ** 2))
        return np.asarray(n + self.on(s.t) * (np.sign(n) * np.minimum(np.abs(n), kept) - n))


class ReverseAsymmetry(Fault):
    """Astern the blades stall: thrust in reverse goes as a lower power of speed and is weaker at working speed."""

    name, place = "reverse_asymmetry", "input"
    unit = "0.35 of the thrust in reverse lost at working speed, more above and less below"

    def prepare(self) -> None:
        """Loss."""
        self.loss = min(0.8, 0.35 * self.size)
        self.values = {"loss_at_working_speed": self.loss, "power": 0.15}

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """Weaker where the shaft turns astern."""
        loss = np.minimum(0.95, self.on(s.t) * self.loss * (np.abs(s.spin) / self.sheet.rpm + 1e-6) ** 0.15)
        return np.asarray(np.where(s.spin < 0.0, thrust * (1.0 - loss), thrust))


class ThrustLag(Fault):
    """The slug of water in the duct has to be set in motion: first order, no faster than a limit, after a dead time of a tenth of a second."""

    name, place = "thrust_lag", "input"
    unit = "a time constant of 0.12 of that of the vehicle in surge, at least 0.25 s"

    def prepare(self) -> None:
        """Time constant, s; limit, N/s."""
        own = (self.sheet.mass + float(self.sheet.added[0, 0])) * self.sheet.cruise / self.sheet.force
        self.tau = self.size * max(0.25, 0.12 * own)
        self.fastest = 1.5 * self.sheet.thrust / self.tau
        self.values = {"tau_s": self.tau, "fastest_n_s": self.fastest, "dead_s": 0.1}
        self.acting, self.queue = np.zeros(len(self.sheet.units)), [np.zeros(len(self.sheet.units))] * 5

    def pushes(self, thrust: Array, s: Instant) -> Array:
        """The water's thrust acts."""
        self.fed = thrust
        return np.asarray(thrust + self.on(s.t) * (self.acting - thrust))

    def advance(self, s: Instant, dt: float) -> None:
        """Follow what was asked a tenth of a second ago."""
        self.queue = [*self.queue[1:], self.fed]
        change = (self.queue[0] - self.acting) * -math.expm1(-dt / self.tau)
        self.acting = self.acting + np.clip(change, -self.fastest * dt, self.fastest * dt)


class RpmScale(Fault):
    """The feedback is scaled wrong."""

    name, place, form, both_signs = "rpm_scale", "input", "equal", True
    unit = "the shafts turn 0.1 slower than the log says"

    def prepare(self) -> None:
        """Share."""
        self.share = min(0.5, 0.1 * self.size)
        self.values = {"relative": 1.0 / (1.0 - self.share) - 1.0}

    def spins(self, n: Array, s: Instant) -> Array:
        """Slower."""
        return np.asarray(n * (1.0 - self.on(s.t) * self.share))


class VoltageSag(Fault):
    """The drive scales its report by the nominal voltage: speed falls with the supply, less at light load."""

    name, place = "voltage_sag", "input"
    unit = "speed in proportion to the voltage at working speed, to its root at the lowest speeds"

    def prepare(self) -> None:
        """Power."""
        self.values = {"power": self.size, "sag_at_end": self.site.sag}

    def spins(self, n: Array, s: Instant) -> Array:
        """Slower with the voltage."""
        load = np.minimum(1.0, 0.5 + 0.5 * np.abs(n) / self.sheet.rpm)
        return np.asarray(n * max(0.1, s.volts) ** (self.size * self.on(s.t) * load))


class ThrusterSticking(Fault):
    """One shaft does not start until its drive pulls hard, and then runs until it has all but stopped (hysteresis of dry friction)."""

    name, place, targets = "thruster_sticking", "input", ("thruster",)
    unit = "starts at 0.45 of the working speed and stops at half of that"

    def prepare(self) -> None:
        """Speeds, rpm."""
        self.starts = 0.45 * self.size * self.sheet.rpm
        self.runs = False
        self.values = {"starts_rpm": self.starts, "stops_rpm": 0.5 * self.starts}

    def advance(self, s: Instant, dt: float) -> None:
        """Start or stop."""
        speed = abs(float(s.n[self.at_unit]))
        self.runs = speed > (0.5 * self.starts if self.runs else self.starts)

    def spins(self, n: Array, s: Instant) -> Array:
        """Nothing while it sticks."""
        out = n.copy()
        if not self.runs:
            out[self.at_unit] *= 1.0 - self.on(s.t)
        return out


class ThrusterMisaligned(Fault):
    """A bracket has turned: one unit's thrust points elsewhere, and its moment arm goes with it."""

    name, place, form, targets = "thruster_misaligned", "vehicle", "equal", ("thruster",)
    unit = "18 degrees about an axis across the unit"

    def prepare(self) -> None:
        """Axis and angle."""
        aim = self.sheet.aim[self.at_unit]
        across = np.cross(aim, self.rng.normal(size=3))
        self.across, self.angle = across / np.linalg.norm(across), math.radians(18.0) * self.size
        self.values = {"angle_rad": self.angle, "about": self.across.tolist()}

    def alter(self, hull: Hull, on: float) -> None:
        """Turn it (Rodrigues, axis across)."""
        aim, a = hull.aim[self.at_unit], on * self.angle
        turned = math.cos(a) * aim + math.sin(a) * np.cross(self.across, aim) + (1.0 - math.cos(a)) * float(self.across @ aim) * self.across
        hull.aim[self.at_unit] = turned


class PropellerTorque(Fault):
    """The reaction to each propeller's torque, of one hand for all, with what speeds it up (a flywheel's share)."""

    name = "propeller_torque"
    unit = "torque over thrust of 0.1 of the half-length"

    def prepare(self) -> None:
        """Arm, m; inertia of a rotor such that a start in half a second takes as much again."""
        self.arm = 0.1 * self.size * self.sheet.half_length
        self.wheel = 0.3 * self.arm * self.sheet.thrust * 0.5 / self.sheet.rpm
        self.before, self.rate = np.zeros(len(self.sheet.units)), np.zeros(len(self.sheet.units))
        self.values = {"arm": self.arm}

    def advance(self, s: Instant, dt: float) -> None:
        """Acceleration of the shafts, smoothed over a row."""
        self.rate = self.rate + (dt / STEP_S) * ((s.spin - self.before) / dt - self.rate)
        self.before = s.spin

    def wrench(self, s: Instant) -> Array:
        """Moments about the units' axes."""
        torque = self.arm * np.abs(s.static) * np.sign(s.spin) + self.wheel * self.rate
        return np.array([0.0, 0.0, 0.0, *(-self.on(s.t) * torque @ self.sheet.aim)])
