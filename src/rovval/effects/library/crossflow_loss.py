"""Thrust falls as the vehicle moves across its thrusters."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.effects.arithmetic import Number, clip, positive
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

REFERENCE = 1.0  # m/s
HELD = 2.0  # m/s, beyond which the loss stays

EFFECT = Effect(
    name="crossflow_loss",
    title="Cross-flow loss of thrust",
    place="input",
    equation="T <- T (1 - loss min(v_across, 2 m/s) / (1 m/s)), and no less than none: loss is the share lost at 1 m/s across the thruster's axis, and no "
    "more than twice that.",
    symbols={
        "T": "thrust of a thruster, along its axis; N",
        "v_across": "speed of the vehicle through the water at the thruster, across its axis; m/s",
    },
    parameters=(
        Parameter(
            "loss", "1", -0.1, 1.0, 0.0, 0.1, "0 to 30 % (chosen); searched as far as all of it", vanishes_at="high",
        ),
    ),
    signature="weak thrust while moving sideways",
    confused_with=("inflow_loss", "cross_drag", "quadratic_drag"),
    separates="surge steps with and without sway speed",
    option="thrust.flow",
    literature=(
        "Kim and Chung 2006: thrust by speed and angle of the flow, linear at low speed",
        "Saunders and Nahon 2002: tunnel thrusters under way",
    ),
)
ROWS = ("loss",)
SHARED = True


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """The loss."""
    return {"loss": p["loss"]}


def thrust(loss: Number, T: Number, cross: Number) -> Number:
    """Thrust under way."""
    return T * positive(1.0 - loss * clip(cross, 0.0, HELD) * (1.0 / REFERENCE))
