"""Rows of the catalogue of runs, as a table for a terminal and for programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from rovval.core.channels import AXES
from rovval.core.units import in_degrees
from rovval.report.common.numbers import listed, number

UNITS = dict(zip(AXES, ("m/s",) * 3 + ("rad/s",) * 3, strict=True))
CAUSES_SHOWN = 2


def documents(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """The rows for JSON: times as ISO 8601 in UTC, everything else as it is (SI)."""
    return [{name: value.isoformat() if isinstance(value, datetime) else value for name, value in row.items()} for row in rows]


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """The rows as text: run, date, vehicle, gap on each axis (rms of the windows), verdict and causes. ``*`` marks a run whose log has other
    content by now, ``~`` a date that is the file's."""
    axes = [axis for axis in AXES if any(row[axis] is not None for row in rows)]
    shown = {axis: in_degrees(1.0, UNITS[axis]) for axis in axes}
    head = ["run", "date", "vehicle", *(f"{axis} {shown[axis][1]}" for axis in axes), "verdict", "causes"]
    lines = [head, *(_line(row, axes) for row in rows)]
    widths = [max(len(line[i]) for line in lines) for i in range(len(head))]
    right = range(3, 3 + len(axes))
    return "\n".join("  ".join(c.rjust(w) if i in right else c.ljust(w) for i, (c, w) in enumerate(zip(line, widths, strict=True))).rstrip() for line in lines)


def _line(row: Mapping[str, Any], axes: Sequence[str]) -> list[str]:
    gap = [number(None if row[axis] is None else in_degrees(row[axis], UNITS[axis])[0]) for axis in axes]
    causes = [cause["effect"] for cause in row["causes"] or ()]
    more = f" and {len(causes) - CAUSES_SHOWN} more" if len(causes) > CAUSES_SHOWN else ""
    name = row["run"] + ("" if row["current"] else " *")
    date = f"{row['date']:%Y-%m-%d %H:%M}{'' if row['dated_by'] == 'stamps' else ' ~'}"
    return [name, date, row["vehicle"], *gap, row["verdict"] or "", listed(causes[:CAUSES_SHOWN]) + more]
