"""One run of a batch as its page shows it, read off the record that the batch keeps of it (rovval.batch/1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from rovval.core.units import in_degrees
from rovval.report.common.numbers import duration, listed

Record = Mapping[str, Any]


class Gap(NamedTuple):
    """Rms error of one axis, and its unit; degrees for angles."""

    value: float
    unit: str


class Cause(NamedTuple):
    """The names that the log cannot tell apart, and the share by which the squared gap is reduced with the first (None: not told)."""

    names: str
    less: float | None


@dataclass(frozen=True, slots=True)
class Row:
    """One line of the table.

    ``gap`` by axis is of the comparison's windows, else of the diagnosis. ``report`` and ``diagnosis`` are pages, relative to the reports; what a
    batch has no step for is empty. ``beyond`` are the limits that the run exceeds, ``stops`` where its simulation left sane limits, and ``folder``
    is where its log lies below the folder of all logs.
    """

    run: str
    log: str
    vehicle: str
    duration_s: float | None
    window_s: float | None
    gap: Mapping[str, Gap]
    findings: int | str
    stops: Sequence[str]
    verdict: str
    causes: Sequence[Cause]
    report: str
    diagnosis: str
    new: bool
    beyond: Sequence[str]
    folder: str = ""

    @property
    def page(self) -> str:
        """The page that the run's name links to, "" for none."""
        return self.report or self.diagnosis

    @property
    def length(self) -> str:
        """How long the log is, in words."""
        return "" if self.duration_s is None else duration(self.duration_s)

    @property
    def state(self) -> list[tuple[str, str]]:
        """What is to be known of the run at a glance, each with its colour's name."""
        marks = [("new", "lead", self.new), ("tolerance", "neg", self.beyond), ("limits", "neg", self.stops)]
        return [(mark, css) for mark, css, holds in marks if holds]


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
        gap={axis: Gap(*in_degrees(found["rms"], found["unit"])) for axis, found in axes.items()},
        findings=(len(comparison["findings"]) if "findings" in comparison else record.get("findings", 0)) or "",
        stops=comparison.get("stops") or steps.get("simulate", {}).get("stops") or (),
        verdict=str(diagnosed.get("said") or diagnosed.get("verdict") or ""),
        causes=[_cause(c) for c in diagnosed.get("causes") or ()],
        report=_page(compared),
        diagnosis=_page(diagnosed),
        new=new,
        beyond=beyond,
    )


def _cause(cause: Mapping[str, Any]) -> Cause:
    members = dict.fromkeys([str(cause["effect"]), *cause.get("group", ())])
    return Cause(listed(members, "or"), (cause.get("shrinkage") or {}).get("total"))


def _page(step: Mapping[str, Any]) -> str:
    return next((place for place in step.get("outputs", ()) if place.endswith(".html")), "")
