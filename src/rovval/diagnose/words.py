"""The diagnosis in a few sentences, read off the document."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.units import in_degrees

MOST_VALUES = 3  # parameters of a cause that fit a sentence


OPEN = 0.5  # chosen: share of a gap that neither noise nor slop accounts for, from which "no gap" would say too much


def sentence(document: dict[str, Any]) -> str:
    """Gap, where, cause or group, shrinkage with its interval, what is left and what to fly next."""
    parts = [_gap(document), _where(document), cause(document), _harm(document), _left(document), _next(document)]
    return " ".join(p for p in parts if p)


def open_gap(document: Mapping[str, Any]) -> bool:
    """Whether nothing is named and yet most of the gap is neither noise nor slop: not explained is not the same as not there."""
    found = document.get("detection") or {}
    known = "slop" in found and "noise" in found
    return document.get("verdict") == "no_gap" and known and float(1.0 - found["slop"] - found["noise"]) > OPEN


def chance(probability: float) -> str:
    """A probability that no rounding makes certain."""
    return "> 0.99" if probability > 0.99 else f"{probability:.2f}"


def _gap(document: dict[str, Any]) -> str:
    axes = document["gap"]["axes"]
    if not axes:
        return "Nothing was measured on any axis."
    axis, row = max(axes.items(), key=lambda item: item[1]["share"])
    times = row["rms"] / row["floor_rms"] if row["floor_rms"] > 0 else float("inf")
    rms, unit = in_degrees(row["rms"], row["unit"])
    size = f"{rms:.3g} {unit} rms in {document['window_s']:g}-s windows"
    floor = f", {times:.{1 if times < 10 else 0}f} times the sensor noise" if times < 1e4 else ""
    return f"Gap: largest in {axis} ({size}{floor}; {100 * row['share']:.0f} % of the weighted gap)."


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
        return _nothing(document)
    if verdict == "unknown":
        return f"Unknown effect: {document['left']['text']}."
    words = [_one(c) for c in document["causes"]]
    together = document["shrinkage"]
    total = f" Together: {_span(together)}." if len(words) > 1 else ""
    return f"Cause{'s' if len(words) > 1 else ''}: {'; and '.join(words)}.{total}"


def _nothing(document: dict[str, Any]) -> str:
    slop = f"a calibration slop of {100 * document['calibration_slop']:g} %"
    if not open_gap(document):
        return f"No gap beyond noise and {slop}: no effect of the library explains anything that such slop does not."
    accounted = 100 * (document["detection"]["slop"] + document["detection"]["noise"])
    return (
        f"No cause is named, though noise and {slop} account for only {accounted:.0f} % of the gap: no effect of the library and no smooth force "
        "is shown to close the rest. It may be a disturbance, an effect in events, or motion that this log shows too little of."
    )


def _one(cause: dict[str, Any]) -> str:
    """One cause with its main parameters, its rivals and what it does by itself."""
    rivals = [g for g in cause["group"] if g != cause["effect"]]
    values = ", ".join(_value(name, p) for name, p in list(cause["parameters"].items())[:MOST_VALUES])
    onset = f" from {cause['onset_s']:.0f} s on" if cause["onset_s"] is not None else ""
    other = f" or, indistinguishable in this log, {', '.join(rivals)}" if rivals else ""
    alone = f"by itself it shrinks the gap by {_span(cause['shrinkage'])} on held-out windows"
    return f"{cause['effect']}{onset} ({values}; probability {chance(cause['probability'])}){other}; {alone}"


def _value(name: str, p: dict[str, Any]) -> str:
    factor, unit = in_degrees(1.0, p["unit"])
    value, low, high = (factor * p[k] for k in ("value", "low", "high"))
    return f"{name} = {value:.3g} [{low:.3g}, {high:.3g}]{'' if unit == '1' else f' {unit}'}"


def _span(s: dict[str, Any]) -> str:
    return f"{100 * s['total']:.0f} % [{100 * s['low']:.0f}, {100 * s['high']:.0f}]"


def _harm(document: dict[str, Any]) -> str:
    if not document["causes"] or not document["harm"]:
        return ""
    return "Worse with it: " + ", ".join(f"{h['axis']} by {100 * h['change']:.0f} %" for h in document["harm"]) + "."


def _left(document: dict[str, Any]) -> str:
    return f"Left: {document['left']['text']}." if document["verdict"] == "partly_explained" and document["left"] else ""


def _next(document: dict[str, Any]) -> str:
    plan = document["next_experiment"]
    return f"To decide between {', '.join(plan['separates'])}: fly {plan['manoeuvre']}." if plan else ""
