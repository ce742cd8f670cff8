"""The comparison for machines: schema rovval.comparison/1 of the design, with what a reader needs to trust the numbers."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from rovval.comparison import CORE, metrics
from rovval.comparison.error_growth import HORIZONS_S, error_growth
from rovval.core.data import ChannelError, Comparison
from rovval.core.units import DEGREE_UNITS, DEGREES, integral_unit
from rovval.report.common.versions import versions
from rovval.report.comparison import uncertainty, words

SCHEMA = "rovval.comparison/1"


def document(comparison: Comparison) -> dict[str, Any]:
    """The comparison as a dictionary for JSON. Errors are simulated minus measured; degrees beside radians as ``*_deg``."""
    run, sim, c = comparison.run, comparison.sim, comparison
    return {
        "schema": SCHEMA,
        "run": run.id,
        "vehicle": sim.vehicle,
        "model": sim.model,
        "verdict": words.verdict(c),
        "synthetic": run.properties.get("synthetic"),
        "axes": {axis: _row(row) for axis, row in c.free.items()},
        "window": {
            "seconds": _whole(sim.window_s),
            "longest_s": words.longest_s(c),
            "axes": {axis: {"rms": row.rmse, **_row(row)} for axis, row in c.windowed.items()},
            "pose": {name: _row(row) for name, row in c.pose.items()},
            "horizon": _horizons(c),
        },
        "track": asdict(c.track) if c.track else None,
        "validation": uncertainty.document(c),
        "not_measured": list(c.not_measured),
        "other": {"name": c.other_name, "axes": {a: _row(r) for a, r in c.other.items()}} if c.other else None,
        "effects": list(sim.effects),
        "vehicle_hash": sim.vehicle_hash,
        "input_source": sim.input_source,
        "assumptions": list(sim.assumptions),
        "stops": list(sim.stops),
        "notes": words.notes(c),
        "source": {"file": run.source, "sha256": run.sha256, "profile": run.profile, "t0_ns": run.t0_ns},
        "duration_s": run.duration_s,
        "rows": len(run),
        "rate_hz": 1.0 / run.dt,
        "clock": asdict(run.clock),
        "findings": [asdict(f) for f in run.findings],
        "resampled": {name: asdict(r) for name, r in run.resampled.items()},
        "properties": dict(run.properties),
        "versions": dict(versions()),
    }


def text(document: Mapping[str, Any]) -> str:
    """The document as JSON text; a NaN in it is a bug and is refused."""
    return json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _row(row: ChannelError) -> dict[str, Any]:
    values: dict[str, Any] = {
        "unit": row.unit,
        **{name: getattr(row, name) for name in CORE},
        "n": row.n,
        "coverage": row.coverage,
        "iae_unit": integral_unit(row.unit),
        "baseline_mae": row.baseline_mae,
        "baseline_rmse": row.baseline_rmse,
        "skill": row.skill,
        "noise": row.noise,
        "intervals": {name: {"low": low, "high": high} for name, (low, high) in row.intervals.items()},
        **row.extra,
    }
    if row.unit in DEGREE_UNITS:
        values["unit_deg"] = DEGREE_UNITS[row.unit]
        names = [n for n in (*CORE, "baseline_mae", "baseline_rmse", *row.extra) if _has_unit(n)] + ["noise"]
        values |= {f"{n}_deg": values[n] * DEGREES for n in names}
    return values


def _has_unit(name: str) -> bool:
    metric = name.removeprefix("baseline_").removeprefix("ours_windowed_").removeprefix("ours_")
    return metric in metrics.names() and metrics.get(metric).unit not in ("1", "s")


def _horizons(comparison: Comparison) -> dict[str, Any]:
    """RMS error at 1, 2, 5 and 10 s from the windows' starts (or at the last step before)."""
    result = {}
    for axis, curve in error_growth(comparison).items():
        points = [point for s in HORIZONS_S if (point := curve.at(s)) is not None]
        result[axis] = {"seconds": [t for t, _ in points], "rms": [rms for _, rms in points]}
    return result


def _whole(value: float) -> float | int:
    return int(value) if value == int(value) else value
