"""What is said where no cause is named: what the sensors' own check shows, what came nearest to a cause, and what is left unexplained."""

from __future__ import annotations

from rovval.diagnose.criteria import LEAST_EVIDENCE
from rovval.diagnose.decision.unexplained import Accounted
from rovval.diagnose.result.diagnosis import Candidate, Diagnosis, SensorFault, Unexplained
from rovval.report.common.numbers import listed, number, per_cent
from rovval.report.diagnosis.words import parameter, sensor_tolerance

NOISE = "noise"
NEAR_GAIN, NEAR_EVIDENCE = 0.3, 2.0  # chosen: an effect with as much gain, and evidence at all, is mentioned though it is not named,
LESS_GAIN, MORE_EVIDENCE = 0.15, 20.0  # and one with less gain and more evidence


def undecided(d: Diagnosis) -> bool:
    """Whether no gap is claimed and yet something was seen: an effect that takes away more than tolerances do, a sensor beyond its tolerance."""
    near, fault = _nearest(d), _fault(d)
    return d.verdict == "no_gap" and ((near is not None and near.gain > _within_tolerance(d)) or (fault is not None and _times(fault) > 1.0))


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


def _within_tolerance(d: Diagnosis) -> float:
    """The share of the gap that coefficients within their tolerances take away; none, where the fit goes far beyond them."""
    found = d.detection
    return Accounted(found.noise, found.tolerance_share, found.largest_departure).share - found.noise if found else 0.0


def _largest(d: Diagnosis) -> str:
    """The largest force and the largest moment that nobody logged, as the fits allow for them; the two units do not compare."""
    rows = [(axis, p) for axis, p in d.disturbance.items() if p.rms > 0.0]
    most = [max(same, key=lambda row: row[1].rms) for unit in ("N", "N m") if (same := [row for row in rows if row[1].unit == unit])]
    said = listed(f"{axis} {number(p.rms, 2)} {p.unit}" for axis, p in most)
    return f" that nobody logged (the fit allows for some, largest: {said} rms)" if said else ""


def _nearest(d: Diagnosis) -> Candidate | None:
    """Of the first step's candidates, the best that takes much of the gap away and was not named."""
    if d.causes or not d.finalists:
        return None
    near = [c for c in d.finalists[0] if (c.gain >= NEAR_GAIN and c.evidence > NEAR_EVIDENCE) or (c.gain >= LESS_GAIN and c.evidence > MORE_EVIDENCE)]
    return max(near, key=lambda c: c.evidence, default=None)


def _near(d: Diagnosis) -> str:
    best, within = _nearest(d), _within_tolerance(d)
    if best is None:
        return ""
    short = [f"its evidence of {best.evidence:.1f} is short of the {LEAST_EVIDENCE:g} asked for"] if best.evidence < LEAST_EVIDENCE else []
    short += [f"coefficients within their tolerances take away {per_cent(within)}"] if within >= best.gain else []
    why = ", and ".join(short) or "it does not pass all the checks that a cause must pass"
    return f"Nearest to a cause, and not shown to be one, is {best.effect}: by itself it would shrink the squared gap by {per_cent(best.gain)}, but {why}"


def _fault(d: Diagnosis) -> SensorFault | None:
    """The significant fault of the sensors' own check that accounts for most of it; of several, the one furthest beyond its tolerance."""
    return max((row for row in d.parity if row.significant), key=lambda row: (round(row.share, 2), _times(row)), default=None)


def _sensors(d: Diagnosis) -> str:
    fault = _fault(d)
    if fault is None:
        return ""
    times, name = _times(fault), fault.fault or fault.check
    beyond = f", {number(times, 2)} times its tolerance" if times > 1.0 else ", within its tolerance" if sensor_tolerance(name) else ""
    return f"the sensors' own check, without any dynamics, shows {parameter(name, fault)}{beyond}"


def _times(fault: SensorFault) -> float:
    """How many tolerances of a healthy sensor a fault is off what the vehicle's file says; 0 where none is stated."""
    tolerance = sensor_tolerance(fault.fault)
    return abs(fault.value - fault.was) / tolerance if tolerance else 0.0
