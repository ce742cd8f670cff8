"""What is said where no cause is named: what the sensors' own check shows, what came nearest to a cause, and what is left unexplained."""

from __future__ import annotations

from rovval.diagnose.criteria import LEAST_EVIDENCE
from rovval.diagnose.result.diagnosis import Diagnosis, Unexplained
from rovval.report.common.numbers import listed, number, per_cent
from rovval.report.diagnosis.words import parameter, sensor_tolerance

NOISE = "noise"


def undecided(d: Diagnosis) -> bool:
    """Whether no gap is claimed and yet something was seen: an effect that takes away more than tolerances do, a sensor beyond its tolerance."""
    return d.verdict == "no_gap" and d.indications is not None and d.indications.beyond_tolerance


def nothing(d: Diagnosis) -> str:
    """That no gap is claimed, and what was seen all the same: what the sensors' own check shows, and what came nearest to a cause."""
    known, sensors, near = _known(d), _sensors(d), _near(d)
    if near or sensors:
        first = f"No gap beyond {known} is shown in the simulated motion"
        sensors = sensors and f"{', but' if undecided(d) else ';'} {sensors}"
    else:
        first = f"No gap beyond {known}: no effect of the library explains anything that {known} {'does' if known == NOISE else 'do'} not"
    return f"{first}{sensors}.{f' {near}.' if near else ''}"


def unexplained(d: Diagnosis) -> str:
    """What is left unexplained: a force that is surely at work, or a gap that nothing accounts for; empty where nothing is left."""
    if d.left is None:
        return ""
    return d.left.text or (_force(d.left) if d.left.accounted is None else _open(d, d.left.accounted))


def _force(left: Unexplained) -> str:
    text = f"a systematic force on {', '.join(left.axes)}"
    text += f" that varies with {', '.join(left.depends_on)}" if left.depends_on else ""
    text += f" would take away {per_cent(left.share)} of it" if left.share >= 0.005 else " is at work"
    text += "; no effect of the library is shown to be it"
    if left.inconstant:
        return f"{text}; nearest is {listed(left.inconstant)}, whose value would have to change along the log"
    if left.departed:
        return f"{text}; nearest is {left.departed.coefficient}, which would have to be {abs(left.departed.departure):.0f} times its tolerance off"
    return text


def _open(d: Diagnosis, accounted: float) -> str:
    """A gap of which noise and tolerances account for so little that it stays open."""
    found, beyond = d.detection, ""
    if found and accounted < found.noise + found.tolerance_share - 1e-9:  # the tolerances were overdrawn: they were not counted
        beyond = f" (for {per_cent(found.tolerance_share)} if a coefficient were {found.largest_departure:.1f} times its tolerance off)"
    text = (
        f"{_known(d)} account for only {per_cent(accounted)} of the squared gap{beyond}: no effect of the library and no smooth force is shown to be "
        f"the rest. It may be a disturbance{_largest(d)}, an effect in events, or motion that this log shows too little of"
    )
    sensors, near = _sensors(d), _near(d)
    text += f". {sensors[0].upper()}{sensors[1:]}" if sensors else ""
    return f"{text}. {near}" if near else text


def _known(d: Diagnosis) -> str:
    """What a gap may be without any cause."""
    return f"{NOISE} and a calibration tolerance of {per_cent(d.calibration_slop)}" if d.calibration_slop else NOISE


def _largest(d: Diagnosis) -> str:
    """The largest force and the largest moment that nobody logged, as the fits allow for them; the two units do not compare."""
    rows = [(axis, p) for axis, p in d.disturbance.items() if p.rms > 0.0]
    most = [max(same, key=lambda row: row[1].rms) for unit in ("N", "N m") if (same := [row for row in rows if row[1].unit == unit])]
    said = listed(f"{axis} {number(p.rms, 2)} {p.unit}" for axis, p in most)
    return f" that nobody logged (the fit allows for some, largest: {said} rms)" if said else ""


def _near(d: Diagnosis) -> str:
    best = d.indications.nearest if d.indications else None
    if d.indications is None or best is None:
        return ""
    lacks = {
        "evidence": f"its evidence of {best.evidence:.1f} is short of the {LEAST_EVIDENCE:g} asked for",
        "reduction": f"coefficients within their tolerances take away {per_cent(d.indications.within_tolerance)}",
    }
    why = ", and ".join(lacks[lack] for lack in best.lacks) or "it does not pass all the checks that a cause must pass"
    return f"Nearest to a cause, and not shown to be one, is {best.effect}: by itself it would shrink the squared gap by {per_cent(best.gain)}, but {why}"


def _sensors(d: Diagnosis) -> str:
    fault = d.indications.fault if d.indications else None
    if d.indications is None or fault is None:
        return ""
    times, name = d.indications.fault_departure, fault.fault or fault.check
    beyond = f", {number(times, 2)} times its tolerance" if times > 1.0 else ", within its tolerance" if sensor_tolerance(name) else ""
    return f"the sensors' own check, without any dynamics, shows {parameter(name, fault)}{beyond}"
