"""Wordings that every format of a diagnosis uses: a cause and its parameters, what it does to the gap, where the gap lies."""

from __future__ import annotations

from collections.abc import Mapping

from rovval import effects
from rovval.core.units import in_degrees
from rovval.diagnose.result.diagnosis import AxisGap, Cause, Coefficient, Diagnosis, GapSlice, Parameter, SensorFault, Shrinkage
from rovval.report.common.numbers import MISSING, estimate, number, per_cent, probability, share
from rovval.report.diagnosis.sentences.plain import falls_to, remaining, when

SCOPE = "Every number is about this simulator, this log and this library of effects."
SQUARED = "Errors are told as rms. Shares of the gap are of squared errors, which add up: an error that falls to a half leaves a quarter of them."
RUNS_DIFFER = 0.01  # probability that runs of one value differ by as much, below which the reader is asked what changed (chosen)
MOST_PAIRS = 3  # of parameters that are seen together only: enough to say it
UNMOVED = 0.005  # of the squared gap: a change that rounds to nothing


def sensor_tolerance(name: str) -> float | None:
    """What a healthy sensor may be off by, in the unit of the effect's parameters; None for an effect of no sensor."""
    return effects.sensor_tolerance(name.partition(".")[0].partition("[")[0])


def group(cause: Cause) -> list[str]:
    """The cause and what this log cannot tell from it, the cause first."""
    return list(dict.fromkeys([cause.effect, *cause.group]))


def parameter(name: str, p: Parameter | Coefficient | SensorFault) -> str:
    """loss = 0.299 [0.241, 0.358]."""
    return f"{name} = {estimate(p.value, p.low, p.high, p.unit)}"


def runs(name: str, p: Parameter) -> str:
    """What each of several runs says of a parameter, and whether they agree; empty for one run.

    loss by run: dive_1 0.299 [0.241, 0.358], dive_2 0.31 [0.25, 0.37]; runs of one value would differ as much with probability 0.64.
    """
    if not p.by_run:
        return ""
    said = f"{name} by run: " + ", ".join(f"{run} {estimate(v.value, v.low, v.high, p.unit)}" for run, v in p.by_run.items())
    if p.homogeneity is None:
        return f"{said}; the other runs say too little of it"
    differ = f"runs of one value would differ as much with probability {probability(p.homogeneity)}"
    return f"{said}; {differ}" + (": what changed between these runs?" if p.homogeneity < RUNS_DIFFER else "")


def together(cause: Cause) -> str:
    """Parameters that the log hardly tells apart; empty where there are none.

    seen together only (correlation): down and weight (-0.99)
    """
    told = [f"{' and '.join(pair.of)} ({number(pair.value, 2)})" for pair in cause.together if set(pair.of) <= set(moved(cause.parameters))]
    return f"seen together only (correlation): {', '.join(told[:MOST_PAIRS])}" if told else ""


def beside(cause: Cause) -> list[str]:
    """What is said of a cause's parameters beside their values: what each run says, and which are seen together only."""
    told = [*(runs(name, p) for name, p in moved(cause.parameters).items()), together(cause)]
    return [line for line in told if line]


def moved(parameters: Mapping[str, Parameter]) -> Mapping[str, Parameter]:
    """The parameters that the fit moved. One that rests where the effect changes nothing says nothing: a log without the tether's length cannot
    move the drag per length."""
    return {name: p for name, p in parameters.items() if p.null is None or p.value != p.null} or parameters


def unmoved(shrinkage: Shrinkage) -> bool:
    """Whether the gap stays as it is."""
    return abs(shrinkage.total) < UNMOVED


def shown_to_shrink(d: Diagnosis) -> bool:
    """Whether the gap surely shrinks with the causes, by themselves or with all coefficients fitted within their tolerance as well."""
    return any(reduction is not None and reduction.low > 0 for reduction in (d.shrinkage, d.within_tolerance))


def alone(cause: Cause) -> str:
    """What a cause does by itself to a gap that it hardly changes; empty where it changes it."""
    if not unmoved(cause.shrinkage):
        return ""
    if sensor_tolerance(cause.effect) is not None:
        return "it is seen by the sensors' own check and does not change the simulated motion"
    return "by itself it changes the simulated motion too little to see"


def shrinks(cause: Cause) -> str:
    """To what the error falls with a cause by itself and by how much its square, or that it stays as it is."""
    s = cause.shrinkage
    held = " on data left out of the fit" if s.held_out else ""
    return alone(cause) or f"by itself, the error {falls_to(s)}{held} (its square shrinks by {share(s.total, s.low, s.high)})"


def rms_change(axis: AxisGap | None, less: float) -> str:
    """An axis's rms before and with a cause that takes the share ``less`` of its squared error away: 0.074 to 0.040 m/s."""
    if axis is None:
        return MISSING
    before, unit = in_degrees(axis.rms, axis.unit)
    return f"{number(before, 2)} to {number(before * remaining(less), 2)} {unit}"


def where(diagnosis: Diagnosis, most: int = 5) -> list[str]:
    """The slices of axis and regime that matter most, the worst first."""
    return [gap_slice(s) for s in diagnosis.gap.where[:most]]


def gap_slice(s: GapSlice) -> str:
    """68 % of the yaw gap arises when turning faster than 3.6 deg/s, in 21 % of the time."""
    return f"{per_cent(s.share)} of the {s.axis} gap arises {when(s.regime)}, in {per_cent(s.time_share)} of the time"


def changes(diagnosis: Diagnosis) -> str:
    """When the gap changes; empty where it does not."""
    points = ", ".join(f"{number(t, 4)} s" for t in diagnosis.gap.change_points_s)
    return f"The gap changes at {points}." if points else ""


def disturbances(diagnosis: Diagnosis) -> str:
    """The forces that nobody logged, as large as every fit allows for; empty where none was fitted."""
    rows = [(axis, p) for axis, p in diagnosis.disturbance.items() if p.rms > 0.0]
    said = [f"{axis} {number(p.rms, 2)} {p.unit} ({number(p.memory_s, 2)} s)" for axis, p in rows]
    return f"Forces that nobody logged, as large as every fit allows for (rms; in brackets how long one lasts): {', '.join(said)}." if said else ""
