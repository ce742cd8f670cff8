"""The speed that acts lags behind the speed that was commanded or logged."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="thrust_lag",
    title="Thruster lag",
    place="input",
    equation="tau dn/dt = n_logged(t - dead) - n, solved exactly within each step and started from the log before the window. A lag of higher order is "
    "nearly one of first order behind a dead time.",
    symbols={
        "n": "shaft speed that acts; rev/s",
        "n_logged": "shaft speed in the log; rev/s",
        "tau": "time constant; s",
        "dead": "dead time; s",
        "t": "time since the run's start; s",
    },
    parameters=(
        Parameter("tau", "s", 0.0, 3.0, 0.0, 0.15, "0.02 to 0.5 s (chosen); T200: 50 to 76 ms (von Benzon 2022)"),
        Parameter(
            "dead", "s", 0.0, 1.5, 0.0, 0.1, "bus and speed controller: 0 to 0.2 s (chosen); of a lag of third order, about half of its mean delay",
        ),
    ),
    signature="follows every change of thrust, on all axes at once, gyro included",
    confused_with=("time_offset", "velocity_filter_lag", "added_mass"),
    separates="a sensor's delay shows in that sensor only; added mass leaves the steady oscillation's phase otherwise",
    literature=(
        "Fossen 2021, section 9.5: thruster dynamics",
        "Yoerger 1990: thruster dynamics dominate at low speed",
        "Healey 1995: two-state thruster model",
        "von Benzon 2022: third-order model of the T200",
        "Ziegler and Nichols 1942: dead time and first-order lag for a lag of higher order",
    ),
    refines=("dead",),
    far=(3.0,),  # a lag of half a second is no multiple of a short one (chosen)
    in_file=True,
)
FULL_KERNEL = True


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant's thruster memory takes the time constant, the thruster log the dead time."""
    return replace(lanes, lag=lanes.lag + p["tau"], shift=lanes.shift + p["dead"])
