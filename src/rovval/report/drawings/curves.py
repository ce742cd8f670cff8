"""Curves for the page: packed to 16 bits a point, thinned so that every peak stays, degrees for angles."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rovval.core.data import Array

MOST_POINTS = 36002  # an hour at 10 Hz is drawn whole, so that a zoom shows every sample
MISSING = 65535


def encode(values: Array) -> dict[str, Any]:
    """Values as little-endian uint16 between their lowest and highest (error below range / 131068), NaN as 65535."""
    there = np.isfinite(values)
    low, high = (float(values[there].min()), float(values[there].max())) if there.any() else (0.0, 1.0)
    span = (high - low) or 1.0
    steps = np.round((np.where(there, values, low) - low) / span * 65534.0)
    packed = np.where(there, steps, MISSING).astype("<u2")
    return {"lo": float(f"{low:.7g}"), "hi": float(f"{low + span:.7g}"), "b": b64encode(packed.tobytes()).decode("ascii")}


def bucket(n: int) -> int:
    """Rows that share two points of a curve; 1 when all rows are drawn."""
    return 1 if n <= MOST_POINTS else -(-2 * n // MOST_POINTS)


def thin(values: Array) -> Array:
    """The lowest and the highest value of each bucket, in the order in which they came; all values of a short run."""
    k = bucket(len(values))
    if k == 1:
        return values
    rows = np.full((-(-len(values) // k), k), np.nan)
    rows.ravel()[: len(values)] = values
    there = np.isfinite(rows)
    low = np.where(there, rows, np.inf).argmin(axis=1)
    high = np.where(there, rows, -np.inf).argmax(axis=1)
    picks = np.sort(np.stack([low, high], axis=1), axis=1)
    return np.take_along_axis(rows, picks, axis=1).ravel()


def times(n: int, dt: float) -> dict[str, Any]:
    """The time axis that goes with `thin`."""
    k = bucket(n)
    return {"n": n, "t0": 0.0, "dt": dt} if k == 1 else {"n": 2 * -(-n // k), "t0": 0.0, "dt": dt * k / 2.0}


def steps(n: int, step: float, unit: str, first: float = 0.0, log: bool = False) -> dict[str, Any]:
    """An axis of something else than time: ``n`` values from ``first`` on, in ``unit``; drawn to a logarithmic scale where ``log``."""
    return {"n": n, "t0": first, "dt": step, "unit": unit, "log": log}


def series(key: str, label: str, values: Array, short: str = "", hue: int | None = None, dash: Sequence[int] = ()) -> dict[str, Any]:
    """One curve; ``key`` is its colour and its switch, or ``hue`` its colour where there are many; ``dash`` are pixels drawn and left out in turn."""
    curve: dict[str, Any] = {"key": key, "label": label, "d": encode(thin(values))}
    if short:
        curve["short"] = short
    if dash:
        curve["dash"] = list(dash)
    if hue is not None:
        curve["hue"] = hue
    return curve


def difference(key: str, label: str, values: Array, of: str, index: int) -> dict[str, Any]:
    """The curve ``index`` of the picture ``of`` less its first one, which the script takes itself; of a run that is thinned, the ``values`` of it."""
    return {"key": key, "label": label, "of": of, "index": index} if bucket(len(values)) == 1 else series(key, label, values)


Band = tuple[float, float, str]  # from, to, and what it shades: the name of its colour


def plot(
    identity: str, curves: Sequence[dict[str, Any]], x: str = "run", bands: Sequence[Band] = (), tube: float | None = None, **more: bool
) -> dict[str, Any]:  # fmt: skip
    """One picture; its place on the page is the element of that id. ``bands`` are shaded, ``tube`` is what lies within a tolerance of the first curve.
    ``bare`` leaves out the time axis, ``error`` is a strip."""
    drawn: dict[str, Any] = {"id": identity, "x": x, "series": list(curves), **more}
    return drawn | ({"bands": [list(b) for b in bands]} if bands else {}) | ({"tube": tube} if tube else {})


@dataclass(frozen=True, slots=True)
class Place:
    """Where the page shows the picture ``identity``: its heading, unit and a note beside, and under it a strip for the error if wanted."""

    identity: str
    title: str
    unit: str
    note: str = ""
    css: str = ""
    error: bool = False
