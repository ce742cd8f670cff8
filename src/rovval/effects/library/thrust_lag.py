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
    equation="tau dn/dt = n_logged(t - dead) - n, solved exactly within each step and started from the log before the window (Fossen 2021, "
    "9.5; diagnosis.md A5). A lag of higher order is nearly one of first order behind a dead time (Ziegler and Nichols 1942).",
    parameters=(
        Parameter("tau", "s", 0.0, 3.0, 0.0, 0.15, "0.02 to 0.5 s; T200: 50 to 76 ms (diagnosis.md A5)"),
        Parameter("dead", "s", 0.0, 1.5, 0.0, 0.1, "bus and speed controller: 0 to 0.2 s; of a lag of third order, about half of its mean delay"),
    ),
    signature="follows every change of thrust, on all axes at once, gyro included",
    confused_with=("time_offset", "velocity_filter_lag", "added_mass"),
    separates="a sensor's delay shows in that sensor only; added mass leaves the steady oscillation's phase otherwise",
    refines=("dead",),
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """The plant's thruster memory takes the time constant, the thruster log the dead time."""
    return replace(lanes, lag=lanes.lag + p["tau"], shift=lanes.shift + p["dead"])
