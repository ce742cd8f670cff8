"""A diagnosis as text for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from rovval.core.units import in_degrees
from rovval.report.common.numbers import number, per_cent
from rovval.report.diagnosis import calibration
from rovval.report.diagnosis import words as dw
from rovval.report.diagnosis.sentence import chance, moved
from rovval.report.diagnosis.tried import rounds
from rovval.report.diagnosis.unlogged import disturbances
from rovval.report.diagnosis.untestable import not_testable


def text(document: dw.Document) -> str:
    """The sentence first, then where, which, how far, and what this log cannot answer."""
    d = document
    parts = [f"SYNTHETIC DATA: {d['synthetic']}"] if d.get("synthetic") else []
    parts += [f"{dw.run(d)}: {dw.facts(d)['verdict']}"]
    for sentence in dw.sentences(d):
        parts += wrap(sentence, 100)
    parts += _block("gap by axis", _axes(d)) + _block("where", dw.where(d))
    parts += ["", *wrap(pushed, 100)] if (pushed := disturbances(d)) else []
    for cause in d.get("causes") or ():
        parts += _block("cause: " + " | ".join(dw.group(cause)), _cause(cause))
    parts += _block(calibration.TITLE.lower(), calibration.lines(d))
    checks = [c for c in d.get("parity") or () if c.get("significant")]
    parts += _block("sensors", [f"{c.get('fault') or c.get('check')}: {dw.parameter('value', c)[8:]}" for c in checks])
    parts += _block("harm", [f"{h.get('axis')}: {per_cent(h.get('change'))}" for h in d.get("harm") or ()])
    weighed = rounds(d)
    for title, rows in weighed:
        parts += _block(f"weighed by re-simulation: {title[0].lower()}{title[1:]}", _weighed(rows))
    ranking = () if weighed else d.get("ranking") or ()
    parts += _block("screen of the library", [f"{number(r.get('score')):>7}  {r['effect']}" for r in ranking[:8]])
    parts += _block("not testable in this log", [f"{names}: {why}" for names, why in not_testable(d)])
    return "\n".join([*parts, "", dw.SCOPE, dw.SQUARED]) + "\n"


def _block(title: str, lines: list[str]) -> list[str]:
    return ["", title, *(f"  {line}" for line in lines)] if lines else []


def _axes(d: dw.Document) -> list[str]:
    rows = [("axis", "rms", "floor", "share")]
    for axis, row in ((d.get("gap") or {}).get("axes") or {}).items():
        factor, unit = in_degrees(1.0, row.get("unit", "1"))
        floor = row.get("floor_rms")
        cells = [f"{number(row['rms'] * factor)} {unit}", "-" if floor is None else f"{number(floor * factor)} {unit}"]
        rows.append((axis, *cells, per_cent(row.get("share"))))
    return ["  ".join((r[0].ljust(6), *(c.rjust(13) for c in r[1:]))) for r in rows] if len(rows) > 1 else []


def _cause(cause: dw.Document) -> list[str]:
    lines = [dw.parameter(name, entry) for name, entry in moved(cause.get("parameters") or {}).items()]
    s = cause.get("shrinkage") or {}
    lines += [said] if (said := dw.shrinks(cause)) else []
    axes = {a: v for a, v in (s.get("axes") or {}).items() if v is not None}
    lines += ["by axis, squared, held out: " + ", ".join(f"{a} {per_cent(v)}" for a, v in axes.items())] if axes else []
    lines += [f"probability {chance(cause['probability'])}"] if cause.get("probability") is not None else []
    lines += [f"begins at {number(cause['onset_s'])} s"] if cause.get("onset_s") is not None else []
    return lines


def _weighed(rows: Sequence[dw.Document]) -> list[str]:
    lines = [f"{per_cent(r.get('gain')):>7}  {number(r.get('evidence'), 2):>8}  {r['effect']}" for r in rows]
    return [f"{'closes':>7}  {'evidence':>8}", *lines]
