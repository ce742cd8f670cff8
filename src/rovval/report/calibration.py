"""A calibration as one page: unknowns beside the file, which of them are seen together, runs predicted by a calibration without them, what to fly next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import log
from typing import Any

from rovval.core.units import in_degrees
from rovval.report.common.numbers import MISSING, interval, listed, number, per_cent, quantity
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.report.drawings import columns
from rovval.report.drawings.drawing import Box, Dot, Drawing, Line, Shape, Text

MOST_CELLS = 14  # unknowns of the first picture of correlations: more do not fit a phone's width
TOLD = 0.3  # correlation from which a cell has its number: below it a tenth of the variance is shared
REACH = 4.0  # standard deviations of the prior that a whisker's line is long, to either side
CELL, LABEL = 25.0, 138.0  # pixels of a picture of correlations

Row = Mapping[str, Any]


def html(document: Mapping[str, Any]) -> str:
    """The page of a document rovval.calibration/1, self-contained."""
    unknowns: Mapping[str, Row] = document["unknowns"]
    keys, pairs = list(unknowns), document["correlations"]
    shown = {key: row for key, row in unknowns.items() if row["shown"]}
    first = foremost(keys, document["matrix"])
    return render(
        "calibration.html",
        title=f"{document['run']} · rovval fit",
        eyebrow="Calibration",
        name=document["vehicle"],
        banner="",
        said=[answer(document), *rest(document)],
        facts={"logs": document["run"], "unknowns": f"{len(keys)}, {len(shown)} of them shown", "left out": "; ".join(document["left_out"])},
        rows=[(key, row, beside(row), error(row), interval(row["low"], row["high"], row["unit"]), whisker(row)) for key, row in shown.items()],
        held=[(key, row, beside(row), per_cent(row["standard_error"] / row["prior"])) for key, row in unknowns.items() if not row["shown"]],
        pairs=[(pair["of"], pair["value"], [unknowns[key] for key in pair["of"]]) for pair in pairs],
        main=heat_map([keys[i] for i in first], [[document["matrix"][i][j] for j in first] for i in first]) if first else None,
        whole=heat_map(keys, document["matrix"]) if len(keys) > len(first) else None,
        errors=[_bars(row) for row in document["free_run"]],
        further=[further(one) for one in document["extrapolated"]],
        options=document["options"],
        commands=commands(document["commands"]),
        tolerances=[(key, quantity(one["sd"], one["unit"])) for key, one in document["tolerances"].items()],
        discrepancy=[(kind, quantity(one["sd"], one["unit"])) for kind, one in document["discrepancy"].items()],
        footer=foot(),
    )


def answer(document: Mapping[str, Any]) -> str:
    """What the calibration is worth: the error of runs that it had not seen, beside that of the file as given."""
    rows = [row for row in document["free_run"] if row["given"] > 0.0]
    ratios = [row["left_out"] / row["given"] for row in rows if row["left_out"] is not None]
    if not ratios:
        own = per_cent(sum(row["calibrated"] / row["given"] for row in rows) / len(rows)) if rows else MISSING
        unknown = "What it is worth on another log nobody knows: give two or more."
        return f"On its own log the calibrated vehicle has {own} of the error of the file as given, mean over axes. {unknown}"
    worse = sum(ratio > 1.0 for ratio in ratios)
    more = f", and more than it on {worse} of {len(ratios)}" if worse else ""
    mean = per_cent(sum(ratios) / len(ratios))
    return f"A run that the calibration has not seen is predicted with {mean} of the error of the file as given, mean over axes and runs{more}."


def rest(document: Mapping[str, Any]) -> list[str]:
    """What else stands at the head: how far the furthest unknowns moved, and a search that has not settled."""
    rows = {key: row for key, row in document["unknowns"].items() if row["shown"]}
    far = sorted(rows, key=lambda key: -_size(rows[key]))[:3]
    said = ["Furthest from the file: " + listed(f"{key} ({beside(rows[key])})" for key in far) + "."] if far else []
    if not document["converged"]:
        said.append("The search had not settled when it ended: give longer logs, or a vehicle's file that is nearer.")
    return said


def _size(row: Row) -> float:
    """How far an unknown is from the file as it was given, in standard deviations of its prior."""
    moved = log(row["value"]) if row["kind"] == "factor" else float(row["value"])
    return abs(moved) / float(row["prior"])


def beside(row: Row) -> str:
    """A factor of the file's number, or an offset to it: x 1.42; 0.0231 m."""
    return f"x {number(row['value'])}" if row["kind"] == "factor" else quantity(row["value"], row["unit"])


def error(row: Row) -> str:
    """The standard error: of a factor as a share of it."""
    return per_cent(row["standard_error"]) if row["kind"] == "factor" else quantity(row["standard_error"], row["unit"])


def whisker(row: Row) -> Drawing:
    """The interval on the scale of the prior: its band of one standard deviation, its mean as a tick, ends of the line at four."""
    width, height = 170.0, 18.0
    middle, half = height / 2, (row["high"] - row["low"]) / 2
    if row["kind"] == "factor":
        half = log(row["high"] / row["low"]) / 2

    def x(deviations: float) -> float:
        return width / 2 + (width / 2 - 8.0) * max(-REACH, min(deviations, REACH)) / REACH

    ends = [row["moved"] + side * half / row["prior"] for side in (-1.0, 1.0)]
    shapes = (
        Box(x(-1.0), 1, x(1.0) - x(-1.0), height - 2, "prior", 2),
        Line(4, middle, width - 4, middle, "axis"),
        Line(x(0.0), 2, x(0.0), height - 2, "base"),
        Box(x(ends[0]), middle - 3, max(x(ends[1]) - x(ends[0]), 1), 6, "span", 2),
        Dot(x(row["moved"]), middle, 4, "dot"),
    )
    return Drawing(width, height, f"{row['moved']:+.1f} [{ends[0]:+.1f}, {ends[1]:+.1f}] standard deviations of the prior from its mean", shapes)


def foremost(keys: Sequence[str], matrix: Sequence[Sequence[float]]) -> list[int]:
    """The unknowns of the strongest correlations, in their own order, as many as fit; none where nothing is told."""
    pairs = sorted(((abs(matrix[i][j]), i, j) for i in range(len(keys)) for j in range(i)), reverse=True)
    found: dict[int, None] = {}
    for value, i, j in pairs:
        wider = found | {j: None, i: None}
        if value < TOLD or len(wider) > MOST_CELLS:
            break
        found = wider
    return sorted(found)


def heat_map(keys: Sequence[str], matrix: Sequence[Sequence[float]]) -> Drawing:
    """The lower triangle of the correlations: one colour for those above zero, another below, stronger the closer to one. Columns are counted as rows are."""
    shapes: list[Shape] = []
    for i, key in enumerate(keys):
        y = CELL * i
        shapes += [Text(0, y + 0.68 * CELL, f"{i + 1}", "m"), Text(18, y + 0.68 * CELL, key, "key")]
        for j in range(i):
            x, value = LABEL + CELL * j, matrix[i][j]
            strength = min(9, round(10 * abs(value)))
            if strength:
                shapes.append(Box(x + 1, y + 1, CELL - 2, CELL - 2, f"{'plus' if value > 0 else 'minus'} o{strength}", 3))
            if abs(value) >= TOLD:
                shapes.append(Text(x + CELL / 2, y + 0.66 * CELL, f"{value:.1f}".replace("0.", "."), "value", "middle"))
        if i + 1 < len(keys):
            shapes.append(Text(LABEL + CELL * (i + 0.5), CELL * len(keys) + 12, f"{i + 1}", "m", "middle"))
    values = {"unknown": columns.words(keys)} | {key: columns.words([round(row[j], 6) for row in matrix]) for j, key in enumerate(keys)}
    return Drawing(LABEL + CELL * max(len(keys) - 1, 1) + 4, CELL * len(keys) + 18, f"correlations of {len(keys)} unknowns", tuple(shapes), values)


def _bars(row: Row) -> tuple[Row, list[tuple[str, float]], str]:
    """Of a run and axis the three errors as words and as shares of the largest, and how the predicted one stands to the file as given."""
    names = ("given", "calibrated", "left_out")
    top = max(row[name] or 0.0 for name in names) or 1.0
    factor = in_degrees(1.0, row["unit"])[0]
    cells = [(number(row[name] * factor) if row[name] is not None else MISSING, (row[name] or 0.0) / top) for name in names]
    return row, cells, per_cent(row["left_out"] / row["given"]) if row["left_out"] is not None and row["given"] > 0.0 else MISSING


def further(one: Row) -> str:
    """A run that drives a thruster further than the runs that predict it."""
    how_far = f"to {one['rpm']:.0f} rpm, on {one['rows']} of {one['n']} rows beyond the {one['others']:.0f} rpm of the other logs"
    return f"{one['run']} drives {one['thruster']} {one['way']} {how_far}: its prediction is extrapolated there."


def commands(largest: Mapping[str, float]) -> list[tuple[str, str, str]]:
    """Name, and the largest command ahead and astern, of each thruster."""
    found: dict[str, dict[str, str]] = {}
    for key, rpm in largest.items():
        way, _, name = key.removeprefix("command.").partition("[")
        found.setdefault(name.removesuffix("]"), {})[way] = f"{rpm:.0f}"
    return [(name, ways["ahead"], ways["astern"]) for name, ways in found.items()]
