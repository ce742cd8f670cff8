"""Thrust falls as the vehicle runs away with the water that the propellers take in."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes, reference_speed

REFERENCE = 1.0  # m/s

EFFECT = Effect(
    name="inflow_loss",
    title="Axial inflow loss",
    place="input",
    equation="T <- T - loss k n_ref |n| u_a / (1 m/s): a straight line of the thrust coefficient over the advance ratio, in all four quadrants.",
    symbols={
        "T": "thrust of a thruster, along its axis; N",
        "n": "shaft speed; rev/s",
        "u_a": "velocity of the vehicle through the water at the thruster, along its thrust; m/s",
        "k": "the thruster's gain in the direction in which it turns; N s2",
        "n_ref": "shaft speed at which all thrusters hold the vehicle at 1 m/s ahead; rev/s",
        "loss": "share of thrust lost at n_ref and 1 m/s",
    },
    parameters=(
        Parameter(
            "loss", "1", -0.2, 1.0, 0.0, 0.15, "10 to 40 % at top speed (chosen)", vanishes_at="high",
        ),
    ),
    signature="grows with thruster speed times vehicle speed: feels like drag while thrusting, and is gone when coasting",
    confused_with=("quadratic_drag", "linear_drag", "rpm_scale", "tether_drag"),
    separates="the same speed at different thrust: accelerating, steady, coasting",
    option="thrust.flow",
    literature=(
        "Fossen 2021, section 9.6: bilinear thruster model",
        "Healey 1995: thrust and the velocity of advance",
        "Kim and Chung 2006: thrust by the advance ratio",
    ),
)
ROWS = ("slope", "lean")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Thrust lost per speed of thruster and inflow, N s2 / m, per thruster: the mean of ahead and astern, and what ahead has more."""
    ahead, astern = (np.array([getattr(t, gain) for t in lanes.vehicle.thruster]) for gain in ("k_pos", "k_neg"))
    per_gain = p["loss"][:, None] * (0.5 * 60.0**2 * reference_speed(lanes.vehicle) / REFERENCE)
    return {"slope": per_gain * (ahead + astern), "lean": per_gain * (ahead - astern)}


def thrust(slope: Number, lean: Number, T: Number, n: Number, ua: Number) -> Number:
    """Thrust under way."""
    return T - (slope * abs(n) + lean * n) * ua
