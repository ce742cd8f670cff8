"""The dives of each vehicle as small curves, one an axis, with what has changed in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from rovval.core.channels import AXES
from rovval.core.units import in_degrees
from rovval.report.common import trend as words
from rovval.report.common.numbers import quantity
from rovval.report.drawings import columns
from rovval.report.drawings.drawing import Curve, Dot, Drawing, Line, Shape
from rovval.trend import Trend

WIDTH, HEIGHT, EDGE = 110.0, 30.0, 3.0
MOST_POINTS = 110  # one a pixel; of more dives the median of as many neighbours each, under the name of the first


@dataclass(frozen=True, slots=True)
class Spark:
    """A curve, and the median of the last dives in words."""

    drawing: Drawing
    now: str


@dataclass(frozen=True, slots=True)
class Vehicle:
    """One vehicle: how many dives, the curve of each axis that was measured, and what has changed."""

    name: str
    dives: int
    by_axis: Mapping[str, Spark | None]
    said: Sequence[str]


def axes(trends: Sequence[Trend]) -> list[str]:
    """The axes that some vehicle measured, in their order."""
    measured = {t.series.name for t in trends if t.series.of == "gap"}
    return [axis for axis in AXES if axis in measured]


def vehicles(trends: Sequence[Trend]) -> list[Vehicle]:
    """What the page shows of each vehicle."""
    groups = [list(group) for _, group in groupby(trends, key=lambda t: t.series.vehicle)]
    return [_vehicle(group, axes(trends)) for group in groups if any(t.series.of == "gap" for t in group)]


def _vehicle(trends: Sequence[Trend], shown: Sequence[str]) -> Vehicle:
    gaps = {t.series.name: t for t in trends if t.series.of == "gap"}
    name = trends[0].series.vehicle
    said = [f"{name}, {words.title(t)}: {words.said(t)}." for t in trends if t.changes]
    return Vehicle(
        name,
        max(len(t.series.runs) for t in gaps.values()),
        {axis: _spark(gaps[axis]) if axis in gaps else None for axis in shown},
        [*said, *(f"{name}: left out are {note}." for note in words.left_out(trends[0]))],
    )


def _spark(trend: Trend) -> Spark:
    series = trend.series
    level, n = series.level, len(series.level)
    parts = np.array_split(np.arange(n), min(n, MOST_POINTS))
    y = np.array([np.median(level[part]) for part in parts])
    low, high = float(y.min()), float(max(y.max(), y.min() + series.least))
    x = np.linspace(EDGE, WIDTH - EDGE, len(parts)) if len(parts) > 1 else np.array([WIDTH / 2])
    down = HEIGHT - EDGE - (y - low) / (high - low) * (HEIGHT - 2 * EDGE)
    at = [float(x[min(int(c.place * len(parts) / n), len(parts) - 1)]) for c in trend.changes]
    marks: list[Shape] = [Line(place, 0.0, place, HEIGHT, "mark") for place in at]
    shapes = (*marks, Curve(tuple(zip(x.tolist(), down.tolist(), strict=True)), "spark"), Dot(float(x[-1]), float(down[-1]), 2.0, "dot"))
    label = f"{series.name} of {series.vehicle}: {words.said(trend)}"
    factor, unit = in_degrees(1.0, series.unit)
    first = [int(part[0]) for part in parts]
    values = {
        "dive": columns.words([series.runs[i] for i in first]),
        "date": columns.words([f"{series.dates[i]:%Y-%m-%d}" for i in first]),
        f"gap in {series.name}, {unit}": columns.numbers(factor * np.array([series.value_of(value) for value in y])),
    }
    return Spark(Drawing(WIDTH, HEIGHT, label, shapes, values), quantity(words.now(trend), series.unit, 2))
