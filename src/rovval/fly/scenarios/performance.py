"""Scenario 5 (thesis 4.6): the simulator beside the vehicle under the same thruster speeds.

The tables expect nothing in particular; the errors are those of table 6.2, in m/s and deg/s.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from typing import Any

from rovval.comparison import compare
from rovval.core.data import Run
from rovval.fly.scenarios import Check, Outcome
from rovval.simulation import simulate
from rovval.vehicle.model import Vehicle


def performance(run: Run, vehicle: Vehicle, model: str) -> Outcome:
    """Compare, and judge only that a simulation of every measured axis exists."""
    comparison = compare(run, simulate(run, vehicle, model))
    rows: dict[str, Mapping[str, Any]] = {}
    for axis, error in comparison.free.items():
        turns = error.unit == "rad/s"
        mean, iae = (degrees(error.mean_error), degrees(error.iae)) if turns else (error.mean_error, error.iae)
        rows[axis] = {
            "mean_error": mean,
            "unit": "deg/s" if turns else "m/s",
            "iae": iae,
            "iae_unit": "deg" if turns else "m",
            "n": error.n,
        }
    checks = [
        Check(
            f"{axis}: simulated beside measured",
            f"mean error {r['mean_error']:+.4f} {r['unit']}, IAE {r['iae']:.2f} {r['iae_unit']}",
            None,
        )
        for axis, r in rows.items()
    ]
    checks += [Check(f"{axis}: simulated beside measured", "not measured", None) for axis in comparison.not_measured]
    return Outcome(
        5,
        "performance: simulator beside vehicle",
        vehicle.name,
        model,
        tuple(checks),
        {"run": run.id, "table_6_2": rows},
        comparison,
        comparison.sim,
        run,
    )
