"""A diagnosis as Markdown."""

from __future__ import annotations

from typing import Any

from rovval.core.units import in_degrees
from rovval.report.common.markdown import bullets, grid
from rovval.report.common.numbers import number, per_cent
from rovval.report.diagnosis import calibration
from rovval.report.diagnosis import words as dw
from rovval.report.diagnosis.sentence import chance, moved
from rovval.report.diagnosis.tried import rounds
from rovval.report.diagnosis.unlogged import disturbances
from rovval.report.diagnosis.untestable import not_testable

MOST_RANKED = 16  # of the screen


def text(document: dw.Document) -> str:
    """The whole report."""
    d = document
    parts = [f"# {dw.run(d)}: diagnosis", f"> **SYNTHETIC DATA: {d['synthetic']}**" if d.get("synthetic") else ""]
    said = dw.headline(d)
    parts += [f"**{said[0]}**", *said[1:], bullets(f"{k}: {v}" for k, v in dw.facts(d).items() if v)]
    parts += _under("## Where the gap lies", _axes(d), bullets(dw.where(d, 99)), _changes(d), disturbances(d))
    for cause in d.get("causes") or ():
        parts += _under(f"## Cause: {' or '.join(f'`{e}`' for e in dw.group(cause))}", *_cause(cause, (d.get("gap") or {}).get("axes") or {}))
    parts += _under(f"## {calibration.TITLE}", *calibration.markdown(d))
    for title, rows in rounds(d):
        weighed = [[f"`{r['effect']}`", per_cent(r.get("gain")), number(r.get("evidence"), 2)] for r in rows]
        parts += _under(f"## Weighed by re-simulation: {title[0].lower()}{title[1:]}", grid(["effect", "closes of the squared gap", "evidence"], weighed))
    ranking = [[f"`{r['effect']}`", number(r.get("score"))] for r in (d.get("ranking") or ())[:MOST_RANKED]]
    parts += _under("## Screen of the library", grid(["effect", "score"], ranking) if ranking else "")
    parts += _under("## Sensors, by kinematics alone", _parity(d))
    harm = [f"{h.get('axis')}: squared error changes by {per_cent(h.get('change'))}" for h in d.get("harm") or ()]
    parts += _under("## What gets worse", bullets(harm))
    flight = d.get("manoeuvre") or {}
    parts += _under("## What to fly next", dw.next_flight(d), flight.get("text", ""), _schedule(flight))
    why = [f"`{names}`: {why}" for names, why in not_testable(d)]
    parts += _under("## Not testable in this log", bullets(why))
    return "\n\n".join(p for p in [*parts, f"*{dw.SCOPE} {dw.SQUARED}*"] if p) + "\n"


def _under(title: str, *parts: str) -> list[str]:
    return [title, *parts] if any(parts) else []


def _axes(d: dw.Document) -> str:
    rows = []
    for axis, row in ((d.get("gap") or {}).get("axes") or {}).items():
        factor, unit = in_degrees(1.0, row.get("unit", "1"))
        values = [f"{number(row[k] * factor)} {unit}" if row.get(k) is not None else "-" for k in ("rms", "floor_rms")]
        iae = f"{number(row['iae'] * factor)} {unit.removesuffix('/s')}" if row.get("iae") is not None else "-"
        rows.append([axis, *values, iae, per_cent(row.get("share"))])
    return grid(["axis", "rms", "floor", "IAE", "share"], rows) if rows else ""


def _changes(d: dw.Document) -> str:
    points = (d.get("gap") or {}).get("change_points_s") or ()
    return f"The gap changes at {', '.join(f'{number(t, 4)} s' for t in points)}." if points else ""


def _cause(cause: dw.Document, gap: dw.Document) -> list[str]:
    s = cause.get("shrinkage") or {}
    lines = [dw.parameter(name, entry) for name, entry in moved(cause.get("parameters") or {}).items()]
    lines += [f"begins at {number(cause['onset_s'])} s"] if cause.get("onset_s") is not None else []
    lines += [f"probability {chance(cause['probability'])}"] if cause.get("probability") is not None else []
    lines += [said] if (said := dw.shrinks(cause)) else []
    spans = s.get("axes_interval") or {}
    axes = [[a, per_cent(v), dw.span(spans.get(a)), dw.rms_change(gap.get(a), v)] for a, v in (s.get("axes") or {}).items() if v is not None]
    return [bullets(lines), grid(["axis", "squared gap less by", "interval", "rms"], axes) if axes else ""]


def _parity(d: dw.Document) -> str:
    rows = []
    for c in d.get("parity") or ():
        value = dw.parameter("v", c)[4:] if c.get("value") is not None else "-"
        real = "yes" if c.get("significant") else "no"
        rows.append([str(c.get("check", "")), str(c.get("fault") or "-"), value, real, str(c.get("note") or "")])
    return grid(["check", "fault", "value", "real", "note"], rows, 2) if rows else ""


def _schedule(flight: Any) -> str:
    steps = flight.get("schedule") or ()
    rows = [
        [f"{s['t_s']:g}", f"{s['duration_s']:g}", ", ".join(f"{k} {v:g}" for k, v in (s.get("thrusters") or {}).items()) or "all 0"]
        for s in steps
    ]
    return grid(["t, s", "for, s", "thrusters, rpm"], rows, 3) if rows else ""
