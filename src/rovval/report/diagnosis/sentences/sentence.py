"""The diagnosis in sentences: the first screen, and then what else a reader must know before the numbers are used."""

from __future__ import annotations

from typing import Any

from rovval.diagnose.criteria import OUT_OF_TOLERANCE
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.common.numbers import number, per_cent, quantity
from rovval.report.diagnosis.sentences import no_cause, recalibration
from rovval.report.diagnosis.sentences.first_screen import first_screen
from rovval.report.diagnosis.sentences.plain import falls, falls_to, titled
from rovval.report.diagnosis.sentences.words import alone

VERDICTS = {
    "no_gap": "no gap beyond noise and tolerance",
    "explained": "explained",
    "partly_explained": "partly explained",
    "unknown": "unknown effect",
}


def verdict(d: Diagnosis) -> str:
    """The verdict in a few words."""
    return "no cause named" if no_cause.undecided(d) or no_cause.short(d) else VERDICTS[d.verdict]


def sentence(d: Diagnosis) -> str:
    """The first screen and all that belongs to it, as one paragraph."""
    return d.sentence or " ".join(part for part in (since(d), *first_screen(d), *_more(d)) if part)


def answer(d: Diagnosis) -> str:
    """The answer itself."""
    return d.answer or first_screen(d).what


def also(d: Diagnosis) -> list[str]:
    """What else must be known: how large the gap is, what each cause does, what gets worse, what is left, and what of the log is no measurement."""
    return [part for part in (since(d), *_more(d)) if part]


def _more(d: Diagnosis) -> list[str]:
    near = [no_cause.nearest(d)] if not d.causes and d.verdict == "no_gap" else []
    seen = [no_cause.sensors(d)] if not d.causes else []
    return [_gap(d), *_each(d), _beside_tolerance(d), _harm(d), _left(d), _unlogged(d), *near, *seen, recalibration.sentence(d), _log(d)]


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
    return f"Something begins at {d.since_s:.0f} s: causes were searched from there on. A vehicle written from this has them from its start."


def _gap(d: Diagnosis) -> str:
    if not d.gap.axes:
        return ""
    axis, row = max(d.gap.axes.items(), key=lambda item: item[1].share)
    times = row.rms / row.floor_rms if row.floor_rms > 0 else float("inf")
    floor = f", {number(times, 2)} times the sensor's noise" if times < 1e4 else ""
    healthy = d.verdict == "no_gap" and not no_cause.undecided(d) and times > 2.0 and d.calibration_slop
    why = f": coefficients that are off by their tolerance of {per_cent(d.calibration_slop)} make as much" if healthy else ""
    return f"In {axis} the simulator is {quantity(row.rms, row.unit)} rms off within {d.window_s:g} s of a restart from the measured motion{floor}{why}."


def _each(d: Diagnosis) -> list[str]:
    """What each of several causes does by itself."""
    if len(d.causes) < 2:
        return []
    return [f"{titled(c.effect)}: {alone(c) or f'by itself, the error {falls_to(c.shrinkage)}'}." for c in d.causes]


def _beside_tolerance(d: Diagnosis) -> str:
    """What the causes take away once healthy coefficients move, where with those as filed the gap does not surely shrink and it then does."""
    eased = d.within_tolerance
    overdrawn = d.detection is not None and d.detection.largest_departure > OUT_OF_TOLERANCE
    if not d.causes or overdrawn or d.shrinkage.low > 0 or eased is None or eased.low <= 0:
        return ""
    return (
        f"With all coefficients fitted within their tolerance of {per_cent(d.calibration_slop)} as well, the causes show better: of the error that those "
        f"leave, it {falls_to(eased)}."
    )


def _harm(d: Diagnosis) -> str:
    if not d.causes or not d.harm:
        return ""
    return "Worse with it: " + ", ".join(f"in {h.axis} the error {falls(-h.change)}" for h in d.harm) + "."


def _left(d: Diagnosis) -> str:
    text = no_cause.unexplained(d)
    return f"Left unexplained: {text}." if text and d.verdict in ("partly_explained", "unknown") else ""


def _unlogged(d: Diagnosis) -> str:
    """The force that nobody logged beside causes, where it speaks for something that only looks like them."""
    force = d.detection.unlogged_force if d.detection else None
    if force is None or force.evidence <= 0.0 or d.verdict == "no_gap":
        return ""
    alike = f", and {per_cent(force.alike)} beside what only looks like causes" if force.alike is not None else ""
    of = "the causes act" if len(d.causes) > 1 else "the cause acts" if d.causes else "what comes nearest acts"
    size = f"{per_cent(force.size)} of the thrusters' own" if force.size < 1.0 else f"{force.size:.2g} times as large as the thrusters' own there"
    return (
        f"Where {of}, a force is left that nobody logged, {size}; the median is "
        f"{per_cent(force.expected)} beside right causes{alike}."
    )


def _log(d: Diagnosis) -> str:
    """What of the log is no measurement, of several logs, of how many; and in how many windows nothing was compared."""
    found: dict[tuple[str, str], list[str]] = {}
    for row in d.log:
        found.setdefault((row.channel, row.finding), []).append(row.detail)
    said = [f"{channel} {details[0]}" + (f" (and in {len(details) - 1} more)" if len(details) > 1 else "") for (channel, _), details in found.items()]
    if d.windows_stopped:
        said.append(f"{d.windows_stopped} of {d.windows} windows, in which the simulation of the vehicle as it is filed stops, were left out")
    return f"Of the log: {'; '.join(said)}." if said else ""
