"""The comparison as Markdown: the same answer and tables as the page, for a terminal, a diff or an issue."""

from __future__ import annotations

from rovval.comparison.error_growth import HORIZONS_S, error_growth
from rovval.core.channels import AXES
from rovval.core.data import ChannelError, Comparison
from rovval.core.units import in_degrees, integral_unit
from rovval.report.common.markdown import bullets, grid
from rovval.report.common.numbers import MISSING, number, per_cent, quantity, signed
from rovval.report.comparison import words


def text(comparison: Comparison) -> str:
    """The whole report."""
    c, run = comparison, comparison.run
    said = words.sentences(c)
    parts = [f"# {run.id}: simulated against measured", f"> **{b}**" if (b := words.synthetic(c)) else "", f"**{said[0]}**"]
    parts += [" ".join(said[1:]), bullets(f"{k}: {v}" for k, v in words.facts(c).items() if v)]
    parts += ["## Error per axis", f"Simulated minus measured; {words.windows(c)}.", _axes(c)]
    parts += [bullets(words.notes(c))]
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
    parts += ["## Findings in this log", bullets(f"`{f.code}` {f.where}: {f.detail}" for f in run.findings) or "None."]
    parts += ["## Assumed, and where the simulation stopped", bullets([*c.sim.assumptions, *c.sim.stops]) or "Nothing."]
    parts += ["## Recording", "`rerun run.rrd` opens the recording; `report.json` has every number."]
    return "\n\n".join(p for p in parts if p) + "\n"


def _axes(c: Comparison) -> str:
    if len(c.not_measured) == len(AXES):
        return words.NO_VELOCITY
    header = ["axis", "mean error", "MAE", "RMSE", "IAE", "skill", "RMS, windows", "IAE, windows", "skill, windows", "no motion", "rows"]
    rows = []
    for axis in dict.fromkeys((*c.free, *c.windowed)):
        free, windowed = c.free.get(axis), c.windowed.get(axis)
        row = next(r for r in (free, windowed) if r is not None)
        cells = [_both(free, n) for n in ("mean_error", "mae", "rmse", "iae")] + [signed(free.skill) if free else MISSING]
        cells += [_both(windowed, n) for n in ("rmse", "iae")] + [signed(windowed.skill) if windowed else MISSING]
        rows.append([axis, *cells, _both(row, "baseline_rmse"), f"{row.n} ({per_cent(row.coverage)})"])
    rows += [[axis, "not measured", *[""] * 9] for axis in c.not_measured]
    return grid(header, rows)


def _other(c: Comparison) -> str:
    header = ["axis", f"MAE {c.other_name}", "MAE ours", f"RMSE {c.other_name}", "RMSE ours", f"skill {c.other_name}", "rows"]
    rows = []
    for axis, row in c.other.items():
        pairs = (row.mae, row.extra.get("ours_mae"), row.rmse, row.extra.get("ours_rmse"))
        rows.append([axis, *(quantity(v, row.unit) for v in pairs), signed(row.skill), str(row.n)])
    return grid(header, rows)


def _horizons(c: Comparison) -> str:
    rows = []
    for axis, curve in error_growth(c).items():
        points = [curve.at(s) for s in HORIZONS_S]
        rows.append([axis, *(MISSING if p is None else quantity(p[1], c.windowed[axis].unit) for p in points)])
    return grid(["axis", *(f"{s:g} s" for s in HORIZONS_S)], rows)


def _pose(c: Comparison) -> str:
    names = ("mean_error", "mae", "rmse", "baseline_rmse")
    rows = [[words.TITLES[k], *(_both(r, n) for n in names), signed(r.skill), str(r.n)] for k, r in c.pose.items()]
    return grid(["", "mean error", "MAE", "RMSE", "stays where it began", "skill", "rows"], rows)


def _both(row: ChannelError | None, name: str) -> str:
    """A value with its unit, degrees in brackets beside radians."""
    if row is None:
        return MISSING
    value, time = getattr(row, name), name == "iae"
    shown, unit = in_degrees(value, row.unit)
    own = integral_unit(row.unit) if time else row.unit
    degrees = f" ({number(shown)} {integral_unit(unit) if time else unit})" if unit != row.unit else ""
    return f"{number(value)} {own}{degrees}"
