"""Thrusters that turn fast draw air or cavitate, or their drives are at their limit."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, sqrt
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

WIDTH = 0.1  # of the speed at which it sets in: over which it does (chosen)

EFFECT = Effect(
    name="ventilation",
    title="Thrust lost at high shaft speed",
    place="input",
    equation="T <- T (1 - loss s), s = (1 + a / sqrt(1 + a^2)) / 2, a = (|n| / onset_speed - 1) / 0.1: next to nothing is lost well below that speed, "
    "the share loss well above it. That thrust comes back later than it went is not modelled.",
    symbols={
        "T": "thrust of every thruster, along its axis; N",
        "n": "its shaft speed; rev/s",
        "loss": "share that is lost",
        "onset_speed": "shaft speed at which half of that is; rev/s",
    },
    parameters=(
        Parameter("loss", "1", 0.0, 1.0, 0.0, 0.2, "up to nine tenths of the thrust (Kozlowska 2020)", vanishes_at="low"),
        Parameter("onset_speed", "rev/s", 3.0, 120.0, 25.0, 10.0, "working speeds (chosen)", "speed", role="extent", starts=(15.0, 25.0, 40.0)),
    ),
    signature="strong commands do little more than middling ones, those below that all they should",
    confused_with=("thruster_degraded", "rpm_scale", "hull_interaction", "voltage_sag"),
    separates="steps of thrust of several heights, near the surface and deep down",
    literature=("Kozlowska 2020: thrust loss of a propeller by ventilation", "Carlton 2018, chapter 9: cavitation and loss of thrust"),
)
ROWS = ("loss", "inverse")
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Share lost, and one over the speed, s."""
    return {"loss": p["loss"], "inverse": 1.0 / p["onset_speed"]}


def static(loss: Number, inverse: Number, T: Number, n: Number) -> Number:
    """Thrust that is left."""
    over = (abs(n) * inverse - 1.0) * (1.0 / WIDTH)
    return T * (1.0 - loss * (0.5 + 0.5 * over / sqrt(1.0 + over * over)))
