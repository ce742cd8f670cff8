"""The diagnosis in a few sentences, read off the document."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.core.units import in_degrees
from rovval.diagnose.inference.prior import SENSORS, STRAINED
from rovval.report.diagnosis.calibration_words import calibration
from rovval.report.diagnosis.nothing import nothing, open_gap, undecided
from rovval.report.diagnosis.phrases import chance, family, span, value, whole

__all__ = ["alone", "calibration", "cause", "chance", "first", "moved", "nothing", "open_gap", "sentence", "undecided", "unmoved"]
MOST_VALUES = 3  # parameters of a cause that fit a sentence
LITTLE = 0.15  # of the gap: less than a cause closes for its name, unless an axis shows it (`together`)
UNMOVED = 0.005  # of the gap: less rounds to nothing


def sentence(document: dict[str, Any]) -> str:
    """Gap, where, cause or group, shrinkage with its interval, what is left, the file's calibration, what to fly next, and what of the log is
    no measurement."""
    parts = [since(document), _gap(document), _where(document), cause(document), beside_slop(document), _harm(document), _left(document)]
    parts += [calibration(document), _next(document), _log(document)]
    return " ".join(p for p in parts if p)


def first(document: dict[str, Any]) -> str:
    """The answer itself: the cause; where there is none, or it leaves the gap as it is, and many coefficients are off, these."""
    named, open_still = cause(document), document["verdict"] == "unknown" or unmoved(document.get("shrinkage") or {})
    return f"{named} {calibration(document)}".rstrip() if open_still else named


def moved(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters that the fit moved. One that rests where nothing is at work says nothing: a log without the tether's length cannot move
    the drag per length."""
    away = {name: p for name, p in parameters.items() if p.get("null") is None or p.get("value") != p["null"]}
    return away or dict(parameters)


def alone(cause: Mapping[str, Any]) -> str:
    """What a cause does by itself to a gap that it hardly changes; empty where it changes it."""
    if not unmoved(cause.get("shrinkage") or {}):
        return ""
    sensor = family(cause["effect"]) in SENSORS
    return "seen by the kinematic checks alone; it does not change the simulated motion" if sensor else "by itself it leaves the squared gap as it is"


def unmoved(shrinkage: Mapping[str, Any]) -> bool:
    """Whether the gap stays as it is."""
    total = shrinkage.get("total")
    return total is not None and abs(total) < UNMOVED


def since(document: Mapping[str, Any]) -> str:
    """From where the log is told, where something begins in it that the windows before deny."""
    begins = document.get("since_s")
    if begins is None:
        return ""
    return f"Told from {begins:.0f} s on, where the log changes: what is named is not there before (a vehicle written from this has it always)."


def _gap(document: dict[str, Any]) -> str:
    axes = document["gap"]["axes"]
    if not axes:
        return "Nothing was measured on any axis."
    axis, row = max(axes.items(), key=lambda item: item[1]["share"])
    times = row["rms"] / row["floor_rms"] if row["floor_rms"] > 0 else float("inf")
    rms, unit = in_degrees(row["rms"], row["unit"])
    size = f"{rms:.3g} {unit} rms in {document['window_s']:g}-s windows"
    floor = f", {times:.{1 if times < 10 else 0}f} times the sensor noise" if times < 1e4 else ""
    return f"Gap: largest in {axis} ({size}{floor}; {100 * row['share']:.0f} % of the weighted squared gap)."


def _where(document: dict[str, Any]) -> str:
    where = document["gap"]["where"]
    if document["verdict"] == "no_gap" or not where:
        return ""
    return "Where: " + "; ".join(
        f"{100 * s['share']:.0f} % of the {s['axis']} gap at {s['regime']} ({100 * s['time_share']:.0f} % of the time)" for s in where[:2]
    ) + "."


def cause(document: dict[str, Any]) -> str:
    """The answer itself: the causes, that there is none to name, or that it is none of the library."""
    verdict = document["verdict"]
    if verdict == "no_gap":
        return nothing(document)
    if verdict == "unknown":
        return f"Unknown effect: {document['left']['text']}."
    words = [_one(c) for c in document["causes"]]
    together = document["shrinkage"]
    total = f" Together they shrink the squared gap by {span(together)}." if len(words) > 1 else ""
    return f"Cause{'s' if len(words) > 1 else ''}: {'; and '.join(words)}.{total}"


def _one(cause: dict[str, Any]) -> str:
    """One cause with its main parameters, its rivals and what it does by itself."""
    rivals = [g for g in cause["group"] if g != cause["effect"]]
    values = ", ".join(value(name, p) for name, p in list(moved(cause["parameters"]).items())[:MOST_VALUES])
    onset = f" from {cause['onset_s']:.0f} s on" if cause["onset_s"] is not None else ""
    other = f" or, indistinguishable in this log, {', '.join(rivals)}" if rivals else ""
    does = alone(cause) or f"by itself it shrinks the squared gap by {span(cause['shrinkage'])} on held-out windows{_most(cause['shrinkage'])}"
    return f"{cause['effect']}{onset} ({values}; probability {chance(cause['probability'])}){other}; {does}"


def _most(shrinkage: Mapping[str, Any]) -> str:
    """The axis that a cause closes most of, where it closes little of all."""
    axes = shrinkage.get("axes") or {}
    best = max(axes, key=lambda axis: axes[axis], default="")
    return f", that of {best} by {whole(axes[best])} %" if best and (shrinkage.get("total") or 0.0) < LITTLE <= axes[best] else ""


def beside_slop(document: Mapping[str, Any]) -> str:
    """What the causes close once healthy coefficients move, where with those as filed the gap does not surely shrink and it then does."""
    filed, eased = document.get("shrinkage") or {}, document.get("beside_slop") or {}
    within = ((document.get("detection") or {}).get("strain") or 0.0) <= STRAINED
    if not document.get("causes") or not within or (filed.get("low") or 0.0) > 0 or (eased.get("low") or 0.0) <= 0:
        return ""
    slop = 100 * document["calibration_slop"]
    return f"Beside coefficients within a calibration slop of {slop:g} %, which answer to each other here, they close {span(eased)} of what those leave."


def _harm(document: dict[str, Any]) -> str:
    if not document["causes"] or not document["harm"]:
        return ""
    return "Worse with it, in squared error: " + ", ".join(f"{h['axis']} by {whole(h['change'])} %" for h in document["harm"]) + "."


def _left(document: dict[str, Any]) -> str:
    return f"Left: {document['left']['text']}." if document["verdict"] == "partly_explained" and document["left"] else ""


def _next(document: dict[str, Any]) -> str:
    plan = document["next_experiment"]
    return f"To decide between {', '.join(plan['separates'])}: fly {plan['manoeuvre']}." if plan else ""


def _log(document: dict[str, Any]) -> str:
    """What of the log is no measurement, of several logs, of how many; and in how many windows nothing was compared."""
    found: dict[tuple[str, str], list[str]] = {}
    for row in document.get("log") or ():
        found.setdefault((row["channel"], row["finding"]), []).append(row["detail"])
    said = [f"{channel} {details[0]}" + (f" (and in {len(details) - 1} more)" if len(details) > 1 else "") for (channel, _), details in found.items()]
    if stopped := document.get("windows_stopped") or 0:
        said.append(f"{stopped} of {document['windows']} windows, in which the simulation of the vehicle as it is filed stops, were left out")
    return f"Of the log: {'; '.join(said)}." if said else ""
