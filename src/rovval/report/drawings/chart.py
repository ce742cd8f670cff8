"""Curves against time as a drawing, and a path in three dimensions: figures that stand on paper, without a script."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rovval.core.data import Array
from rovval.report.drawings import columns
from rovval.report.drawings.columns import MOST_PLACES
from rovval.report.drawings.drawing import Curve, Dot, Drawing, Line, Shape, Text, round_up

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 560.0, 200.0, 54.0, 10.0, 34.0, 24.0  # pixels
POINTS = 350  # along the width: of what lies between two, the lowest and the highest are drawn
LEVELS = 4  # lines across
LETTER, SAMPLE = 7.0, 16.0  # pixels that a letter of a label takes, and the piece of its curve before it
ROUNDING = 1e-9  # m, deg, N, rpm: what moves less lies still


@dataclass(frozen=True, slots=True)
class Scale:
    """From a value between ``low`` and ``high`` to a pixel between ``start`` and ``end``."""

    low: float
    high: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        """The pixel of a value."""
        return self.start + (self.end - self.start) * (value - self.low) / (self.high - self.low)


def chart(title: str, unit: str, dt: float, curves: Mapping[str, Array]) -> Drawing:
    """``curves`` (n,) by their labels against time, NaN left out; eight look each their own: four colours, then dashed."""
    known = [v[np.isfinite(v)] for v in curves.values()]
    low, high = (min((float(v.min()) for v in known if len(v)), default=0.0), max((float(v.max()) for v in known if len(v)), default=0.0))
    low, high = min(low, 0.0), max(high, 0.0)
    step = round_up((high - low if high - low > ROUNDING else 1.0) / LEVELS)
    low, high = step * np.floor(low / step + 1e-9), step * np.ceil(high / step - 1e-9)
    if high <= low:
        high = low + step
    seconds = dt * max(len(v) - 1 for v in curves.values())
    x, y = Scale(0.0, seconds or 1.0, LEFT, WIDTH - RIGHT), Scale(low, high, HEIGHT - BOTTOM, TOP)
    shapes: list[Shape] = [Text(0, 13, f"{title}, {unit}", "b"), *_grid(x, y, step)]
    place = WIDTH - RIGHT
    for k, (label, values) in reversed(list(enumerate(curves.items()))):
        shapes.append(Text(place, 13, label, f"c{k % 8}", "end"))
        place -= LETTER * len(label) + 2.0
        if label:
            shapes.append(Line(place - SAMPLE, 9, place, 9, f"c{k % 8}"))
        place -= SAMPLE + 10.0
        shapes += [Curve(piece, f"c{k % 8}") for piece in pieces(np.arange(0.0, len(values)) * dt, values, x, y)]
    packed = columns.against_time(dt, {f"{label or title}, {unit}": v for label, v in curves.items()})
    return Drawing(WIDTH, HEIGHT, f"{title}, {unit}, against time", tuple(shapes), packed)


def path(title: str, position: Array, marks: Array | None = None) -> Drawing:
    """The way (n, 3) of north, east and down in metres, seen from the south-west and above; its shadow on the level of its deepest point. ``marks`` (m, 3)
    are numbered from 1."""
    known = position[np.isfinite(position).all(axis=1)]
    shadow = np.column_stack([known[:, :2], np.full(len(known), known[:, 2].max())])
    flat, ground = _seen(known), _seen(shadow)
    every = np.vstack([flat, ground])
    span = float(max(np.ptp(every, axis=0).max(), 1e-6))
    middle, size = (every.max(axis=0) + every.min(axis=0)) / 2.0, 330.0
    scale = 0.8 * size / span

    def place(points: Array) -> tuple[tuple[float, float], ...]:
        sheet = 0.5 * WIDTH + (points[:, 0] - middle[0]) * scale, 0.5 * size + 20.0 + (points[:, 1] - middle[1]) * scale
        return tuple(zip(sheet[0].tolist(), sheet[1].tolist(), strict=True))

    thin = slice(None, None, max(1, len(known) // 600))
    shapes: list[Shape] = [Text(0, 13, title, "b"), Curve(place(ground[thin]), "base"), Curve(place(flat[thin]), "c0")]
    shapes += _axes(scale, round_up(0.2 * span), size)
    start, end = place(flat[[0, -1]])
    apart = np.hypot(end[0] - start[0], end[1] - start[1]) > 4 * LETTER
    for (px, py), name in ((start, "start"), (end, "end")) if apart else ((end, "start and end"),):
        shapes += [Dot(px, py, 3, "growth-mark"), Text(px - 7, py - 5, name, "m", "end")]
    for k, (px, py) in enumerate(place(_seen(marks)) if marks is not None else ()):
        shapes += [Dot(px, py, 3, "growth-mark"), Text(px + 7, py + 4, f"{k + 1}", "m")]
    values = {f"{name}, m": columns.numbers(known[:: -(-len(known) // MOST_PLACES), j]) for j, name in enumerate(("north", "east", "down"))}
    return Drawing(WIDTH, size + 40.0, title, tuple(shapes), values)


def _axes(scale: float, unit: float, size: float) -> list[Shape]:
    """Which way is north, east and down, each ``unit`` m long, in the lower left corner, where no path is drawn."""
    x, y, shapes = 8.0, size - 40.0, list[Shape]()
    for (east, south), name in zip(scale * unit * _seen(np.eye(3)), ("north", "east", "down"), strict=True):
        shapes += [Line(x, y, x + east, y + south, "axis"), Text(x + east + 3, y + south + 4, f"{name} {unit:g} m", "m")]
    return shapes


def _seen(points: Array) -> Array:
    """North to the upper right, east to the lower right, down down, on the sheet (n, 2)."""
    c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
    return np.column_stack([c * (points[:, 0] + points[:, 1]), s * (points[:, 1] - points[:, 0]) + points[:, 2]])


def _grid(x: Scale, y: Scale, step: float) -> list[Shape]:
    shapes: list[Shape] = []
    for k in range(round((y.high - y.low) / step) + 1):
        v = y.low + k * step
        shapes += [Line(LEFT, y(v), WIDTH - RIGHT, y(v), "grid"), Text(LEFT - 6, y(v) + 4, f"{v:.4g}" if abs(v) > 1e-9 * step else "0", "m", "end")]
    tick = round_up(x.high / 6)
    for k in range(int(x.high / tick + 1e-9) + 1):
        shapes.append(Text(x(k * tick), HEIGHT - 7, f"{k * tick:g} s" if k == 0 else f"{k * tick:g}", "m", "middle"))
    return shapes


def pieces(times: Array, values: Array, x: Scale, y: Scale, points: int = POINTS) -> list[tuple[tuple[float, float], ...]]:
    """Unbroken pieces of a curve on the sheet, thinned to ``points`` along the width so that every peak stays."""
    known = np.isfinite(values)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    bucket = max(1, -(-len(values) // points))
    found = []
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        rows = np.arange(begin, end)
        if bucket > 2:
            parts = np.array_split(rows, -(-len(rows) // bucket))
            rows = np.array(sorted({int(p[f(values[p])]) for p in parts for f in (np.argmin, np.argmax)} | {begin, end - 1}))
        found.append(tuple((round(x(float(times[r])), 1), round(y(float(values[r])), 1)) for r in rows.tolist()))
    return found
