"""Rows of the catalogue of runs, as a table for a terminal and for programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from rovval.core.channels import AXES
from rovval.core.units import in_degrees
from rovval.report.common.numbers import listed, number
from rovval.report.common.terminal import WIDTH, fitted

UNITS = dict(zip(AXES, ("m/s",) * 3 + ("rad/s",) * 3, strict=True))
CAUSES_SHOWN = 2


def documents(rows: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """The rows for JSON: times as ISO 8601 in UTC, everything else as it is (SI)."""
    return [{name: value.isoformat() if isinstance(value, datetime) else value for name, value in row.items()} for row in rows]


def table(rows: Sequence[Mapping[str, Any]]) -> str:
    """The rows as text: run, date, vehicle, gap on each axis (rms of the windows), verdict and causes; below each other where a line of them is too long
    for a terminal. ``*`` marks a run whose log has other content by now, ``~`` a date that is the file's."""
    axes = [axis for axis in AXES if any(row[axis] is not None for row in rows)]
    names, gaps = ["run", "date", "vehicle"], [f"{axis} {in_degrees(1.0, UNITS[axis])[1]}" for axis in axes]
    parts = [(names, gaps, ["verdict", "causes"]), *((_named(row), _gaps(row, axes), _found(row)) for row in rows)]
    right = range(len(names), len(names) + len(axes))
    whole = _aligned([[*named, *gap, *found] for named, gap, found in parts], right)
    if max(map(len, whole)) <= WIDTH:
        return "\n".join(whole)
    first = _aligned([named for named, _, _ in parts], ())
    second = _aligned([["", *gap] for _, gap, _ in parts], range(1, 1 + len(axes)))
    third = (f"  {': '.join(filter(None, found))}" for _, _, found in parts)
    return fitted("\n".join(line for group in zip(first, second, third, strict=True) for line in group if line.strip()))


def _aligned(lines: Sequence[Sequence[str]], right: Sequence[int]) -> list[str]:
    """Cells in columns, those of ``right`` to the right."""
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    rows = (zip(line, widths, strict=True) for line in lines)
    return ["  ".join(c.rjust(w) if i in right else c.ljust(w) for i, (c, w) in enumerate(row)).rstrip() for row in rows]


def _named(row: Mapping[str, Any]) -> list[str]:
    date = f"{row['date']:%Y-%m-%d %H:%M}{'' if row['dated_by'] == 'stamps' else ' ~'}"
    return [row["run"] + ("" if row["current"] else " *"), date, row["vehicle"]]


def _gaps(row: Mapping[str, Any], axes: Sequence[str]) -> list[str]:
    return [number(None if row[axis] is None else in_degrees(row[axis], UNITS[axis])[0]) for axis in axes]


def _found(row: Mapping[str, Any]) -> list[str]:
    causes = [cause["effect"] for cause in row["causes"] or ()]
    more = f" and {len(causes) - CAUSES_SHOWN} more" if len(causes) > CAUSES_SHOWN else ""
    return [row["verdict"] or "", listed(causes[:CAUSES_SHOWN]) + more]
