"""A comparison as text for a terminal: aligned, with units, degrees on the line under radians."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from rovval.core.data import ChannelError, Comparison
from rovval.core.units import DEGREE_UNITS, DEGREES
from rovval.report.common.numbers import duration, listed, number, per_cent, signed
from rovval.report.common.terminal import WIDTH
from rovval.report.comparison import words


def text(comparison: Comparison) -> str:
    """The tables of the axes, free run and windows, then pose, the other simulator, and what was not measured; no line is longer than `WIDTH`."""
    c, run, sim = comparison, comparison.run, comparison.sim
    parts = [b] if (b := words.synthetic(c)) else []
    length = duration(run.duration_s)
    parts = [line for part in parts for line in wrap(part, WIDTH)]
    parts += wrap(f"{run.id}: {sim.vehicle}, model {sim.model}, {length}, thruster input: {sim.input_source}", WIDTH)
    parts += [*wrap(words.verdict(c), WIDTH), ""]
    for title, table, still in (("free run", c.free, "no motion"), (words.windows(c), c.windowed, "no motion"), ("in windows", c.pose, "stays")):
        lines = [line for name, row in table.items() for line in _row(words.TITLES.get(name, name), row)]
        parts += [_grid([(title, "unit", "mean err", "MAE", "RMSE", "IAE", still, "skill", "rows"), *lines]), ""] if lines else []
    if c.other:
        head = ("free run", "unit", f"{c.other_name} MAE", "ours MAE", f"{c.other_name} RMSE", "ours RMSE", "skill", "rows")
        parts += [_grid([head, *_other(c)]), ""]
    last = [f"not measured: {listed(c.not_measured)}"] if c.not_measured else []
    last += [said] if (said := words.track(c)) else []
    last += [f"stopped: {s}" for s in sim.stops]
    last += ["error = simulated - measured; IAE in unit x s; skill = 1 - MSE / MSE of the trivial predictor; rows: share that was compared"]
    return "\n".join([*parts, *(line for words in last for line in wrap(words, WIDTH))]) + "\n"


def _row(title: str, row: ChannelError) -> list[list[str]]:
    """One channel, and the same in degrees below it."""
    rows = []
    for unit, factor in _units(row.unit):
        main = unit == row.unit
        cells = [number(getattr(row, name) * factor) for name in ("mean_error", "mae", "rmse", "iae", "baseline_rmse")]
        rows.append([title if main else "", unit, *cells, signed(row.skill) if main else "", per_cent(row.coverage) if main else ""])
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


def _units(unit: str) -> list[tuple[str, float]]:
    return [(unit, 1.0), *([(DEGREE_UNITS[unit], DEGREES)] if unit in DEGREE_UNITS else [])]


def _grid(rows: Sequence[Sequence[str]]) -> str:
    """Columns aligned, the first two to the left, numbers to the right; nearer together where they would not fit."""
    widths = [max(len(r[j]) for r in rows) for j in range(len(rows[0]))]
    gap = "  " if sum(widths) + 2 * (len(widths) - 1) <= WIDTH else " "
    lines = ([c.ljust(w) if j < 2 else c.rjust(w) for j, (c, w) in enumerate(zip(row, widths, strict=True))] for row in rows)
    return "\n".join(gap.join(cells).rstrip() for cells in lines)
