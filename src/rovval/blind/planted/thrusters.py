"""What a thruster does with the speed that the log says it turned."""

from __future__ import annotations

import numpy as np

from rovval.blind.plant.effect import Effect, Kinematics, Planting
from rovval.blind.plant.spec import Array


class _OneUnit(Effect):
    """Shared by effects on one thruster: the thrust of the target is multiplied by ``1 - loss``."""

    place = "input"
    targets = ("thruster",)
    share = 0.5
    most = 1.0

    def setup(self, plan: Planting) -> None:
        """Loss at full level."""
        self.loss = min(self.most, self.share * self.s)
        self.at = self.unit_index
        self.values = {"loss": self.loss}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Scale one unit."""
        out = thrust.copy()
        out[self.at] *= 1.0 - self.level(k.t) * self.loss
        return out


class Degraded(_OneUnit):
    """A fouled or chipped propeller: one unit gives less thrust at the same speed, all the time."""

    name = "thruster_degraded"
    form = "equal"
    unit = "half of the unit's thrust lost"


class FaultOnset(_OneUnit):
    """One unit loses thrust during the flight, over two seconds, while its shaft turns on (slipping or shed propeller)."""

    name = "thruster_fault_onset"
    event = True
    share = 0.8
    unit = "0.8 of the unit's thrust lost from the onset on"


class Reversed(Effect):
    """One shaft turns the other way than its log says (phase swap with the sign of the feedback uncorrected): thrust T(-n), not -T(n)."""

    name = "thruster_reversed"
    form = "equal"
    place = "input"
    targets = ("thruster",)
    unit = "fully reversed; 0.5 stands still"

    def setup(self, plan: Planting) -> None:
        """True over logged speed at full level."""
        self.turn = 1.0 - 2.0 * min(1.0, self.s)
        self.at = self.unit_index
        self.values = {"turn": self.turn}

    def speed(self, n: Array, k: Kinematics) -> Array:
        """Turn one shaft round."""
        out = n.copy()
        out[self.at] *= 1.0 + self.level(k.t) * (self.turn - 1.0)
        return out


class Deadband(Effect):
    """Little thrust at low speed: a smooth dead zone, the thrust is multiplied by 1 - exp(-(n/delta)^4)."""

    name = "thruster_deadband"
    place = "input"
    unit = "dead below about 0.45 of the working speed"

    def setup(self, plan: Planting) -> None:
        """Width, rpm."""
        self.width = 0.45 * self.s * plan.scale.rpm
        self.values = {"width_rpm": self.width}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Suppress the low speeds."""
        return np.asarray(thrust * (1.0 - self.level(k.t) * np.exp(-((k.turn / self.width) ** 4))))


class ReverseAsymmetry(Effect):
    """Thrust in reverse is weaker than the simulator has it, on every unit."""

    name = "reverse_asymmetry"
    form = "equal"
    place = "input"
    unit = "0.35 of the reverse thrust lost on every unit"

    def setup(self, plan: Planting) -> None:
        """Loss in reverse."""
        self.loss = min(1.0, 0.35 * self.s)
        self.values = {"loss": self.loss}

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """Scale the negative half."""
        return np.asarray(np.where(k.turn < 0.0, thrust * (1.0 - self.level(k.t) * self.loss), thrust))


class ThrustLag(Effect):
    """Thrust builds up after speed: three equal first-order stages in a row (the water column has to be set in motion)."""

    name = "thrust_lag"
    place = "input"
    unit = "0.15 of the vehicle's own time constant in all, at least 0.3 s"

    def setup(self, plan: Planting) -> None:
        """Total lag, s."""
        self.lag = self.s * max(0.3, 0.15 * plan.scale.time)
        self.many = len(plan.nominal.thrusters)
        self.values = {"lag_s": self.lag}

    def start(self, k: Kinematics) -> Array:
        """Three stages a unit, at rest."""
        return np.zeros(3 * self.many)

    def thrust(self, thrust: Array, k: Kinematics, own: Array) -> Array:
        """The last stage acts."""
        self.feed = thrust
        a = self.level(k.t)
        return np.asarray(thrust + a * (own[2 * self.many :] - thrust))

    def derivative(self, k: Kinematics, own: Array) -> Array:
        """Each stage follows the one before it."""
        before = np.concatenate([self.feed, own[: 2 * self.many]])
        return np.asarray((before - own) * (3.0 / self.lag))


class RpmScale(Effect):
    """The feedback reads wrong: the shaft turns slower than the log says (wrong pole count, gear or calibration)."""

    name = "rpm_scale"
    least = -3.0
    form = "equal"
    place = "input"
    unit = "logged speed 0.12 too high on every unit"

    def setup(self, plan: Planting) -> None:
        """Relative error of the reading."""
        self.excess = 0.12 * self.s
        self.values = {"relative": self.excess}

    def speed(self, n: Array, k: Kinematics) -> Array:
        """What turns, from what is read."""
        return np.asarray(n / (1.0 + self.level(k.t) * self.excess))


class VoltageSag(Effect):
    """The drive reports the speed it would turn at nominal voltage; the shaft follows the sagging supply."""

    name = "voltage_sag"
    place = "input"
    unit = "shaft speed in proportion to the voltage, which falls by 18 to 30 per cent during every log"

    def setup(self, plan: Planting) -> None:
        """Power of the voltage ratio."""
        self.values = {"power": self.s, "droop_at_end": plan.setting.droop}

    def speed(self, n: Array, k: Kinematics) -> Array:
        """Speed times voltage ratio to the power of the severity."""
        return np.asarray(n * k.volts ** (self.s * self.level(k.t)))
