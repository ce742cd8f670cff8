"""The diagnosis in a few sentences: the gap, where, the causes, how far it shrinks, what is left and what to fly next."""

from __future__ import annotations

from typing import Any

from rovval.diagnose.criteria import OUT_OF_TOLERANCE
from rovval.diagnose.result.diagnosis import Cause, Diagnosis, Shrinkage
from rovval.report.common.numbers import number, per_cent, probability, quantity, share
from rovval.report.diagnosis import recalibration
from rovval.report.diagnosis.no_cause import nothing, undecided, unexplained
from rovval.report.diagnosis.words import alone, group, moved, parameter, unmoved

VERDICTS = {
    "no_gap": "no gap beyond noise and tolerance",
    "explained": "explained",
    "partly_explained": "partly explained",
    "unknown": "unknown effect",
}
MOST_VALUES = 3  # parameters of a cause that fit a sentence
LITTLE = 0.15  # of the squared gap: a cause that takes less away is told with the axis that it takes most of


def verdict(d: Diagnosis) -> str:
    """The verdict in a few words."""
    return "no cause named" if undecided(d) else VERDICTS[d.verdict]


def sentence(d: Diagnosis) -> str:
    """Gap, where, cause or group, shrinkage with its interval, what is left, the file's calibration, what to fly next, and what of the log is
    no measurement."""
    parts = [since(d), _gap(d), _where(d), _cause(d), _beside_tolerance(d), _harm(d), _left(d), recalibration.sentence(d), next_flight(d), _log(d)]
    return d.sentence or " ".join(p for p in parts if p)


def answer(d: Diagnosis) -> str:
    """The answer itself: the causes; where there are none, or they leave the gap as it is, and many coefficients are off, these."""
    named, still_open = _cause(d), d.verdict == "unknown" or unmoved(d.shrinkage)
    return d.answer or (f"{named} {recalibration.sentence(d)}".rstrip() if still_open else named)


def headline(d: Diagnosis) -> list[str]:
    """The answer, and then the rest of the sentences."""
    first, said = answer(d), sentence(d)
    rest = said.replace(first, "").replace("  ", " ").strip()
    return [first, rest] if rest else [said]


def facts(d: Diagnosis) -> dict[str, Any]:
    """The line under the title."""
    return {
        "verdict": verdict(d),
        "vehicle": d.vehicle,
        "model": d.model,
        "windows": f"{d.window_s:g} s",
        "calibration tolerance": per_cent(d.calibration_slop),
    }


def since(d: Diagnosis) -> str:
    """From where on the log was searched, where something begins in it that the windows before deny."""
    if d.since_s is None:
        return ""
    return f"Searched from {d.since_s:.0f} s on, where the log changes: what is named is not there before (a vehicle written from this has it always)."


def next_flight(d: Diagnosis) -> str:
    """The manoeuvre that separates a confusion group; empty where there is nothing to separate."""
    plan = d.next_experiment
    return f"To decide between {', '.join(plan.separates)}: fly {plan.manoeuvre.rstrip('.')}." if plan else ""


def _gap(d: Diagnosis) -> str:
    if not d.gap.axes:
        return "Nothing was measured on any axis."
    axis, row = max(d.gap.axes.items(), key=lambda item: item[1].share)
    times = row.rms / row.floor_rms if row.floor_rms > 0 else float("inf")
    floor = f", {number(times, 2)} times the sensor noise" if times < 1e4 else ""
    return f"Gap: largest in {axis} ({quantity(row.rms, row.unit)} rms in {d.window_s:g}-s windows{floor}; {per_cent(row.share)} of the weighted squared gap)."


def _where(d: Diagnosis) -> str:
    if d.verdict == "no_gap" or not d.gap.where:
        return ""
    said = [f"{per_cent(s.share)} of the {s.axis} gap at {s.regime} ({per_cent(s.time_share)} of the time)" for s in d.gap.where[:2]]
    return f"Where: {'; '.join(said)}."


def _cause(d: Diagnosis) -> str:
    """The causes, that there is none to name, or that it is none of the library."""
    if d.verdict == "no_gap":
        return nothing(d)
    if d.verdict == "unknown":
        return f"Unknown effect: {unexplained(d)}."
    said = [_one(c) for c in d.causes]
    total = f" Together they shrink the squared gap by {_share(d.shrinkage)}." if len(said) > 1 else ""
    return f"Cause{'s' if len(said) > 1 else ''}: {'; and '.join(said)}.{total}"


def _one(cause: Cause) -> str:
    """One cause with its main parameters, what this log cannot tell from it, and what it does by itself."""
    others = group(cause)[1:]
    values = ", ".join(parameter(name, p) for name, p in list(moved(cause.parameters).items())[:MOST_VALUES])
    onset = f" from {cause.onset_s:.0f} s on" if cause.onset_s is not None else ""
    other = f" or, indistinguishable in this log, {', '.join(others)}" if others else ""
    does = alone(cause) or f"by itself it shrinks the squared gap by {_share(cause.shrinkage)} on held-out windows{_most(cause.shrinkage)}"
    return f"{cause.effect}{onset} ({values}; probability {probability(cause.probability)}){other}; {does}"


def _most(s: Shrinkage) -> str:
    """The axis that a cause takes most of, where it takes little of all."""
    best = max(s.axes, key=lambda axis: s.axes[axis], default="")
    return f", that of {best} by {per_cent(s.axes[best])}" if best and s.total < LITTLE <= s.axes[best] else ""


def _beside_tolerance(d: Diagnosis) -> str:
    """What the causes take away once healthy coefficients move, where with those as filed the gap does not surely shrink and it then does."""
    eased = d.within_tolerance
    overdrawn = d.detection is not None and d.detection.largest_departure > OUT_OF_TOLERANCE
    if not d.causes or overdrawn or d.shrinkage.low > 0 or eased is None or eased.low <= 0:
        return ""
    return (
        f"With all coefficients fitted within their tolerance of {per_cent(d.calibration_slop)} as well, which answer to each other here, the causes "
        f"take away {share(eased.total, eased.low, eased.high)} of what those leave."
    )


def _harm(d: Diagnosis) -> str:
    if not d.causes or not d.harm:
        return ""
    return "Worse with it, in squared error: " + ", ".join(f"{h.axis} by {per_cent(h.change)}" for h in d.harm) + "."


def _left(d: Diagnosis) -> str:
    return f"Left: {unexplained(d)}." if d.verdict == "partly_explained" and d.left else ""


def _log(d: Diagnosis) -> str:
    """What of the log is no measurement, of several logs, of how many; and in how many windows nothing was compared."""
    found: dict[tuple[str, str], list[str]] = {}
    for row in d.log:
        found.setdefault((row.channel, row.finding), []).append(row.detail)
    said = [f"{channel} {details[0]}" + (f" (and in {len(details) - 1} more)" if len(details) > 1 else "") for (channel, _), details in found.items()]
    if d.windows_stopped:
        said.append(f"{d.windows_stopped} of {d.windows} windows, in which the simulation of the vehicle as it is filed stops, were left out")
    return f"Of the log: {'; '.join(said)}." if said else ""


def _share(s: Shrinkage) -> str:
    return share(s.total, s.low, s.high)
