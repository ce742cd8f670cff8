"""What is said of a vehicle's file that is off in many coefficients at once."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.report.diagnosis.phrases import span, value, whole

MOST = 3  # coefficients that fit a sentence


def calibration(document: Mapping[str, Any]) -> str:
    """How many coefficients are off together and which most, how far the gap shrinks with them tuned, and that this is no cause; empty where
    nothing was tuned."""
    found = document.get("calibration")
    if not found:
        return ""
    rows, beyond = found["parameters"], found["beyond"]
    most = ", ".join(f"{value(name, rows[name])} ({times(rows[name])})" for name in beyond[:MOST])
    beside = ", ".join(str(c["effect"]) for c in document.get("causes") or ())
    together = f"{len(rows)} parameters tuned together{f', {beside} among them,' if beside else ''}"
    return (
        f"No one effect{' is shown to explain the rest' if beside else ''}: {len(beyond)} coefficients of the vehicle's file are off together, "
        f"most of all {most}. With {together} the squared gap shrinks by {span(found['shrinkage'])} {held_out(found)}{_worse(found)}. "
        "This may be a badly calibrated file, or an effect that the library lacks and that many coefficients imitate: write that vehicle with "
        "`rovval fit` (the command stands in the report) and diagnose again."
    )


def times(row: Mapping[str, Any]) -> str:
    """17 times its tolerance."""
    return f"{abs(row['tolerances']):.0f} times its tolerance"


def held_out(found: Mapping[str, Any]) -> str:
    """On what the shrinkage was scored."""
    return "on runs left out of the fit" if found.get("held_out") == "runs" else "on windows left out of the fit"


def _worse(found: Mapping[str, Any]) -> str:
    rows = found.get("harm") or ()
    return f" (worse: {', '.join(f'''{h['axis']} by {whole(h['change'])} %''' for h in rows)})" if rows else ""
