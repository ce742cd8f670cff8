"""The whole run before and after: measured, nominal and corrected motion in windows, with the regime that holds most of an axis's gap shaded, and onsets."""

from __future__ import annotations

from typing import Any

import numpy as np

from rovval.core.channels import AXES, VELOCITIES
from rovval.core.data import Comparison, SimResult
from rovval.core.units import in_degrees
from rovval.diagnose.result.diagnosis import Diagnosis
from rovval.report.diagnosis.sentences.plain import holds, regime, titled
from rovval.report.drawings import curves
from rovval.report.drawings.curves import Band, Place

JOINED_S = 2.0  # chosen: shaded stretches that are nearer to each other are drawn as one


def drawn(d: Diagnosis, c: Comparison, corrected: SimResult | None) -> tuple[dict[str, Any], list[dict[str, Any]], list[Place]]:
    """The axis of time, what the script draws, and where: every axis of the windows of ``c``, with ``corrected`` if there is any."""
    pictures, places = list[dict[str, Any]](), list[Place]()
    for j, (axis, name) in enumerate(zip(AXES, VELOCITIES, strict=True)):
        row = c.windowed.get(axis)
        if row is None:
            continue
        factor, unit = in_degrees(1.0, row.unit)
        motions = {"nominal": c.sim.windowed.nu[:, j]} | ({"corrected": corrected.windowed.nu[:, j]} if corrected else {})
        measured = c.run.get(name) * factor
        lines = [curves.series("measured", "measured", measured), *(curves.series(k, k, v * factor) for k, v in motions.items())]
        errors = [curves.difference(k, k, v * factor - measured, f"w-{axis}", n) for n, (k, v) in enumerate(motions.items(), 1)]
        shaded, said = _bands(d, c, axis)
        pictures += [curves.plot(f"w-{axis}", lines, bands=shaded, bare=True), curves.plot(f"w-{axis}-error", errors, bands=shaded, error=True)]
        places.append(Place(f"w-{axis}", axis, unit, said, error=True))
    return {"run": curves.times(len(c.run), c.run.dt)}, pictures, places


def _bands(d: Diagnosis, c: Comparison, axis: str) -> tuple[list[Band], str]:
    """What is shaded and marked on an axis, and the words for it."""
    bands, said = list[Band](), list[str]()
    worst = next((s.regime for s in d.gap.where if s.axis == axis), "")
    flags = holds(c.run, worst) if worst else None
    if flags is not None and flags.any():
        edges = np.flatnonzero(np.diff(np.r_[False, flags, False].astype(int))).reshape(-1, 2) * c.run.dt
        apart = np.r_[True, edges[1:, 0] - edges[:-1, 1] >= JOINED_S]
        ends = np.r_[apart[1:], True]
        bands += [(round(float(a), 2), round(float(b), 2), "shade") for a, b in zip(edges[apart, 0], edges[ends, 1], strict=True)]
        said.append(f"shaded: {regime(worst)}")
    for cause in d.causes:
        if cause.onset_s is not None:
            bands.append((cause.onset_s, cause.onset_s, "onset"))
            said.append(f"line: {titled(cause.effect)} begins")
    return bands, "; ".join(said)
