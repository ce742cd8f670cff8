"""A diagnosis as one HTML file: the sentence, then where, before and after, which, how far, and what to fly next."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from rovval.core.units import in_degrees
from rovval.report.common import curves as plots
from rovval.report.common.numbers import number, per_cent, quantity
from rovval.report.common.versions import versions
from rovval.report.diagnosis import calibration, parts, tried
from rovval.report.diagnosis import glue as page
from rovval.report.diagnosis import words as dw
from rovval.report.diagnosis.sentence import chance, moved, open_gap, undecided, unmoved
from rovval.report.diagnosis.unlogged import disturbances
from rovval.report.diagnosis.untestable import not_testable


def text(document: dw.Document, recording: bool = False) -> str:
    """The page; ``recording`` says that run.rrd lies beside it."""
    d = document
    banner = f"SYNTHETIC DATA: {d['synthetic']}" if d.get("synthetic") else ""
    axes, pictures, places = _traces(d)
    keys = {"measured": "measured", "nominal": "nominal simulator"} | ({"corrected": "with the effects found"} if d.get("causes") else {})
    worst = "Before and after, on the worst stretches" if d.get("causes") else "The worst stretches"
    body = "".join(
        [
            page.head("Diagnosis", dw.run(d), banner, dw.headline(d), dw.facts(d)),
            parts.tiles(_answers(d)),
            _where(d),
            page.section(worst, page.switches(keys) if places else "", places),
            page.section("Which effect", *(_cause(c, (d.get("gap") or {}).get("axes") or {}) for c in d.get("causes") or ()), _paragraph(_which(d))),
            calibration.section(d),
            tried.section(d),
            page.section("What this log cannot tell apart", parts.matrix(d.get("coherence") or {}), lead=_COHERENCE),
            page.section("Sensors first, by kinematics alone", _parity(d), lead=_PARITY),
            page.section("What gets worse", page.listing(_harm(d))),
            page.section("What is left", _paragraph(dw.left(d))),
            page.section("What to fly next", *_flight(d)),
            page.section("Not testable in this log", _not_testable(d), lead="Neither blamed nor cleared."),
            page.section("Recording", _RECORDING if recording else ""),
            page.footer(" · ".join([dw.SCOPE, dw.SQUARED, *(f"{k} {v}" for k, v in versions().items())])),
        ]
    )
    return page.page(f"{dw.run(d)} · rovval diagnosis", body, {"x": axes, "plots": pictures})


_COHERENCE = "Likeness of the effects' signatures once the windows' initial states are taken out; at 1 two effects are one to this log."
_PARITY = "Identities between the channels themselves. A fault found here competes with the physical effects; it is not corrected in silence."
_RECORDING = "<p>Measured, nominal and corrected side by side, in time and in 3-D:</p><pre>rerun run.rrd</pre>"
_WHERE = {"no_gap": "What remains, axis by axis"}
_WHICH = {
    "unknown": "No effect of the library removes enough of the gap on held-out data to be named. The least bad one is not a cause.",
    "no_gap": "Nothing to blame: what is left is within noise and calibration slop.",
}
_OPEN = "None is named. Most of the gap is neither noise nor slop; what it is, this log does not show."
_SEEN = "None is named; the answer at the top says what was seen all the same."


def _which(d: dw.Document) -> str:
    return _OPEN if open_gap(d) else _SEEN if undecided(d) else _WHICH.get(d.get("verdict", ""), "")


def _answers(d: dw.Document) -> dict[str, tuple[str, str]]:
    """Where, which, how far, what next; the sentence alone says it when there is no gap."""
    if d.get("verdict") == "no_gap":
        return {}
    axes, causes, s = (d.get("gap") or {}).get("axes") or {}, d.get("causes") or (), d.get("shrinkage") or {}
    worst = max(axes, key=lambda a: axes[a].get("share") or 0.0) if axes else ""
    row = axes.get(worst, {})
    spot = (d.get("gap") or {}).get("where") or ()
    at = f", most at {spot[0].get('regime')}" if spot else ""
    where = (worst, f"{per_cent(row.get('share'))} of the gap{at}")
    off = f"; {len(tuned['beyond'])} coefficients of the file are off together" if (tuned := d.get("calibration")) else ""
    which = {"unknown": ("unknown", f"no library effect explains it{off}")}
    first = dw.group(causes[0]) if causes else []
    more = [f"or {dw.names(first[1:])}"] if first[1:] else []
    more += [f"and {', '.join(str(c['effect']) for c in causes[1:])}"] if causes[1:] else []
    more += [f"beside {len(tuned['beyond'])} coefficients of the file"] if tuned else []
    named = (first[0], "; ".join(more)) if first else which.get(d.get("verdict", ""), ("", ""))
    span = f"squared gap, {per_cent(s.get('low'))} to {per_cent(s.get('high'))}{', held out' if s.get('held_out') else ''}"
    span += f"; {per_cent(tuned['shrinkage']['total'])} smaller with the coefficients tuned" if tuned else ""
    far = ("unchanged" if unmoved(s) else f"{per_cent(s['total'])} smaller", span) if s.get("total") is not None and causes else ("", "")
    flight = d.get("manoeuvre") or {}
    fly = (str(flight.get("name") or (d.get("next_experiment") or {}).get("manoeuvre") or ""), "")
    return {"Where": where, "Which": named, "How far": far, "Next": fly}


def _where(d: dw.Document) -> str:
    """Axis by axis, axis by regime, the slices in words, the times at which the gap changes, and what pushed unlogged."""
    points = ", ".join(f"{number(t, 4)} s" for t in (d.get("gap") or {}).get("change_points_s") or ())
    changes = _paragraph(f"The gap changes at {points}." if points else "")
    title = _WHERE.get(d.get("verdict", ""), "Where the gap lies")
    return page.section(title, _axes(d), parts.heat_maps(d), page.listing(dw.where(d)), changes, _paragraph(disturbances(d)))


def _axes(d: dw.Document) -> str:
    rows = []
    for axis, row in ((d.get("gap") or {}).get("axes") or {}).items():
        unit = row.get("unit", "1")
        floor = row.get("floor_rms")
        floors = "–" if floor is None else quantity(floor, unit)
        iae = "–" if row.get("iae") is None else quantity(row["iae"], unit.removesuffix("/s"))
        rows.append([escape(axis), quantity(row["rms"], unit), floors, iae, parts.axis_bar(row.get("share"))])
    return page.table(["axis", "gap, rms", "sensor noise", "IAE", "share of the gap"], rows, left=(0, 4)) if rows else ""


def _cause(cause: dw.Document, gap: dw.Document) -> str:
    members, s = dw.group(cause), cause.get("shrinkage") or {}
    alike = " or ".join(f"<code>{escape(m)}</code>" for m in members[1:])
    others = f' <span class="lead">or {alike}</span>' if alike else ""
    said = [f"probability {chance(cause['probability'])}"] if cause.get("probability") is not None else []
    said += [f"begins at {number(cause['onset_s'])} s"] if cause.get("onset_s") is not None else []
    said += [dw.shrinks(cause)]
    rows = []
    for name, entry in moved(cause.get("parameters") or {}).items():
        factor, unit = in_degrees(1.0, entry.get("unit", "1"))
        value, low, high = (None if entry.get(k) is None else entry[k] * factor for k in ("value", "low", "high"))
        drawn = parts.whisker(value, low, high, (entry.get("null") or 0.0) * factor)
        span = f"{number(low)} to {number(high)}" if low is not None and high is not None else "–"
        rows.append([f"<code>{escape(name)}</code>", number(value), span, "" if unit == "1" else unit, drawn])
    spans = s.get("axes_interval") or {}
    axes = [[escape(a), parts.axis_bar(v), dw.span(spans.get(a)), dw.rms_change(gap.get(a), v)] for a, v in (s.get("axes") or {}).items() if v is not None]
    tables = page.table(["parameter", "value", "interval", "unit", ""], rows, left=(0, 3, 4)) if rows else ""
    gains = page.table(["axis", "squared gap less by", "interval", "rms"], axes, left=(0, 1, 2, 3)) if axes else ""
    title = f"<h3><code>{escape(members[0])}</code>{others}</h3>"
    return f'{title}<p class="lead">{escape(", ".join(filter(None, said)))}</p><div class="two"><div>{tables}</div><div>{gains}</div></div>'


def _parity(d: dw.Document) -> str:
    rows = []
    for c in d.get("parity") or ():
        factor, unit = in_degrees(1.0, c.get("unit") or "1")
        value, low, high = (None if c.get(k) is None else c[k] * factor for k in ("value", "low", "high"))
        fault = escape(str(c.get("fault") or ""))
        real = f"<b>{fault or 'fault'}</b>" if c.get("significant") else f'<span class="lead">{fault}</span>'
        span = f"{number(low)} to {number(high)}" if low is not None and high is not None else "–"
        cells = [real, f"{number(value)}{'' if unit == '1' else f' {unit}'}", span, parts.whisker(value, low, high)]
        rows.append([escape(str(c.get("check", ""))), *cells, escape(str(c.get("note") or ""))])
    return page.table(["check", "fault", "value", "interval", "", "note"], rows, left=(0, 1, 4, 5)) if rows else ""


def _traces(d: dw.Document) -> tuple[dict[str, Any], list[dict[str, Any]], str]:
    """The worst stretches: measured, nominal, corrected."""
    axes, pictures, places = {}, [], []
    for k, trace in enumerate(d.get("traces") or ()):
        t = np.array(trace["t_s"], dtype=float)
        step = -(-len(t) // plots.MOST_POINTS) or 1
        factor, unit = in_degrees(1.0, trace.get("unit", "1"))
        labels = {"measured": "measured", "nominal": "nominal", "corrected": "corrected"}
        shown = [key for key in labels if trace.get(key) is not None and (key != "corrected" or d.get("causes"))]
        kept = {key: np.array(trace[key], dtype=float)[::step] * factor for key in shown}
        axes[f"trace{k}"] = plots.encode(t[::step])
        pictures.append(plots.plot(f"trace-{k}", [plots.series(key, labels[key], v) for key, v in kept.items()], f"trace{k}"))
        places.append(page.canvas(f"trace-{k}", str(trace.get("title") or trace.get("axis", "")), unit))
    return axes, pictures, f'<div class="plots">{"".join(places)}</div>' if places else ""


def _flight(d: dw.Document) -> tuple[str, str, str]:
    flight = d.get("manoeuvre") or {}
    return _paragraph(dw.next_flight(d)), _paragraph(flight.get("text", "")), parts.schedule(flight.get("schedule") or ())


def _harm(d: dw.Document) -> list[str]:
    return [f"{h.get('axis')}: the squared error grows by {per_cent(h.get('change'))} with the effects found" for h in d.get("harm") or ()]


def _not_testable(d: dw.Document) -> str:
    rows = [[f"<code>{escape(names)}</code>", escape(why)] for names, why in not_testable(d)]
    return page.table(["effect", "why"], rows, left=(0, 1), css="plain") if rows else ""


def _paragraph(words: Any) -> str:
    return f"<p>{escape(str(words))}</p>" if words else ""
