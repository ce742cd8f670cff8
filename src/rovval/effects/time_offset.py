"""Thrusters and navigation are stamped by clocks that are apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects import Effect, Parameter
from rovval.effects._lanes import Array, Lanes

EFFECT = Effect(
    name="time_offset",
    title="Time offset of navigation",
    place="sensor",
    equation="n_acting(t) = n_logged(t - tau), linear between samples, held at the log's ends (diagnosis.md S1). Positive: navigation is "
    "stamped late.",
    parameters=(Parameter("tau", "s", -2.0, 2.0, 0.0, 0.1, "+-0.5 s (diagnosis.md S1)"),),
    signature="the answer comes early or late by the same time on every axis",
    confused_with=("thrust_lag", "clock_drift", "velocity_filter_lag", "added_mass"),
    separates="an offset delays without smoothing; it can be negative",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log."""
    return replace(lanes, shift=lanes.shift + p["tau"])
