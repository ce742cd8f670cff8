"""What is said where no cause is named: an open gap, what the sensors' own check shows, and what came nearest to a cause."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.diagnose.decision.unexplained import OPEN
from rovval.diagnose.inference.prior import SENSORS, STRAINED
from rovval.diagnose.search.joint import LEAST_EVIDENCE
from rovval.report.diagnosis.phrases import family, size, value, whole

NOISE = "noise"
NEAR_GAIN, NEAR_EVIDENCE = 0.3, 2.0  # chosen: what closes as much of the gap, with evidence at all, is told though it is not named,
LESS_GAIN, MORE_EVIDENCE = 0.15, 20.0  # and what closes less with more evidence


def open_gap(document: Mapping[str, Any]) -> bool:
    """Whether nothing is named and yet most of the gap is neither noise nor slop: not explained is not the same as not there."""
    known = {"slop", "noise"} <= (document.get("detection") or {}).keys()
    return document.get("verdict") == "no_gap" and known and 1.0 - _accounted(document) > OPEN


def undecided(document: Mapping[str, Any]) -> bool:
    """Whether nothing is named and yet something was seen: an open gap, an effect that closes more than slop does, a sensor beyond its tolerance."""
    near, row = _nearest(document), _sensor(document)
    seen = (near is not None and near["gain"] > _slop(document)) or (row is not None and _tolerances(row) > 1.0)
    return open_gap(document) or (document.get("verdict") == "no_gap" and seen)


def nothing(document: Mapping[str, Any]) -> str:
    """That no cause is named, and what was seen all the same: what the sensors' own check shows, and what came nearest."""
    known, sensors, near = _known(document), _sensors(document), _near(document)
    if open_gap(document):
        first = f"No cause is named, though {_unaccounted(document, known)}"
        sensors = sensors and f". {sensors[0].upper()}{sensors[1:]}"
    elif near or sensors:
        first = f"No gap beyond {known} is shown in the simulated motion"
        sensors = sensors and f"{', but' if undecided(document) else ';'} {sensors}"
    else:
        first = f"No gap beyond {known}: no effect of the library explains anything that {'such slop' if known != NOISE else NOISE} does not"
    return f"{first}{sensors}.{f' {near}.' if near else ''}"


def unexplained(document: Mapping[str, Any]) -> str:
    """What is left unexplained: a systematic force, or an open gap, which is neither smooth nor in the library."""
    left = document["left"]
    if left["accounted"] is not None:
        return _opened(dict(document) | {"verdict": "no_gap"})
    text = f"a systematic force on {', '.join(left['axes'])}"
    text += f" that varies with {', '.join(left['depends_on'])}" if left["depends_on"] else ""
    text += f" would close {100 * left['share']:.0f} % of it" if left["share"] >= 0.005 else " is at work"
    text += "; no effect of the library is shown to be it"
    if left["inconstant"]:
        text += f"; nearest is {' and '.join(left['inconstant'])}, whose value would have to change along the log"
    elif left["departed"]:
        name, departure = left["departed"]["coefficient"], left["departed"]["departure"]
        text += f"; nearest is {name}, which would have to be {abs(departure):.0f} times its tolerance off"
    return text


def _opened(document: Mapping[str, Any]) -> str:
    """An open gap as what is left of it."""
    sensors, near = _sensors(document), _near(document)
    text = _unaccounted(document, _known(document))
    text += f". {sensors[0].upper()}{sensors[1:]}" if sensors else ""
    return f"{text}. {near}" if near else text


def _known(document: Mapping[str, Any]) -> str:
    """What a gap may be without any cause."""
    slop = document.get("calibration_slop")
    return f"{NOISE} and a calibration slop of {100 * slop:g} %" if slop else NOISE


def _slop(document: Mapping[str, Any]) -> float:
    """The share of the gap that slop of the stated size closes: nothing, where a coefficient goes far beyond it."""
    found = document.get("detection") or {}
    return 0.0 if (found.get("strain") or 0.0) > STRAINED else float(found.get("slop") or 0.0)


def _accounted(document: Mapping[str, Any]) -> float:
    return float(document["detection"]["noise"]) + _slop(document)


def _unaccounted(document: Mapping[str, Any], known: str) -> str:
    found = document["detection"]
    beyond = f" (for {whole(found['slop'])} % if a coefficient were {found['strain']:.1f} times its tolerance off)" if _slop(document) < found["slop"] else ""
    return (
        f"{known} account for only {whole(_accounted(document))} % of the squared gap{beyond}: no effect of the library and no smooth force is "
        f"shown to close the rest. It may be a disturbance{_largest(document)}, an effect in events, or motion that this log shows too little of"
    )


def _largest(document: Mapping[str, Any]) -> str:
    """The largest force and the largest moment that nobody logged, as the fits allow for them; the two units do not compare."""
    rows = [(axis, p) for axis, p in (document.get("disturbance") or {}).items() if (p.get("rms") or 0.0) > 0.0]
    most = [max(same, key=lambda row: float(row[1]["rms"])) for unit in ("N", "N m") if (same := [row for row in rows if row[1]["unit"] == unit])]
    said = " and ".join(f"{axis} {size(p['rms'])} {p['unit']}" for axis, p in most)
    return f" that nobody logged (the fit allows for some, largest: {said} rms)" if said else ""


def _nearest(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Of what was weighed first, the best that closes much of the gap and was not named."""
    rounds = document.get("finalists") or ()
    if document.get("verdict") != "no_gap" or not rounds:
        return None
    weighed = [(r, r.get("gain") or 0.0, r.get("evidence") or 0.0) for r in rounds[0]]
    near = [r for r, gain, worth in weighed if (gain >= NEAR_GAIN and worth > NEAR_EVIDENCE) or (gain >= LESS_GAIN and worth > MORE_EVIDENCE)]
    return max(near, key=lambda r: float(r["evidence"]), default=None)


def _near(document: Mapping[str, Any]) -> str:
    best, slop = _nearest(document), _slop(document)
    if best is None:
        return ""
    gain, evidence = best["gain"], best["evidence"]
    short = [f"its evidence of {evidence:.1f} is short of the {LEAST_EVIDENCE:g} asked for"] if evidence < LEAST_EVIDENCE else []
    short += [f"calibration slop of the stated size explains {whole(slop)} %"] if slop >= gain else []
    why = ", and ".join(short) or "it does not pass all the checks that a cause must pass"
    return f"Nearest to a cause, and not shown to be one, is {best['effect']}: by itself it would close {whole(gain)} % of the squared gap, but {why}"


def _sensor(document: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """The significant row of the sensors' own check that accounts for most of it; of several, the one furthest beyond its tolerance."""
    rows = [r for r in document.get("parity") or () if r.get("significant") and r.get("value") is not None]
    return max(rows, key=lambda r: (round(r.get("share") or 0.0, 2), _tolerances(r)), default=None)


def _sensors(document: Mapping[str, Any]) -> str:
    row = _sensor(document)
    if row is None:
        return ""
    times, name = _tolerances(row), str(row.get("fault") or row.get("check"))
    beyond = f", {times:.2g} times its tolerance" if times > 1.0 else ", within its tolerance" if family(name) in SENSORS else ""
    return f"the sensors' own check, without any dynamics, shows {value(name, row)}{beyond}"


def _tolerances(row: Mapping[str, Any]) -> float:
    """How many tolerances of a healthy sensor a row of the check is off what the vehicle's file says; 0 where none is stated."""
    tolerance = SENSORS.get(family(str(row.get("fault") or "")))
    return abs(row["value"] - (row.get("was") or 0.0)) / tolerance if tolerance else 0.0
