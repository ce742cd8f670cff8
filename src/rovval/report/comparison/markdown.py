"""The comparison as Markdown: the same answer and tables as the page, for a terminal, a diff or an issue."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rovval.comparison.error_growth import HORIZONS_S, horizons
from rovval.core.channels import AXES
from rovval.core.data import ChannelError, Comparison
from rovval.core.units import in_degrees
from rovval.report.common import words
from rovval.report.common.words import number, per_cent, quantity
from rovval.report.comparison import windows
from rovval.report.comparison.table import skill


def text(comparison: Comparison) -> str:
    """The whole report."""
    c, run = comparison, comparison.run
    said = words.sentences(c)
    parts = [f"# {run.id}: simulated against measured", f"> **{b}**" if (b := words.synthetic(c)) else "", f"**{said[0]}**"]
    parts += [" ".join(said[1:]), _bullets(f"{k}: {v}" for k, v in words.facts(c).items() if v)]
    parts += ["## Error per axis", f"Simulated minus measured; {windows.label(c)}.", _axes(c)]
    parts += [_bullets(words.notes(c))]
    if c.other:
        parts += [f"## Beside {c.other_name}", "Free runs, on the rows that both have.", _other(c)]
    if c.windowed:
        parts += ["## Error after a window's start (rms)", _horizons(c)]
    if c.pose:
        parts += ["## Depth and attitude in the windows", _pose(c)]
    k = run.clock
    offset = "unknown" if k.offset_s is None else f"{number(k.offset_s)} s (correlation {number(k.correlation)})"
    stamps = f"{k.stamp} clock, {k.matched} of {k.samples} samples matched, largest gap {number(k.largest_gap_s)} s"
    parts += ["## Time stamps", f"{stamps}, offset between thrusters and navigation {offset}. {k.note}".rstrip()]
    parts += ["## Findings in this log", _bullets(f"`{f.code}` {f.where}: {f.detail}" for f in run.findings) or "None."]
    parts += ["## Assumed, and where the simulation stopped", _bullets([*c.sim.assumptions, *c.sim.stops]) or "Nothing."]
    parts += ["## Recording", "`rerun run.rrd` opens the recording; `report.json` has every number."]
    return "\n\n".join(p for p in parts if p) + "\n"


def grid(header: Sequence[str], rows: Iterable[Sequence[str]], text_columns: int = 1) -> str:
    """A Markdown table, numbers to the right."""
    marks = ["---" if j < text_columns else "---:" for j in range(len(header))]
    return "\n".join("| " + " | ".join(r).replace("\n", " ") + " |" for r in (header, marks, *rows))


def bullets(items: Iterable[str]) -> str:
    """A list of lines, "" for none."""
    return "\n".join(f"- {item}" for item in items)


_bullets = bullets


def _axes(c: Comparison) -> str:
    if len(c.not_measured) == len(AXES):
        return words.NO_VELOCITY
    header = ["axis", "mean error", "MAE", "RMSE", "IAE", "skill", "RMS, windows", "IAE, windows", "skill, windows", "no motion", "rows"]
    rows = []
    for axis in dict.fromkeys((*c.free, *c.windowed)):
        free, windowed = c.free.get(axis), c.windowed.get(axis)
        row = next(r for r in (free, windowed) if r is not None)
        cells = [_both(free, n) for n in ("mean_error", "mae", "rmse", "iae")] + [skill(free.skill) if free else "-"]
        cells += [_both(windowed, n) for n in ("rmse", "iae")] + [skill(windowed.skill) if windowed else "-"]
        rows.append([axis, *cells, _both(row, "baseline_rmse"), f"{row.n} ({per_cent(row.coverage)})"])
    rows += [[axis, "not measured", *[""] * 9] for axis in c.not_measured]
    return grid(header, rows)


def _other(c: Comparison) -> str:
    header = ["axis", f"MAE {c.other_name}", "MAE ours", f"RMSE {c.other_name}", "RMSE ours", f"skill {c.other_name}", "rows"]
    rows = []
    for axis, row in c.other.items():
        pairs = (row.mae, row.extra.get("ours_mae"), row.rmse, row.extra.get("ours_rmse"))
        rows.append([axis, *("-" if v is None else quantity(v, row.unit) for v in pairs), skill(row.skill), str(row.n)])
    return grid(header, rows)


def _horizons(c: Comparison) -> str:
    rows = []
    for axis, curve in horizons(c).items():
        points = [curve.at(s) for s in HORIZONS_S]
        rows.append([axis, *("-" if p is None else quantity(p[1], c.windowed[axis].unit) for p in points)])
    return grid(["axis", *(f"{s:g} s" for s in HORIZONS_S)], rows)


def _pose(c: Comparison) -> str:
    names = ("mean_error", "mae", "rmse", "baseline_rmse")
    rows = [[words.TITLES[k], *(_both(r, n) for n in names), skill(r.skill), str(r.n)] for k, r in c.pose.items()]
    return grid(["", "mean error", "MAE", "RMSE", "stays where it began", "skill", "rows"], rows)


def _both(row: ChannelError | None, name: str) -> str:
    """A value with its unit, degrees in brackets beside radians."""
    if row is None:
        return "-"
    value, time = getattr(row, name), name == "iae"
    shown, unit = in_degrees(value, row.unit)
    own = _iae(row.unit) if time else row.unit
    degrees = f" ({number(shown)} {_iae(unit) if time else unit})" if unit != row.unit else ""
    return f"{number(value)} {own}{degrees}"


def _iae(unit: str) -> str:
    return unit.removesuffix("/s") if unit.endswith("/s") else f"{unit} s"
