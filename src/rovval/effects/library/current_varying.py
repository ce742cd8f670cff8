"""A current that changes in time: it runs through an ellipse about its mean, as a tide does."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, sin
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

MEAN = "as `current_constant`, which it is without its change"
SWING = "as current_constant; gusts and eddies are smaller than the mean"

EFFECT = Effect(
    name="current_varying",
    title="Current changing in time",
    place="water",
    equation="v_c = mean + sine sin(2 pi t / period) + cosine cos(2 pi t / period) and its time derivative, which also presses on the displaced water rho V: "
    "one ellipse in place of a Gauss-Markov process, which has a mean over any log that does not outlast it by far, and, of a period much longer than the log, "
    "a trend.",
    symbols={
        "v_c": "horizontal velocity of the water (north, east); m/s",
        "mean": "what it is without its change (north_mean, east_mean); m/s",
        "sine, cosine": "its two parts (north, east; north_cosine, east_cosine); m/s",
        "t": "time since the run's start; s",
        "rho V": "mass of the displaced water; kg",
    },
    parameters=(
        Parameter("north", "m/s", -1.0, 1.0, 0.0, 0.1, SWING),
        Parameter("east", "m/s", -1.0, 1.0, 0.0, 0.1, SWING),
        Parameter("north_cosine", "m/s", -1.0, 1.0, 0.0, 0.1, SWING),
        Parameter("east_cosine", "m/s", -1.0, 1.0, 0.0, 0.1, SWING),
        Parameter("north_mean", "m/s", -2.0, 2.0, 0.0, 0.15, MEAN),
        Parameter("east_mean", "m/s", -2.0, 2.0, 0.0, 0.15, MEAN),
        Parameter(
            "period", "s", 20.0, 50000.0, 300.0, 300.0, "eddies to the tide of 12.42 h", role="period", starts=(60.0, 150.0, 400.0, 1000.0),
        ),
    ),
    signature="a force fixed to north and east that drifts in time",
    confused_with=("current_constant", "voltage_sag", "clock_drift", "tether_tension"),
    separates="a long log with the same heading early and late",
    literature=(
        "Fossen 2021, section 10.3: current velocity as a Gauss-Markov process",
        "DNV 2010, section 4.1: tidal and turbulent currents",
        "Pugh and Woodworth 2014: ellipses of tidal currents",
    ),
    refines=("north_mean", "east_mean"),
    wanders=True,  # a Gauss-Markov process, of which one period is a part (Fossen 2021, section 10.3)
)
ROWS = ("north", "east", "north_cosine", "east_cosine", "north_mean", "east_mean", "omega")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Ellipse, mean and angular frequency."""
    return {**{name: p[name] for name in ROWS if name != "omega"}, "omega": 2.0 * np.pi / p["period"]}


def water(
    north: Number, east: Number, north_cosine: Number, east_cosine: Number, north_mean: Number, east_mean: Number, omega: Number, t: Number
) -> tuple[Number, ...]:
    """Velocity of the water, its change along the path, which is that at a fixed point."""
    s, c = sin(omega * t), cos(omega * t)
    n, e = omega * (north * c - north_cosine * s), omega * (east * c - east_cosine * s)
    return north_mean + north * s + north_cosine * c, east_mean + east * s + east_cosine * c, 0.0, n, e, 0.0, n, e, 0.0
