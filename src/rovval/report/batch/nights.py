"""This night beside the one before."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.report.common.numbers import listed

ATTENTION = ("quarantined", "tolerances_exceeded", "left_sane_limits")
MOST_NAMED = 5


def compared(summary: Mapping[str, Any]) -> dict[str, Any] | None:
    """The counts of both nights, and which logs need attention since this night or no longer; None where no night was before."""
    before = summary.get("night_before")
    if not before:
        return None
    now = {row["log"] for part in ATTENTION for row in summary[part]}
    then = set(before["attention"])
    counts = [(what.replace("_", " "), n, before["counts"].get(what, 0)) for what, n in summary["counts"].items() if n or before["counts"].get(what)]
    said = [("Needs attention since this night", now - then), ("No longer", then - now)]
    return {"lead": f"The batch before ended {before['ended']}.", "counts": counts, "said": [f"{what}: {_named(logs)}." for what, logs in said if logs]}


def _named(logs: set[str]) -> str:
    names = sorted(logs)
    return listed([*names[:MOST_NAMED], *([f"{len(names) - MOST_NAMED} more"] if len(names) > MOST_NAMED else [])])
