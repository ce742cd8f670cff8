"""Thrust falls with the supply voltage."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="voltage_sag",
    title="Voltage sag",
    place="input",
    equation="T <- T (1 + gain ((V/V_0)^2 - 1)) (1 - rate t): gain 1 is T ~ V^2 at a fixed command.",
    symbols={
        "T": "thrust of every thruster, along its axis; N",
        "V": "logged supply voltage; V",
        "V_0": "voltage of the vehicle's thrust table, else the log's first; V",
        "rate": "steady loss since the run's start; 1/s",
        "t": "time since the run's start; s",
    },
    parameters=(
        Parameter("gain", "1", -1.0, 2.0, 0.0, 0.5, "T ~ V^2 at a fixed command; 0 where the logged speed already sags", needs="voltage"),
        Parameter("rate", "1/s", 0.0, 5e-4, 0.0, 5e-5, "25 % within a dive of some hours (chosen); no supply recovers in a dive"),
    ),
    signature="every thruster weakens together, slowly, and at heavy load",
    confused_with=("rpm_scale", "current_varying", "thruster_degraded"),
    separates="a log of the voltage; steps of load",
    literature=("Blue Robotics T200: thrust at 10 to 20 V", "Tremblay and Dessaint 2009: battery voltage under load and with charge"),
)
ROWS = ("gain", "rate")
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Gain and rate."""
    return {name: p[name] for name in ROWS}


def static(gain: Number, rate: Number, T: Number, t: Number, voltage: Number) -> Number:
    """Thrust at the voltage (``voltage`` is the ratio to the reference)."""
    return T * (1.0 + gain * (voltage * voltage - 1.0)) * (1.0 - rate * t)
