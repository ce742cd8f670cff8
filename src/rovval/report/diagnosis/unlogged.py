"""The forces that nobody logged, as large as the diagnosis takes them to be in every fit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.report.common.numbers import number


def disturbances(document: Mapping[str, Any]) -> str:
    """surge 0.18 N (forgotten in 1.5 s), yaw 0.012 N m (forgotten in 0.8 s), in a sentence; empty where none was fitted."""
    rows = (document.get("disturbance") or {}).items()
    said = [f"{axis} {number(p['rms'], 2)} {p['unit']} (forgotten in {number(p['memory_s'], 2)} s)" for axis, p in rows if (p.get("rms") or 0.0) > 0.0]
    return f"Unlogged disturbances that the fit allows for, rms: {', '.join(said)}." if said else ""
