"""A flight as JSON: what was flown, how set-points were held and way points passed, and the spread over tolerances. SI and radians."""

from __future__ import annotations

from typing import Any

import numpy as np

from rovval.core.data import Array
from rovval.fly.dry_run import DryRun
from rovval.fly.flight import QUANTILES, Flight

SCHEMA = "rovval.flight/1"


def document(flight: Flight) -> dict[str, Any]:
    """The whole document; ``draws`` of a held set-point or a way point is None without draws."""
    return {
        "schema": SCHEMA, "mission": flight.mission.name, "title": flight.mission.title, "vehicle": flight.vehicle, "vehicle_hash": flight.vehicle_hash,
        "model": flight.model, "effects": list(flight.effects), "seed": flight.seed, "seconds": (len(flight) - 1) * flight.dt,
        "loop": "sensors" if flight.on_sensors else "true state", "noise": flight.noise,
        "legs": [{"leg": p.label, "start_s": p.start_s, "end_s": p.end_s} for p in flight.phases],
        "held": [
            {"leg": h.leg, "quantity": h.quantity, "unit": h.unit, "set_point": h.set_point, "step": h.step, "error": h.error, "overshoot": h.overshoot,
             "settled_s": h.settled_s, "draws": spread(h.draws)}
            for h in flight.held
        ],
        "way_points": [
            {"leg": p.leg, "point": list(p.point), "distance_m": p.distance, "at_s": p.at_s, "draws": spread(p.draws)} for p in flight.passed
        ],
        "saturated_share": float(flight.saturated().mean()), "draws": flight.draws, "draws_stopped": flight.draws_stopped, "stops": list(flight.stops),
        "notes": list(flight.notes),
    }  # fmt: skip


def spread(values: Array | None) -> dict[str, float] | None:
    """Quantiles and the largest size of what the draws ended with; None without draws."""
    if values is None or not len(values):
        return None
    named = {f"q{round(100 * q):02d}": float(v) for q, v in zip(QUANTILES, np.quantile(values, QUANTILES), strict=True)}
    return named | {"worst": float(np.abs(values).max())}


def dry_run_document(dry: DryRun) -> dict[str, Any]:
    """A timeline and what it would exceed."""
    return {
        "schema": "rovval.dry_run/1", "mission": dry.mission, "vehicle": dry.vehicle, "seconds": dry.duration_s,
        "timeline": [{"start_s": e.start_s, "end_s": e.end_s, "leg": e.label, "does": e.does, "exceeds": list(e.exceeds)} for e in dry.entries],
    }  # fmt: skip
