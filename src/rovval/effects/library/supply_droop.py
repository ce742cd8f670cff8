"""The supply of all thrusters gives way under their common load."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="supply_droop",
    title="Supply gives way under load",
    place="input",
    equation="T <- T / (1 + droop P), P = mean over all thrusters of |n / n_1|^3: voltage of a battery, or pressure of a hydraulic supply, falls with the "
    "power that is drawn from it, and the thrust of every thruster with that, whatever speed its drive reports.",
    symbols={
        "T": "thrust of every thruster, along its axis; N",
        "P": "power that all thrusters draw at their logged speeds, over what they draw at n_1; 1",
        "n": "shaft speed in the log; rev/s",
        "n_1": "speed at which all thrusters together hold the vehicle at 1 m/s ahead; rev/s",
        "droop": "thrust lost at that power, over what is left; 1",
    },
    parameters=(
        Parameter("droop", "1", 0.0, 5.0, 0.0, 0.2, "battery of 0.05 ohm and 15 V at 60 A: a fifth of the voltage, two fifths of the thrust (chosen)"),
    ),
    signature="strong commands of one axis weaken all others, too; small ones do what they should",
    confused_with=("voltage_sag", "rpm_scale", "ventilation"),
    separates="one axis by itself, then together with another at full power; a log of the supply's voltage",
    literature=("Tremblay and Dessaint 2009: battery voltage under load and with charge", "Blue Robotics T200: thrust at 10 to 20 V"),
)
ROWS = ("droop",)
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """How far it gives way."""
    return {"droop": p["droop"]}


def static(droop: Number, T: Number, load: Number) -> Number:
    """Thrust that is left under the ``load`` of all thrusters."""
    return T / (1.0 + droop * load)
