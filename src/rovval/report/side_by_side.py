"""Several comparisons side by side, of several runs or by several models, as text, as a page and as JSON: the error of each axis in windows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from rovval.comparison.error_growth import error_growth
from rovval.core.channels import AXES
from rovval.core.counts import counted
from rovval.core.data import Comparison
from rovval.core.units import in_degrees
from rovval.report.common.numbers import MISSING, listed, number
from rovval.report.common.page import render
from rovval.report.common.terminal import fitted
from rovval.report.common.versions import foot
from rovval.report.comparison.json import document as comparison_json
from rovval.report.drawings.chart import chart
from rovval.report.drawings.drawing import Drawing

SCHEMA = "rovval.side_by_side/1"
MOST_CURVES = 8  # that have a colour of their own


def names(comparisons: Sequence[Comparison]) -> list[str]:
    """What tells them apart: the run, the model, or both."""
    runs, models = {c.run.id for c in comparisons}, {c.sim.model for c in comparisons}
    return [", ".join([*([c.run.id] if len(runs) > 1 else []), *([c.sim.model] if len(models) > 1 else [])]) or c.run.id for c in comparisons]


def text(comparisons: Sequence[Comparison]) -> str:
    """A line a comparison, an axis a column: rms in windows, angles in degrees."""
    axes = _axes(comparisons)
    rows = [["", *(f"{axis} {unit}" for axis, unit in axes.items())]]
    rows += [[name, *(MISSING if v is None else number(v) for v in values)] for name, values in zip(names(comparisons), _values(comparisons), strict=True)]
    widths = [max(len(row[j]) for row in rows) for j in range(1, len(rows[0]))]
    lines = [said(comparisons), ""]
    for name, *cells in rows:
        lines += [name] if name else []
        lines.append("  " + "  ".join(c.rjust(w) for c, w in zip(cells, widths, strict=True)))
    return fitted("\n".join(lines))


def said(comparisons: Sequence[Comparison]) -> str:
    """Of several models which is nearest to the vehicle, and how often; of runs by one model, between what their errors lie."""
    models, axes = list(dict.fromkeys(c.sim.model for c in comparisons)), _axes(comparisons)
    if len(models) > 1:
        wins = Counter(comparisons[k].sim.model for k, _ in _nearest(comparisons))
        won = listed(f"{model} in {wins[model]}" for model in sorted(models, key=lambda m: -wins[m]))
        return f"Nearest to the vehicle, of {wins.total()} axes (rms in windows): {won}."
    columns = zip(*_values(comparisons), strict=True)
    known = {axis: [v for v in column if v is not None] for axis, column in zip(axes, columns, strict=True)}
    spans = listed(f"{axis} {number(min(values), 2)} to {number(max(values), 2)} {axes[axis]}" for axis, values in known.items())
    return f"Over {counted(len(comparisons), 'run')}, rms in windows: {spans}."


def html(comparisons: Sequence[Comparison]) -> str:
    """The page, self-contained."""
    runs, models = list(dict.fromkeys(c.run.id for c in comparisons)), list(dict.fromkeys(c.sim.model for c in comparisons))
    facts = {"runs": listed(runs), "models": listed(models), "vehicles": listed(dict.fromkeys(c.sim.vehicle for c in comparisons))}
    return render(
        "side_by_side.html", title="Side by side · rovval", eyebrow="Simulated against measured", name="Side by side", banner="", facts=facts,
        said=[said(comparisons)], axes=_axes(comparisons), nearest=_nearest(comparisons), figures=figures(comparisons), footer=foot(),
        rows=list(zip(names(comparisons), _values(comparisons), strict=True)),
    )  # fmt: skip


def figures(comparisons: Sequence[Comparison]) -> list[Drawing]:
    """Per axis, how the error grows from a window's start: a curve a comparison, the first `MOST_CURVES` of them."""
    grown = [(name, c, error_growth(c)) for name, c in zip(names(comparisons), comparisons, strict=True)][:MOST_CURVES]
    drawings = []
    for axis, unit in _axes(comparisons).items():
        factor = in_degrees(1.0, "rad/s")[0] if unit == "deg/s" else 1.0
        curves = {str(k): growth[axis].rms * factor for k, (_, _, growth) in enumerate(grown, 1) if axis in growth}
        if curves:
            drawings.append(chart(axis, unit, comparisons[0].run.dt, curves))
    return drawings


def document(comparisons: Sequence[Comparison]) -> dict[str, Any]:
    """Each of them whole (rovval.comparison/1), by what tells it apart."""
    each = {name: comparison_json(c) for name, c in zip(names(comparisons), comparisons, strict=True)}
    return {"schema": SCHEMA, "sentence": said(comparisons), "comparisons": each}


def _axes(comparisons: Sequence[Comparison]) -> Mapping[str, str]:
    """Axes that at least one of them has, with the unit in which they are shown."""
    units = {axis: row.unit for c in comparisons for axis, row in c.windowed.items()}
    return {axis: in_degrees(1.0, units[axis])[1] for axis in AXES if axis in units}


def _values(comparisons: Sequence[Comparison]) -> list[list[float | None]]:
    """A row a comparison: rms in windows of each axis, angles in degrees; None where an axis was not measured."""
    rows = [[c.windowed.get(axis) for axis in _axes(comparisons)] for c in comparisons]
    return [[None if r is None else in_degrees(r.rmse, r.unit)[0] for r in row] for row in rows]


def _nearest(comparisons: Sequence[Comparison]) -> set[tuple[int, int]]:
    """Of each run and axis, the comparison with the smallest error: (comparison, axis) by their places; none of a run that is there once."""
    found, values = set(), _values(comparisons)
    for run in {c.run.id for c in comparisons}:
        rows = [k for k, c in enumerate(comparisons) if c.run.id == run]
        for axis in range(len(_axes(comparisons))):
            known = [(v, k) for k in rows if (v := values[k][axis]) is not None]
            found |= {(min(known)[1], axis)} if len(known) > 1 else set()
    return found
