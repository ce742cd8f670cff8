"""One of the two clocks runs fast."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from rovval.effects.effect import Effect, Parameter, Tolerance
from rovval.effects.lanes import Array, Lanes

EFFECT = Effect(
    name="clock_drift",
    title="Drift of a clock",
    place="sensor",
    equation="n_acting(t) = n_logged(t - rate t). Positive: navigation falls behind.",
    symbols={
        "n_acting, n_logged": "shaft speeds that act and that are logged; rev/s",
        "t": "time since the run's start; s",
        "rate": "seconds that the clocks part in a second; s/s",
    },
    parameters=(
        Parameter(
            "rate", "s/s", -0.02, 0.02, 0.0, 5e-4, "logs that are 0.5 s apart at the start and 4 s at the end have been seen",
            tolerance=Tolerance(5e-5, "s/s: a quartz clock, 50 ppm", calibrated=False),
        ),
    ),
    signature="the answer comes ever later (or earlier) through the log",
    confused_with=("time_offset", "thrust_lag"),
    separates="the offset estimated early and late in the log",
    literature=("Eustice 2011: drift of the clocks of underwater vehicles", "Furgale 2013: temporal calibration of several sensors"),
    wanders=True,  # instability in a clock's data sheet
)
FULL_KERNEL = True


def lower(lanes: Lanes, p: Mapping[str, Array]) -> Lanes:
    """Shift the thruster log, more and more."""
    return replace(lanes, drift=lanes.drift + p["rate"])
