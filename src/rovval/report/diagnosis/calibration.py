"""A vehicle's file that is off in many coefficients at once, as rows for every format: what was tuned, how far it is off, what shrinks."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from typing import Any

from rovval.core.units import in_degrees
from rovval.report.common.markdown import grid
from rovval.report.common.numbers import number, per_cent
from rovval.report.diagnosis import glue as page
from rovval.report.diagnosis.calibration_words import held_out, times
from rovval.report.diagnosis.parts import axis_bar, whisker
from rovval.report.diagnosis.words import interval, rms_change, span

TITLE = "Many coefficients off together"
LEAD = "Not a cause: a badly calibrated vehicle file, or an effect that the library lacks and that many coefficients imitate."
WRITE = "Write that vehicle and diagnose again with it; `rovval fit` tells a larger shrinkage, along the tangent of one fit to everything:"


def section(d: Mapping[str, Any]) -> str:
    """The tuned parameters with what they shrink the gap by, axis by axis, and the command that writes them; "" where nothing was tuned."""
    found = d.get("calibration")
    if not found:
        return ""
    rows = [[f"<code>{escape(name)}</code>", *_cells(row), _drawn(row), escape(_said(row))] for name, row in found["parameters"].items()]
    tables = page.table(["parameter", "was", "value", "interval", "", "off by"], rows, left=(0, 4, 5))
    gains = [[escape(a), axis_bar(v), *rest] for a, v, *rest in _axes(d, found)]
    shrunk = page.table(["axis", "squared gap less by", "interval", "rms"], gains, left=(0, 1, 2, 3))
    command = f"<p>{escape(WRITE)}</p><pre>{escape(found['command'])}</pre>"
    return page.section(TITLE, f"<p>{escape(_far(found))}</p>", tables, shrunk, command, lead=LEAD)


def markdown(d: Mapping[str, Any]) -> list[str]:
    """The same in Markdown, without its title; [] where nothing was tuned."""
    found = d.get("calibration")
    if not found:
        return []
    rows = [[f"`{name}`", *_cells(row), _said(row)] for name, row in found["parameters"].items()]
    gains = [[a, per_cent(v), *rest] for a, v, *rest in _axes(d, found)]
    shrunk = grid(["axis", "squared gap less by", "interval", "rms"], gains)
    return [LEAD, _far(found), grid(["parameter", "was", "value", "interval", "off by"], rows), shrunk, WRITE, f"```\n{found['command']}\n```"]


def lines(d: Mapping[str, Any]) -> list[str]:
    """The same for a terminal; [] where nothing was tuned."""
    found = d.get("calibration")
    if not found:
        return []
    rows = [(name, *_cells(row), _said(row)) for name, row in found["parameters"].items()]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    said = ["  ".join([r[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(r[1:4], widths[1:], strict=True)), r[4]]).rstrip() for r in rows]
    axes = ", ".join(f"{a} {per_cent(v)}" for a, v, *_ in _axes(d, found))
    return [*said, _far(found), f"by axis, squared, held out: {axes}", "to write that vehicle:", f"  {found['command']}"]


def _far(found: Mapping[str, Any]) -> str:
    return f"Tuned together, the squared gap shrinks by {interval(found['shrinkage'])} {held_out(found)}."


def _cells(row: Mapping[str, Any]) -> list[str]:
    """was, value with unit, interval."""
    factor, unit = in_degrees(1.0, row["unit"])
    was, value, low, high = (number(row[k] * factor) for k in ("was", "value", "low", "high"))
    return [was, f"{value}{'' if unit == '1' else f' {unit}'}", f"{low} to {high}"]


def _drawn(row: Mapping[str, Any]) -> str:
    return whisker(row["value"], row["low"], row["high"], row["was"])


def _said(row: Mapping[str, Any]) -> str:
    """How many tolerances, that it rests at a bound, that it is not the file's but a named cause's."""
    said = ["of a named cause"] if row["of_cause"] else [times(row) if row["beyond"] else "not shown to be beyond its tolerance"]
    return ", ".join([*said, *(["rests at its bound"] if row["at_bound"] else [])])


def _axes(d: Mapping[str, Any], found: Mapping[str, Any]) -> list[tuple[str, float, str, str]]:
    """Axis, share closed, its interval, rms before and after."""
    gap, spans = (d.get("gap") or {}).get("axes") or {}, found["shrinkage"]["axes_interval"]
    return [(axis, share, span(spans.get(axis)), rms_change(gap.get(axis), share)) for axis, share in found["shrinkage"]["axes"].items()]
