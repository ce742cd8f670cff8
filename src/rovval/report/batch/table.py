"""The table of a batch's runs: a row a run, one that can be read down a column. Columns that no run fills are left out."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from os.path import commonpath, relpath
from pathlib import Path
from urllib.parse import quote

from rovval.core.channels import AXES
from rovval.core.units import in_degrees
from rovval.report.batch.row import Row
from rovval.report.common import page
from rovval.report.common.words import duration, listed, number, per_cent
from rovval.report.diagnosis.words import group, names

TENTH, FEW = 0.9, 10  # the largest tenth of a column is bold, where that is at least one of ten
TEXTS = ("run", "folder", "vehicle", "verdict and cause", "")


def table(rows: Sequence[Row]) -> str:
    """In the order of the logs."""
    if not rows:
        return ""
    base = commonpath([Path(r.log).parent for r in rows])
    columns: list[tuple[str, Sequence[str]]] = [
        ("run", [link(r) for r in rows]),
        ("", [_state(r) for r in rows]),
        ("folder", [escape(relpath(Path(r.log).parent, base).removeprefix(".")) for r in rows]),
        ("vehicle", [escape(r.vehicle) for r in rows]),
        ("length", ["" if r.duration_s is None else duration(r.duration_s) for r in rows]),
        *((head, cells) for axis in AXES for head, cells in [_gaps(axis, rows)]),
        ("findings", [str(r.findings or "") for r in rows]),
        ("verdict and cause", [_cause(r) for r in rows]),
    ]
    kept = [(head, cells) for head, cells in columns if any(cells)]
    left = [j for j, (head, _) in enumerate(kept) if head in TEXTS]
    return page.table([head for head, _ in kept], zip(*(cells for _, cells in kept), strict=True), "runs", left=left)


def lead(rows: Sequence[Row]) -> str:
    """What the numbers are."""
    if not any(r.gap for r in rows):
        return ""  # a batch that only ingests
    windows = sorted({r.window_s for r in rows if r.window_s is not None})
    over = f" over windows of {listed(f'{s:g}' for s in windows)} s" if windows else ""
    over += " (less in shorter logs)" if any(r.window_s and r.duration_s is not None and r.duration_s < r.window_s for r in rows) else ""
    bold = "; the largest tenth of each column in bold" if len(rows) >= FEW else ""
    less = " Beside a cause: by how much the squared gap shrinks with it." if any(r.causes for r in rows) else ""
    return f"Gap of the simulator on each axis, rms{over}{bold}.{less}"


def link(row: Row) -> str:
    """The run, linked to its page where it has one."""
    place = row.report or row.diagnosis
    return f'<a href="{quote(place)}">{escape(row.run)}</a>' if place else escape(row.run)


def _gaps(axis: str, rows: Sequence[Row]) -> tuple[str, list[str]]:
    units = [r.gap[axis][1] for r in rows if axis in r.gap]
    if not units:
        return axis, []
    factor, unit = in_degrees(1.0, units[0])
    values = [r.gap[axis][0] * factor if axis in r.gap else None for r in rows]
    known = sorted(v for v in values if v is not None)
    large = known[int(TENTH * len(known))] if len(known) >= FEW else float("inf")
    cells = ["–" if v is None else f"<b>{number(v, 2)}</b>" if v >= large else number(v, 2) for v in values]
    return f"{axis}<small>{unit}</small>", cells


def _cause(row: Row) -> str:
    """What the diagnosis says, linked to its page, and by how much the squared gap shrinks with each cause."""
    if not row.verdict:
        return ""
    said = [f'<a href="{quote(row.diagnosis)}">{escape(row.verdict)}</a>']
    for cause in row.causes:
        total = (cause.get("shrinkage") or {}).get("total")
        less = "" if total is None else f" {per_cent(total)}"
        said.append(f"<small><code>{escape(names(group(cause)))}</code>{less}</small>")
    return "".join(said)


def _state(row: Row) -> str:
    marks = [("new", "lead", row.new), ("tolerance", "neg", row.beyond), ("limits", "neg", row.stops)]
    return ", ".join(f'<span class="{css}">{what}</span>' for what, css, holds in marks if holds)
