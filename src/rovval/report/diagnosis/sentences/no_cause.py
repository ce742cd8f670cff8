"""What is said where no cause is named: why not, what came nearest to one, what the sensors' own check shows, and what is left unexplained."""

from __future__ import annotations

from rovval import effects
from rovval.diagnose.criteria import NAMED_FROM
from rovval.diagnose.result.diagnosis import Diagnosis, Unexplained
from rovval.report.common.numbers import listed, number, per_cent, probability
from rovval.report.diagnosis.sentences.plain import falls, remaining, titled
from rovval.report.diagnosis.sentences.words import parameter, sensor_tolerance

NOISE = "sensor noise"
STEADY = "constant"  # of the generic forces, the one that depends on nothing
KINDS = {  # of answers
    "causes": "an effect of the library", "healthy": "a vehicle that is as its file has it, within tolerance,", "file": "a file that is off in many numbers",
    "else": "something that the library lacks, or has in another form,",
}  # fmt: skip
WORTH_A_FORMULA = 0.95  # of the rms error: a formula that leaves more of it helps nobody (chosen)


def undecided(d: Diagnosis) -> bool:
    """Whether no gap is claimed and yet something was seen: an effect that takes away more than tolerances do, a sensor beyond its tolerance."""
    return d.verdict == "no_gap" and d.indications is not None and d.indications.beyond_tolerance


def short(d: Diagnosis) -> bool:
    """Whether even the most probable kind of answer is not probable enough to be given (`NAMED_FROM`)."""
    kind, value = _likeliest(d)
    return d.verdict == "unknown" and (kind in ("causes", "healthy") or (kind != "" and value <= NAMED_FROM))


def nothing(d: Diagnosis) -> str:
    """That no gap is claimed, and how sure that is."""
    sure = f" (probability {probability(d.probabilities.healthy)})" if d.probabilities else ""
    seen = " A sensor, or an effect that came near, deserves a look." if undecided(d) else ""
    return f"No gap beyond {known(d)}{sure}: no cause is needed.{seen}" if not seen else f"No gap beyond {known(d)} is shown{sure}.{seen}"


def unknown(d: Diagnosis) -> str:
    """Why no cause is named though there is a gap: the kind of model that is the most probable, or a log that contradicts itself."""
    opposed = [row for row in d.log if row.finding == "contradicted"]
    p, (likely, value) = d.probabilities, _likeliest(d)
    if opposed and likely in ("causes", ""):
        return f"No cause is named, because the log contradicts itself: {opposed[0].channel} {opposed[0].detail}."
    if short(d):
        return f"Undecided: {KINDS[likely]} is the likeliest answer (probability {probability(value)}), less than the {NAMED_FROM:g} from which one is given."
    if likely == "file":
        return f"No single cause: many numbers of the vehicle's file seem to be off at once (probability {probability(value)})."
    sure = f" (probability {probability(p.something_else)})" if p else ""
    if d.left and d.left.accounted is not None:
        return f"There is a gap that nothing here explains{sure}: {known(d)} account for only {per_cent(d.left.accounted)} of it, and no effect for the rest."
    missed = f", or one in another form ({probability(p.not_found)})" if p and p.not_found else ""
    return f"There is a gap that no effect of the library explains: something else is at work{sure}{missed}{_acting(d)}."


def _likeliest(d: Diagnosis) -> tuple[str, float]:
    """The most probable kind of answer, and its probability; "" where none are known."""
    p = d.probabilities
    kinds = {"causes": p.causes, "healthy": p.healthy, "file": p.miscalibrated_file, "else": p.something_else + p.not_found} if p else {"": 0.0}
    return max(kinds.items(), key=lambda row: row[1])


def unexplained(d: Diagnosis) -> str:
    """What is left unexplained: a force that is surely at work, or a gap that nothing accounts for; empty where nothing is left, and where it looks like
    faults of sensors, which are no force."""
    if d.left is None or (d.left.inconstant and all(effects.load(name.partition("[")[0]).place == "sensor" for name in d.left.inconstant)):
        return ""
    return d.left.text or (_force(d, d.left) if d.left.accounted is None else _open(d, d.left.accounted))


def nearest(d: Diagnosis) -> str:
    """The effect that came nearest to a cause, and by how much it is less probable than what is believed; empty where none came near."""
    if d.left and d.left.inconstant:
        along = f"with {d.left.goes_with.covariate}" if d.left.goes_with else "along the log"
        return f"Nearest: {listed(titled(name) for name in d.left.inconstant)}, but the size would have to change {along}."
    if d.left and d.left.departed:
        off = abs(d.left.departed.departure)
        return f"Nearest: {d.left.departed.coefficient}, which would have to be {off:.0f} times its tolerance off."
    best = d.indications.nearest if d.indications else None
    if best is None:
        return ""
    less = f", but all causes together have a probability of only {probability(d.probabilities.causes)}" if d.probabilities else ""
    return f"Nearest to a cause is {titled(best.effect)}: with it the error {falls(best.gain)}{less}."


def sensors(d: Diagnosis) -> str:
    """What the sensors' own check shows, without any dynamics; empty where it shows nothing."""
    fault = d.indications.fault if d.indications else None
    if d.indications is None or fault is None:
        return ""
    times, name = d.indications.fault_departure, fault.fault or fault.check
    beyond = f", {number(times, 2)} times its tolerance" if times > 1.0 else ", within its tolerance" if sensor_tolerance(name) else ""
    return f"The sensors disagree among themselves: {parameter(name, fault)}{beyond}."


def next_step(d: Diagnosis) -> str:
    """What to do where no cause is named."""
    if any(row.finding == "contradicted" for row in d.log):
        return "Check that sensor, or give a log in which it agrees with itself."
    if undecided(d):
        return "Check the sensor, or fly longer: more data decides."
    if d.verdict == "no_gap":
        return ""
    if short(d):
        return "Give further logs of this vehicle along with this one: more data decides."
    if _likeliest(d)[0] == "file":
        return "Calibrate the vehicle's file with `rovval fit` and diagnose again."
    return "Look at the worst stretches below; log what nobody logged (tether, current), or fly the same again."


def known(d: Diagnosis) -> str:
    """What a gap may be without any cause."""
    tolerance = [f"a calibration tolerance of {per_cent(d.calibration_slop)}"] if d.calibration_slop else []
    left = ["what the calibration left of its own logs"] if d.detection and d.detection.calibration_left else []
    return listed([NOISE, *tolerance, *left])


def _acting(d: Diagnosis) -> str:
    if d.left and d.left.inconstant:
        return f", which looks like {listed(d.left.inconstant)} and is not"
    return f", most in {listed(_axes(d, d.left))}" if d.left and d.left.axes else ""


def _axes(d: Diagnosis, left: Unexplained) -> list[str]:
    """The axes of what is left; without any cause those of the gap, and then in the order in which "Where" has them."""
    share = {axis: row.share for axis, row in d.gap.axes.items()}
    return list(left.axes) if d.causes else sorted(left.axes, key=lambda axis: -share.get(axis, 0.0))


def _force(d: Diagnosis, left: Unexplained) -> str:
    text = f"a force in {listed(_axes(d, left))} that nothing in the library explains"
    varies = [name for name in left.depends_on if name != STEADY]
    text += "; part of it is steady" if STEADY in left.depends_on else ""
    text += f"; it varies with {listed(varies)}" if varies else ""
    text += _swings(left)
    if d.causes and left.goes_with:
        text += f", and the size of {titled(left.goes_with.effect)} with {left.goes_with.covariate}"
    return text + (f", and with a formula for it the error {falls(left.share)}" if remaining(left.share) <= WORTH_A_FORMULA else "")


def _open(d: Diagnosis, accounted: float) -> str:
    """A gap, or what causes leave of it, of which noise and tolerances account for so little that it stays open."""
    found, beyond, whole = d.detection, "", "what the causes leave" if d.causes else "the squared gap"
    if found and not d.causes and accounted < found.noise + found.tolerance_share - 1e-9:  # the tolerances were overdrawn: they were not counted
        beyond = f" (for {per_cent(found.tolerance_share)} if a coefficient were {found.largest_departure:.1f} times its tolerance off)"
    swings = _swings(d.left) if d.left else ""
    return (
        f"{known(d)} account for only {per_cent(accounted)} of {whole}{beyond}; no effect of the library and no smooth force is shown to be the rest{swings}. "
        f"It may be a disturbance{_largest(d)}, an effect that comes and goes, or motion that this log shows too little of"
    )


def _swings(left: Unexplained) -> str:
    """The period of what comes and goes in one narrow band."""
    band = left.oscillation
    return f"; {per_cent(band.share)} of its square comes and goes in a narrow band about {number(band.period_s, 2)} s, as in a seaway" if band else ""


def _largest(d: Diagnosis) -> str:
    """The largest force and the largest moment that nobody logged, as the fits allow for them; the two units do not compare."""
    rows = [(axis, p) for axis, p in d.disturbance.items() if p.rms > 0.0]
    most = [max(same, key=lambda row: row[1].rms) for unit in ("N", "N m") if (same := [row for row in rows if row[1].unit == unit])]
    said = listed(f"{axis} {number(p.rms, 2)} {p.unit}" for axis, p in most)
    return f" that nobody logged (the fit allows for some, largest: {said} rms)" if said else ""
