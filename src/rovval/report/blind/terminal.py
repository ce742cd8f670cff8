"""The score of a blind check as a table of plain text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.core.counts import counted
from rovval.report.blind import honesty
from rovval.report.blind.marks import COLUMNS, short, title


def pooled(result: Mapping[str, Any]) -> str:
    """Several sets, each plant apart."""
    parts = []
    for plant, row in result["plants"].items():
        head = f"plant {plant}: {row['logs']} logs of {', '.join(row['sets'])}; engine {', '.join(row['engines'])}"
        parts.append("\n".join([head, "", *honesty.lines(row), "", *honesty.table(row), "", *honesty.wrong(row)]))
    return "\n\n".join(parts)


def text(result: Mapping[str, Any]) -> str:
    """Kinds of logs and the headline marks."""
    width = max(len(name) for name in result["strata"]) + 1
    lines = [f"{'stratum':<{width}}{'n':>5}" + "".join(f"{head:>11}" for head in COLUMNS.values())]
    for name, row in result["strata"].items():
        cells = "".join(f"{short(mark, row.get(mark)):>11}" for mark in COLUMNS)
        lines.append(f"{name:<{width}}{row['n']:>5}{cells}")
    end = f"{counted(len(result['wrong']), 'answer')} wrong; all marks with intervals: score.html"
    return "\n".join([title(result), "", *lines, "", *honesty.lines(result["summed"]), "", end])
