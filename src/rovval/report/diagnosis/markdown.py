"""A diagnosis as Markdown."""

from __future__ import annotations

from collections.abc import Mapping

from rovval.core.units import integral_unit
from rovval.diagnose.result.diagnosis import AxisGap, Cause, Diagnosis, ScheduleLeg, Shrinkage
from rovval.report.common.markdown import bullets, grid, under
from rovval.report.common.numbers import (
    MISSING,
    estimate,
    interval,
    number,
    per_cent,
    per_cents,
    probability,
    quantity,
)
from rovval.report.diagnosis import tables
from rovval.report.diagnosis.sentences import recalibration, words
from rovval.report.diagnosis.sentences.first_screen import first_screen
from rovval.report.diagnosis.sentences.plain import left_of, titled
from rovval.report.diagnosis.sentences.sentence import also, answer, facts


def text(d: Diagnosis) -> str:
    """The whole report."""
    said = first_screen(d)
    parts = [f"# {d.run}: diagnosis", f"> **SYNTHETIC DATA: {d.synthetic}**" if d.synthetic else ""]
    named = {"Where": said.where, "Which": said.which, "How far": said.how_far, "Next": said.next}
    parts += [f"**{answer(d)}**", bullets(f"**{k}:** {v}" for k, v in named.items() if v), *also(d)]
    parts += [bullets(f"{k}: {v}" for k, v in facts(d).items() if v)]
    parts += under("Where the gap lies", _axes(d), bullets(words.where(d, 99)), words.changes(d), words.disturbances(d))
    for cause in d.causes:
        parts += under(f"Cause: {' or '.join(titled(e) for e in words.group(cause))}", *_cause(cause, d.gap.axes))
    models = [[kind, probability(p)] for kind, p in tables.models(d)]
    parts += under("How probable", grid(["what makes the gap", "probability"], models) if models else "")
    parts += under(recalibration.TITLE, *_calibration(d))
    for title, candidates in tables.steps(d):
        rows = [[titled(c.effect), left_of(c.gain), number(c.evidence, 2)] for c in candidates]
        parts += under(f"Effects tried by simulation: {title}", grid(["effect", "what is left of the error", "evidence"], rows))
    ranking = [[titled(r.effect), number(r.score, 2)] for r in d.ranking[: tables.MOST_RANKED]]
    parts += under("First look at the library", grid(["effect", "score"], ranking) if ranking else "")
    parts += under("Sensors, by kinematics alone", _parity(d))
    parts += under("What gets worse", bullets(tables.harm(d)))
    flight = d.manoeuvre
    parts += under("What to fly next", flight.text if flight else "", _schedule(flight.schedule) if flight else "")
    parts += under("Not testable in this log", bullets(f"`{names}`: {why}" for names, why in tables.not_testable(d)))
    return "\n\n".join(p for p in [*parts, f"*{words.SCOPE} {words.SQUARED}*"] if p) + "\n"


def _axes(d: Diagnosis) -> str:
    rows, known = [], d.gap.calibrated
    for axis, row in d.gap.axes.items():
        left = [MISSING if row.calibrated_rms is None else quantity(row.calibrated_rms, row.unit)] if known else []
        values = [quantity(row.rms, row.unit), *left, quantity(row.floor_rms, row.unit), quantity(row.iae, integral_unit(row.unit))]
        rows.append([axis, *values, per_cent(row.share)])
    return grid(["axis", "rms", *(["calibration"] if known else []), "sensor noise", "IAE", "share"], rows) if rows else ""


def _cause(cause: Cause, gap: Mapping[str, AxisGap]) -> list[str]:
    lines = [words.parameter(name, p) for name, p in words.moved(cause.parameters).items()] + words.beside(cause)
    lines += [f"begins at {number(cause.onset_s)} s"] if cause.onset_s is not None else []
    lines += [f"probability {probability(cause.probability)}", words.shrinks(cause)]
    return [bullets(lines), _gains(cause.shrinkage, gap)]


def _gains(s: Shrinkage, gap: Mapping[str, AxisGap]) -> str:
    """Axis by axis, what becomes of the squared error."""
    spans = {axis: per_cents(i.low, i.high) for axis, i in s.axes_interval.items()}
    rows = [[axis, words.rms_change(gap.get(axis), v), left_of(v), per_cent(v), spans.get(axis, MISSING)] for axis, v in s.axes.items()]
    return grid(["axis", "error, rms", "left of it", "its square less by", "interval"], rows) if rows else ""


def _calibration(d: Diagnosis) -> list[str]:
    found = d.calibration
    if found is None:
        return []
    rows = [
        [f"`{name}`", quantity(p.was, p.unit), quantity(p.value, p.unit), interval(p.low, p.high, p.unit), recalibration.off_by(p)]
        for name, p in found.parameters.items()
    ]
    table = grid(["parameter", "was", "value", "interval", "off by"], rows)
    command = f"```\n{found.command}\n```"
    return [recalibration.LEAD, recalibration.far(found), table, _gains(found.shrinkage, d.gap.axes), recalibration.WRITE, command]


def _parity(d: Diagnosis) -> str:
    rows = [[f.check, f.fault or MISSING, estimate(f.value, f.low, f.high, f.unit), "yes" if f.significant else "no", f.note] for f in d.parity]
    return grid(["check", "fault", "value", "real", "note"], rows, 2) if rows else ""


def _schedule(legs: tuple[ScheduleLeg, ...]) -> str:
    rows = [[f"{s.t_s:g}", f"{s.duration_s:g}", ", ".join(f"{k} {v:g}" for k, v in s.thrusters.items()) or "all 0"] for s in legs]
    return grid(["t, s", "for, s", "thrusters, rpm"], rows, 3) if rows else ""
