"""One run of a batch as its page shows it, read off the record that the batch keeps of it (rovval.batch/1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Record = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Row:
    """``gap`` is rms and unit by axis: of the comparison's windows, else of the diagnosis. ``report`` and ``diagnosis`` are pages,
    relative to the reports; what a batch has no step for is empty. ``beyond`` are the limits that it exceeds."""

    run: str
    log: str
    vehicle: str
    duration_s: float | None
    window_s: float | None
    gap: Mapping[str, tuple[float, str]]
    findings: int
    stops: Sequence[str]
    verdict: str
    causes: Sequence[Mapping[str, Any]]
    report: str
    diagnosis: str
    new: bool
    beyond: Sequence[str]


def row(record: Record, new: bool, beyond: Sequence[str]) -> Row:
    """The row of one record."""
    steps = record["steps"]
    compared, diagnosed = steps.get("compare", {}), steps.get("diagnose", {})
    comparison = compared.get("comparison", {})
    window = comparison.get("window", {})
    axes = window.get("axes") or diagnosed.get("gap") or {}
    return Row(
        run=record["run"],
        log=record["log"],
        vehicle=str(comparison.get("vehicle") or diagnosed.get("vehicle") or record.get("vehicle") or ""),
        duration_s=record.get("duration_s"),
        window_s=window.get("seconds"),
        gap={axis: (found["rms"], found["unit"]) for axis, found in axes.items()},
        findings=len(comparison["findings"]) if "findings" in comparison else record.get("findings", 0),
        stops=comparison.get("stops") or steps.get("simulate", {}).get("stops") or (),
        verdict=str(diagnosed.get("said") or diagnosed.get("verdict") or ""),
        causes=diagnosed.get("causes") or (),
        report=_page(compared),
        diagnosis=_page(diagnosed),
        new=new,
        beyond=beyond,
    )


def _page(step: Mapping[str, Any]) -> str:
    return next((place for place in step.get("outputs", ()) if place.endswith(".html")), "")
