"""What is said of a vehicle's file that is off in many coefficients at once: the sentence, and the wordings of its tables."""

from __future__ import annotations

from rovval.diagnose.result.diagnosis import Coefficient, Diagnosis, Recalibration
from rovval.report.common.numbers import share
from rovval.report.diagnosis.sentences.plain import falls, falls_to
from rovval.report.diagnosis.sentences.words import parameter

TITLE = "Many coefficients off at once"
LEAD = "Not a cause: a badly calibrated vehicle file, or an effect that the library lacks and that many coefficients imitate."
WRITE = "Calibrate these numbers, or all of the file (`rovval fit` without `--parameters`), and diagnose again with the vehicle that is written:"
MOST = 3  # coefficients that fit a sentence


def sentence(d: Diagnosis) -> str:
    """How many coefficients are off and which most, how far the gap shrinks with them tuned, and that this is no cause; empty where nothing was tuned."""
    found = d.calibration
    if found is None:
        return ""
    most = ", ".join(f"{parameter(name, found.parameters[name])} ({times(found.parameters[name])})" for name in found.beyond[:MOST])
    beside = ", ".join(c.effect for c in d.causes)
    tuned = f"{len(found.parameters)} parameters tuned jointly{f', {beside} among them,' if beside else ''}"
    worse = ", ".join(f"in {h.axis} it {falls(-h.change)}" for h in found.harm)
    return (
        f"No one effect{' is shown to explain the rest' if beside else ''}: {len(found.beyond)} coefficients of the vehicle's file are off at once, "
        f"most of all {most}. With {tuned} the error {falls_to(found.shrinkage)} {held_out(found)}{f' (worse: {worse})' if worse else ''}. "
        "This may be a badly calibrated file, or an effect that the library lacks and that many coefficients imitate: calibrate the file with "
        "`rovval fit` (the command stands in the report) and diagnose again."
    )


def far(found: Recalibration) -> str:
    """How far the gap shrinks with all of them."""
    return f"Tuned jointly, the error {falls_to(found.shrinkage)} {held_out(found)} (its square shrinks by {_share(found)})."


def off_by(row: Coefficient) -> str:
    """How many tolerances, that it rests at a bound, that it is not the file's but a named cause's."""
    said = "of a named cause" if row.of_cause else times(row) if row.beyond else "not shown to be beyond its tolerance"
    return f"{said}, rests at its bound" if row.at_bound else said


def times(row: Coefficient) -> str:
    """17 times its tolerance."""
    return "no tolerance is stated" if row.departure is None else f"{abs(row.departure):.0f} times its tolerance"


def held_out(found: Recalibration) -> str:
    """On what the shrinkage was scored."""
    return f"on {found.held_out} left out of the fit"


def _share(found: Recalibration) -> str:
    return share(found.shrinkage.total, found.shrinkage.low, found.shrinkage.high)
