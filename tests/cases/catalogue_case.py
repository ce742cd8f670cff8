"""Rows of the catalogue of runs, without any simulation."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

from rovval.core.channels import AXES

BEGAN = datetime(2026, 3, 2, 6, tzinfo=UTC)
NOW = datetime(2026, 11, 1, tzinfo=UTC)


def row(number: int = 0, **changed: Any) -> dict[str, Any]:
    """The row of dive ``number`` of Merlin, one a day."""
    parameter = {"name": "loss", "value": 0.3, "low": 0.2, "high": 0.4, "unit": "1"}
    cause = {"effect": "inflow_loss", "kind": "effect", "group": ["inflow_loss"], "probability": 0.9, "shrinkage": 0.66, "parameters": [parameter]}
    return {
        "pipeline": "nightly", "run": f"d{number:05}-ab", "log": f"/logs/d{number:05}.csv", "sha256": f"{number:064x}", "dated_by": "stamps",
        "date": BEGAN + timedelta(days=number), "duration_s": 600.0, "model": "fossen", **dict.fromkeys(AXES, 0.05), "verdict": "explained",
        "cause": "inflow_loss", "causes": [cause], "findings": ["gap: u: 3 s"], "stops": [], "rovval": "0.1.0", "code": "c", "method": "m",
        "report": f"../reports/d{number:05}/comparison/report.html", "diagnosis": None, "vehicle": "merlin",
    } | changed  # fmt: skip
