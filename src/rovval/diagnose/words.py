"""The diagnosis in a few sentences, read off the document."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.diagnose.select import LEAST_EVIDENCE
from rovval.diagnose.tolerance import SENSORS
from rovval.units import in_degrees

MOST_VALUES = 3  # parameters of a cause that fit a sentence
OPEN = 0.5  # chosen: share of a gap that neither noise nor slop accounts for, from which "no gap" would say too much
NEAR_GAIN, NEAR_EVIDENCE = 0.3, 2.0  # chosen: what closes as much of the gap, with evidence at all, is told though it is not named
UNMOVED = 0.005  # of the gap: less rounds to nothing


def sentence(document: dict[str, Any]) -> str:
    """Gap, where, cause or group, shrinkage with its interval, what is left and what to fly next."""
    parts = [_gap(document), _where(document), cause(document), _harm(document), _left(document), _next(document)]
    return " ".join(p for p in parts if p)


def open_gap(document: Mapping[str, Any]) -> bool:
    """Whether nothing is named and yet most of the gap is neither noise nor slop: not explained is not the same as not there."""
    found = document.get("detection") or {}
    known = "slop" in found and "noise" in found
    return document.get("verdict") == "no_gap" and known and float(1.0 - found["slop"] - found["noise"]) > OPEN


def undecided(document: Mapping[str, Any]) -> bool:
    """Whether nothing is named and yet something was seen: an open gap, an effect that closes more than slop does, a sensor beyond its tolerance."""
    near, row, slop = _nearest(document), _sensor(document), (document.get("detection") or {}).get("slop") or 0.0
    seen = (near is not None and near["gain"] > slop) or (row is not None and _tolerances(row) > 1.0)
    return open_gap(document) or (document.get("verdict") == "no_gap" and seen)


def moved(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters that the fit moved. One that rests where nothing is at work says nothing: a log without the tether's length cannot move
    the drag per length."""
    away = {name: p for name, p in parameters.items() if p.get("null") is None or p.get("value") != p["null"]}
    return away or dict(parameters)


def alone(cause: Mapping[str, Any]) -> str:
    """What a cause does by itself to a gap that it hardly changes; empty where it changes it."""
    if not unmoved(cause.get("shrinkage") or {}):
        return ""
    sensor = _family(cause["effect"]) in SENSORS
    return "seen by the kinematic checks alone; it does not change the simulated motion" if sensor else "by itself it leaves the squared gap as it is"


def unmoved(shrinkage: Mapping[str, Any]) -> bool:
    """Whether the gap stays as it is."""
    total = shrinkage.get("total")
    return total is not None and abs(total) < UNMOVED


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
    total = f" Together they shrink the squared gap by {_span(together)}." if len(words) > 1 else ""
    return f"Cause{'s' if len(words) > 1 else ''}: {'; and '.join(words)}.{total}"


def nothing(document: Mapping[str, Any]) -> str:
    """That no cause is named, and what was seen all the same: what the sensors' own check shows, and what came nearest."""
    slop = document.get("calibration_slop")
    known = f"noise and a calibration slop of {100 * slop:g} %" if slop else "noise"
    sensors, near = _sensors(document), _near(document)
    if open_gap(document):
        accounted = _whole(document["detection"]["slop"] + document["detection"]["noise"])
        first = (
            f"No cause is named, though {known} account for only {accounted} % of the squared gap: no effect of the library and no smooth force "
            "is shown to close the rest. It may be a disturbance, an effect in events, or motion that this log shows too little of"
        )
        sensors = sensors and f". {sensors[0].upper()}{sensors[1:]}"
    elif near or sensors:
        first = f"No gap beyond {known} is shown in the simulated motion"
        sensors = sensors and f"{', but' if undecided(document) else ';'} {sensors}"
    else:
        first = f"No gap beyond {known}: no effect of the library explains anything that {'such slop' if slop else 'noise'} does not"
    return f"{first}{sensors}.{f' {near}.' if near else ''}"


def _nearest(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Of what was weighed first, the best that closes much of the gap and was not named."""
    rounds = document.get("finalists") or ()
    if document.get("verdict") != "no_gap" or not rounds:
        return None
    near = [r for r in rounds[0] if (r.get("gain") or 0.0) >= NEAR_GAIN and (r.get("evidence") or 0.0) > NEAR_EVIDENCE]
    return max(near, key=lambda r: float(r["evidence"]), default=None)


def _near(document: Mapping[str, Any]) -> str:
    best, found = _nearest(document), document.get("detection") or {}
    if best is None:
        return ""
    gain, evidence, slop = best["gain"], best["evidence"], found.get("slop") or 0.0
    short = [f"its evidence of {evidence:.1f} is short of the {LEAST_EVIDENCE:g} asked for"] if evidence < LEAST_EVIDENCE else []
    short += [f"calibration slop of the stated size explains {_whole(slop)} %"] if slop >= gain else []
    why = ", and ".join(short) or "it does not pass all the checks that a cause must pass"
    return f"Nearest to a cause, and not shown to be one, is {best['effect']}: by itself it would close {_whole(gain)} % of the squared gap, but {why}"


def _sensor(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The significant row of the sensors' own check that accounts for most of it; of several, the one furthest beyond its tolerance."""
    rows = [r for r in document.get("parity") or () if r.get("significant") and r.get("value") is not None]
    return max(rows, key=lambda r: (round(r.get("share") or 0.0, 2), _tolerances(r)), default=None)


def _sensors(document: Mapping[str, Any]) -> str:
    row = _sensor(document)
    if row is None:
        return ""
    times, name = _tolerances(row), str(row.get("fault") or row.get("check"))
    beyond = f", {times:.2g} times its tolerance" if times > 1.0 else ", within its tolerance" if _family(name) in SENSORS else ""
    return f"the sensors' own check, without any dynamics, shows {_value(name, row)}{beyond}"


def _tolerances(row: Mapping[str, Any]) -> float:
    """How many tolerances of a healthy sensor a row of the check is off; 0 where none is stated."""
    tolerance = SENSORS.get(_family(str(row.get("fault") or "")))
    return abs(row["value"]) / tolerance if tolerance else 0.0


def _family(name: str) -> str:
    return name.partition(".")[0].partition("[")[0]


def _one(cause: dict[str, Any]) -> str:
    """One cause with its main parameters, its rivals and what it does by itself."""
    rivals = [g for g in cause["group"] if g != cause["effect"]]
    values = ", ".join(_value(name, p) for name, p in list(moved(cause["parameters"]).items())[:MOST_VALUES])
    onset = f" from {cause['onset_s']:.0f} s on" if cause["onset_s"] is not None else ""
    other = f" or, indistinguishable in this log, {', '.join(rivals)}" if rivals else ""
    does = alone(cause) or f"by itself it shrinks the squared gap by {_span(cause['shrinkage'])} on held-out windows"
    return f"{cause['effect']}{onset} ({values}; probability {chance(cause['probability'])}){other}; {does}"


def _value(name: str, p: Mapping[str, Any]) -> str:
    factor, unit = in_degrees(1.0, p["unit"])
    value, low, high = (factor * p[k] + 0.0 for k in ("value", "low", "high"))  # + 0.0: no -0
    return f"{name} = {value:.3g} [{low:.3g}, {high:.3g}]{'' if unit == '1' else f' {unit}'}"


def _span(s: Mapping[str, Any]) -> str:
    return f"{_whole(s['total'])} % [{_whole(s['low'])}, {_whole(s['high'])}]"


def _whole(share: float) -> str:
    """Whole per cents, never -0."""
    return str(round(100 * share))


def _harm(document: dict[str, Any]) -> str:
    if not document["causes"] or not document["harm"]:
        return ""
    return "Worse with it, in squared error: " + ", ".join(f"{h['axis']} by {_whole(h['change'])} %" for h in document["harm"]) + "."


def _left(document: dict[str, Any]) -> str:
    return f"Left: {document['left']['text']}." if document["verdict"] == "partly_explained" and document["left"] else ""


def _next(document: dict[str, Any]) -> str:
    plan = document["next_experiment"]
    return f"To decide between {', '.join(plan['separates'])}: fly {plan['manoeuvre']}." if plan else ""
