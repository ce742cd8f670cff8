"""A comparison as text for a terminal: aligned, with units, degrees on the line under radians."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from rovval.core.data import ChannelError, Comparison
from rovval.core.units import DEGREE_UNITS, DEGREES
from rovval.report.common.numbers import MISSING, duration, listed, number, per_cent, signed
from rovval.report.comparison import words

_HEAD = ("", "unit", "mean err", "MAE", "RMSE", "IAE", "no motion", "skill", "RMS", "IAE", "skill", "rows")


def text(comparison: Comparison) -> str:
    """The per-axis table: free run and windows side by side, then pose, the other simulator, and what was not measured."""
    c, run, sim = comparison, comparison.run, comparison.sim
    parts = [b] if (b := words.synthetic(c)) else []
    length = duration(run.duration_s)
    parts += [f"{run.id}: {sim.vehicle}, model {sim.model}, {length}, thruster input: {sim.input_source}"]
    parts += [*wrap(words.verdict(c), 100), ""]
    axes = dict.fromkeys((*c.free, *c.windowed))
    rows = [line for axis in axes for line in _axis(axis, c.free.get(axis), c.windowed.get(axis))]
    over = ["", "", "free run", "", "", "", "", "", words.windows(c), "", "", ""]
    parts += [_grid([over, _HEAD, *rows]), ""] if rows else []
    if c.pose:
        lines = [line for name, row in c.pose.items() for line in _pose(name, row)]
        parts += [_grid([("in windows", "unit", "mean err", "MAE", "RMSE", "IAE", "stays", "skill", "rows"), *lines]), ""]
    if c.other:
        head = ("free run", "unit", f"{c.other_name} MAE", "ours MAE", f"{c.other_name} RMSE", "ours RMSE", "skill", "rows")
        parts += [_grid([head, *_other(c)]), ""]
    parts += [f"not measured: {listed(c.not_measured)}"] if c.not_measured else []
    parts += [f"stopped: {s}" for s in sim.stops]
    parts += ["error = simulated - measured; IAE in unit x s; skill = 1 - MSE / MSE of the trivial predictor"]
    return "\n".join(parts) + "\n"


def _axis(axis: str, free: ChannelError | None, windowed: ChannelError | None) -> list[list[str]]:
    first = next(row for row in (free, windowed) if row is not None)
    rows = []
    for unit, factor in _units(first.unit):
        main = unit == first.unit
        cells = [axis if main else "", unit]
        cells += _cells(free, factor, main, ("mean_error", "mae", "rmse", "iae", "baseline_rmse"))
        cells += _cells(windowed, factor, main, ("rmse", "iae"))
        rows.append([*cells, f"{first.n} ({per_cent(first.coverage)})" if main else ""])
    return rows


def _pose(name: str, row: ChannelError) -> list[list[str]]:
    rows = []
    for unit, factor in _units(row.unit):
        main = unit == row.unit
        cells = _cells(row, factor, main, ("mean_error", "mae", "rmse", "iae", "baseline_rmse"))
        rows.append([words.TITLES[name] if main else "", unit, *cells, f"{row.n} ({per_cent(row.coverage)})" if main else ""])
    return rows


def _other(c: Comparison) -> list[list[str]]:
    rows = []
    for axis, row in c.other.items():
        for unit, k in _units(row.unit):
            main = unit == row.unit
            pairs = [row.mae, row.extra.get("ours_mae"), row.rmse, row.extra.get("ours_rmse")]
            numbers = [number(None if v is None else v * k) for v in pairs]
            rows.append([axis if main else "", unit, *numbers, signed(row.skill) if main else "", str(row.n) if main else ""])
    return rows


def _cells(row: ChannelError | None, factor: float, main: bool, names: Sequence[str]) -> list[str]:
    if row is None:
        return [MISSING] * (len(names) + 1)
    return [*(number(getattr(row, n) * factor) for n in names), signed(row.skill) if main else ""]


def _units(unit: str) -> list[tuple[str, float]]:
    return [(unit, 1.0), *([(DEGREE_UNITS[unit], DEGREES)] if unit in DEGREE_UNITS else [])]


def _grid(rows: Sequence[Sequence[str]]) -> str:
    """Columns aligned: the first two to the left, numbers to the right, a heading over several columns may run on."""
    body = [r for r in rows if r[2] != "free run"]
    widths = [max(len(r[j]) for r in body) for j in range(len(body[0]))]
    lines = []
    for row in rows:
        if row[2] == "free run":
            start, then = (sum(widths[:j]) + 2 * j + 2 for j in (2, 8))
            lines.append((" " * start + row[2]).ljust(then) + row[8])
            continue
        cells = [c.ljust(w) if j < 2 else c.rjust(w) for j, (c, w) in enumerate(zip(row, widths, strict=True))]
        lines.append("  ".join(cells).rstrip())
    return "\n".join(lines)
