"""A current that changes in time: a steady trend, or a swing of one period."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from rovval.effects.arithmetic import Number, cos, sin
from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

TREND = "0.1 m/s within ten minutes (chosen; correlation times of 1e2 to 1e4 s)"
SWING = "as current_constant; gusts and eddies are smaller than the mean"

EFFECT = Effect(
    name="current_varying",
    title="Current changing in time",
    place="water",
    equation="v_c = rate t + amplitude sin(2 pi t / period + phase) and its time derivative, which also presses on the displaced water rho V: one period "
    "in place of a Gauss-Markov process.",
    symbols={
        "v_c": "horizontal velocity of the water (north, east); m/s",
        "rate": "its trend (north_rate, east_rate); m/s2",
        "amplitude": "of its swing (north, east); m/s",
        "t": "time since the run's start; s",
        "rho V": "mass of the displaced water; kg",
    },
    parameters=(
        Parameter("north_rate", "m/s2", -0.01, 0.01, 0.0, 2e-4, TREND),
        Parameter("east_rate", "m/s2", -0.01, 0.01, 0.0, 2e-4, TREND),
        Parameter("north", "m/s", -1.0, 1.0, 0.0, 0.1, SWING),
        Parameter("east", "m/s", -1.0, 1.0, 0.0, 0.1, SWING),
        Parameter(
            "period", "s", 20.0, 50000.0, 300.0, 300.0, "eddies to the tide of 12.42 h", role="period", starts=(60.0, 150.0, 400.0, 1000.0),
        ),
        Parameter(
            "phase", "rad", -2.0 * np.pi, 2.0 * np.pi, 0.0, 1.5, "any; a turn to spare, so that no fit stops half-way",
            role="phase", starts=(0.0, np.pi / 2),
        ),
    ),
    signature="a force fixed to north and east that drifts in time",
    confused_with=("current_constant", "voltage_sag", "clock_drift", "tether_tension"),
    separates="a long log with the same heading early and late",
    literature=("Fossen 2021, section 10.3: current velocity as a Gauss-Markov process", "DNV 2010, section 4.1: tidal and turbulent currents"),
    wanders=True,  # a Gauss-Markov process, of which one period is a part (Fossen 2021, section 10.3)
)
ROWS = ("north_rate", "east_rate", "north", "east", "omega", "phase")


def rows(lanes: Lanes, p: Mapping[str, Array]) -> dict[str, Array]:
    """Trend, swing and angular frequency."""
    return {**{name: p[name] for name in ROWS if name != "omega"}, "omega": 2.0 * np.pi / p["period"]}


def water(
    north_rate: Number, east_rate: Number, north: Number, east: Number, omega: Number, phase: Number, t: Number
) -> tuple[Number, ...]:
    """Velocity of the water, its change along the path, which is that at a fixed point."""
    s, c = sin(omega * t + phase), omega * cos(omega * t + phase)
    n, e = north_rate + north * c, east_rate + east * c
    return north_rate * t + north * s, east_rate * t + east * s, 0.0, n, e, 0.0, n, e, 0.0
