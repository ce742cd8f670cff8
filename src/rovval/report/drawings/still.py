"""The curves of the page (`drawings.curves`) as drawings, for a page without a script: the same values, thinned so that every peak stays."""

from __future__ import annotations

from base64 import b64decode
from collections.abc import Mapping, Sequence
from math import ceil, floor
from typing import Any

import numpy as np

from rovval.core.data import Array
from rovval.report.drawings.chart import Scale, pieces
from rovval.report.drawings.curves import MISSING
from rovval.report.drawings.drawing import Box, Curve, Drawing, Line, Shape, Text, round_up

WIDTH, LEFT, RIGHT, TOP, BOTTOM = 460.0, 50.0, 8.0, 8.0, 22.0  # pixels
HEIGHT, LEVELS, POINTS = 170.0, 4, 74  # of a picture: pixels, lines across, and points along the width: without a script there is no zoom
STRIP_HEIGHT, STRIP_LEVELS, STRIP_POINTS = 70.0, 2, 60  # the same of a strip of errors


def still(identity: str, plots: Sequence[Mapping[str, Any]], axes: Mapping[str, Any]) -> Drawing:
    """One picture of `curves.plot` among all ``plots`` of a page, over one of its ``axes``."""
    by_id = {plot["id"]: plot for plot in plots}
    plot = by_id[identity]
    x = axes[plot["x"]]
    times, curves = abscissa(x), [_values(s, by_id) for s in plot["series"]]
    tube = [curves[0] + k * plot["tube"] for k in (1.0, -1.0)] if plot.get("tube") else []
    height, levels, points = (STRIP_HEIGHT, STRIP_LEVELS, STRIP_POINTS) if plot.get("error") else (HEIGHT, LEVELS, POINTS)
    place = np.log10(times) if x.get("log") else times
    across = Scale(float(place[0]), max(float(place[-1]), float(place[0]) + 1e-9), LEFT, WIDTH - RIGHT)
    up, step = _up([*curves, *tube], height, levels)
    shapes: list[Shape] = [_shade(across, height, *band) for band in plot.get("bands", ())]
    shapes += [*_levels(up, step), *([] if plot.get("bare") else _ticks(across, height, x))]
    shapes += [Curve(piece, "tube") for edge in tube for piece in pieces(place, edge, across, up, points)]
    for series, values in zip(plot["series"], curves, strict=True):
        shapes += [Curve(piece, f"k-{series['key']}", series.get("hue")) for piece in pieces(place, values, across, up, points)]
    return Drawing(WIDTH, height, ", ".join(s["label"] for s in plot["series"]), tuple(shapes))


def _values(series: Mapping[str, Any], plots: Mapping[str, Any]) -> Array:
    if "d" in series:
        return decode(series["d"])
    others = plots[series["of"]]["series"]
    return np.asarray(decode(others[series["index"]]["d"]) - decode(others[0]["d"]))


def decode(encoded: Mapping[str, Any]) -> Array:
    """What `curves.encode` packed."""
    steps = np.frombuffer(b64decode(encoded["b"]), "<u2")
    return np.where(steps == MISSING, np.nan, encoded["lo"] + steps * (encoded["hi"] - encoded["lo"]) / 65534.0)


def abscissa(x: Mapping[str, Any]) -> Array:
    """The values of an axis, packed or as its first, step and number."""
    return decode(x) if "b" in x else np.asarray(x["t0"] + x["dt"] * np.arange(x["n"]), dtype=np.float64)


def _up(curves: list[Array], height: float, levels: int) -> tuple[Scale, float]:
    """The scale of the values, from one round level to another, and the step between them."""
    known = np.concatenate([c[np.isfinite(c)] for c in curves] or [np.zeros(1)])
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    step = round_up(((high - low) or abs(high) or 1.0) / levels)
    return Scale(step * floor(low / step + 1e-9), step * max(ceil(high / step - 1e-9), floor(low / step + 1e-9) + 1), height - BOTTOM, TOP), step


def _levels(scale: Scale, step: float) -> list[Shape]:
    shapes: list[Shape] = []
    for k in range(round((scale.high - scale.low) / step) + 1):
        value = scale.low + k * step
        words = f"{value:.4g}" if abs(value) > 1e-9 * step else "0"
        shapes += [Line(LEFT, scale(value), WIDTH - RIGHT, scale(value), "grid"), Text(LEFT - 6, scale(value) + 4, words, "m", "end")]
    return shapes


def _ticks(across: Scale, height: float, x: Mapping[str, Any]) -> list[Shape]:
    """Round values below the picture, the last of them with the unit."""
    if x.get("log"):
        values = [(float(k), f"{10.0**k:g}") for k in range(ceil(across.low - 1e-9), floor(across.high + 1e-9) + 1)]
    else:
        step = round_up((across.high - across.low) / 5)
        values = [(k * step, f"{k * step:g}") for k in range(ceil(across.low / step - 1e-9), floor(across.high / step + 1e-9) + 1)]
    last, words = values.pop()
    shapes: list[Shape] = [Text(across(value), height - 6, word, "m", "middle") for value, word in values]
    return [*shapes, Text(across(last), height - 6, f"{words} {x.get('unit', 's')}", "m", "end")]


def _shade(across: Scale, height: float, start: float, end: float, key: str) -> Box:
    left, right = (min(max(across(v), LEFT), WIDTH - RIGHT) for v in (start, end))
    return Box(left, TOP, max(right - left, 1.5 if start == end else 0.0), height - TOP - BOTTOM, f"s-{key}")
