"""The track from above, measured and simulated, and how far the simulated position is from the measured one along the run."""

from __future__ import annotations

from typing import Any

import numpy as np

from rovval.core.data import Array, Comparison
from rovval.report.drawings import columns, curves
from rovval.report.drawings.curves import Place
from rovval.report.drawings.drawing import Curve, Dot, Drawing, Line, Shape, Text, round_up

SIDE, MARGIN = 460.0, 34.0  # pixels: as wide as a picture of curves
POINTS = 700  # of a track
LEAD = (
    "North up. The free run adds up all that it has wrong since its start; a window starts on the measured track. Beside: the horizontal distance from "
    "the measured position."
)


def plan(c: Comparison) -> Drawing | None:
    """The tracks seen from above, to one scale; None where no position was measured."""
    if not (c.run.measured("x") and c.run.measured("y")):
        return None
    measured = c.run.stack(("x", "y"))
    tracks = {"k-measured": measured, "k-free": c.sim.free.eta[:, :2], "k-windowed": _lifted(c.sim.windowed.eta[:, :2], c.sim.windowed.stretch)}
    known = np.concatenate([t[np.isfinite(t).all(axis=1)] for t in tracks.values()])
    middle, (north, east) = 0.5 * (known.min(axis=0) + known.max(axis=0)), np.maximum(np.ptp(known, axis=0), 1.0).tolist()
    scale = (SIDE - 2 * MARGIN) / max(north, east)
    height = scale * north + 2 * MARGIN

    def at(points: Array) -> Array:
        """Pixels (n, 2): east to the right, north up."""
        return np.column_stack([SIDE / 2 + scale * (points[:, 1] - middle[1]), height / 2 - scale * (points[:, 0] - middle[0])])

    shapes: list[Shape] = [Curve(piece, css) for css, track in tracks.items() for piece in _pieces(at(track))]
    there = measured[np.isfinite(measured).all(axis=1)]
    for words, (x, y) in zip(("start", "end"), at(there[[0, -1]]).tolist(), strict=True):
        shapes += [Dot(x, y, 3.5, "growth-mark"), Text(x + 7, y + (14 if words == "start" else -6), words, "m")]
    rule = round_up(max(north, east) / 6)
    shapes += [Line(8, height - 4, 8 + rule * scale, height - 4, "rule"), Text(8, height - 10, f"{rule:g} m", "m")]
    named = {f"{css.removeprefix('k-')}, {way}, m": track[:, j] for css, track in tracks.items() for j, way in enumerate(("north", "east"))}
    return Drawing(SIDE, height, "Tracks seen from above, north up", tuple(shapes), columns.along(c.run.dt, named))


def error(c: Comparison) -> tuple[list[dict[str, Any]], list[Place]]:
    """Horizontal distance of the simulated from the measured position; nothing where no position was measured."""
    if not (c.run.measured("x") and c.run.measured("y")):
        return [], []
    measured = c.run.stack(("x", "y"))
    free, windowed = (np.linalg.norm(t.eta[:, :2] - measured, axis=1) for t in (c.sim.free, c.sim.windowed))
    lines = [curves.series("free", "free run", free), curves.series("windowed", "windows", windowed)]
    note = "" if c.track is None else f"{c.track.ate:.3g} m rms in space, free run"
    return [curves.plot("track", lines)], [Place("track", "distance from the measured position", "m", note)]


def _lifted(track: Array, stretch: np.ndarray) -> Array:
    """A track that is lifted off the paper where a window begins."""
    cut = np.r_[False, stretch[1:] != stretch[:-1]]
    return np.where(cut[:, None], np.nan, track)


def _pieces(points: Array) -> list[tuple[tuple[float, float], ...]]:
    """Unbroken pieces of a track, of at most `POINTS` points in all."""
    known = np.isfinite(points).all(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], known, [False]]).astype(int)))
    step = max(1, len(points) // POINTS)
    pieces = (np.append(np.arange(a, b - 1, step), b - 1) for a, b in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
    return [tuple((round(x, 1), round(y, 1)) for x, y in points[rows].tolist()) for rows in pieces]
