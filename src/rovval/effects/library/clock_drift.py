"""One of the two clocks runs fast."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="clock_drift",
    title="Drift of a clock",
    place="sensor",
    equation="n_acting(t) = n_logged(t - rate t), t from the run's start (diagnosis.md S2). Positive: navigation falls behind.",
    parameters=(Parameter("rate", "s/s", -0.02, 0.02, 0.0, 5e-4, "0.5 s apart at the start, 4 s at the end of a log (diagnosis.md S2)"),),
    signature="the answer comes ever later (or earlier) through the log",
    confused_with=("time_offset", "thrust_lag"),
    separates="the offset estimated early and late in the log",
)


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log, more and more."""
    return replace(lanes, drift=lanes.drift + p["rate"])
