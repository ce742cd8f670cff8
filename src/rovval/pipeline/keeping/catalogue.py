"""What the records of a batch put into the catalogue: one row a run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from datetime import datetime
from typing import Any

from rovval.core.channels import AXES
from rovval.pipeline import tolerances
from rovval.pipeline.planning.config import Pipeline
from rovval.storage import lock, places
from rovval.storage.atomic import sweep

Record = Mapping[str, Any]
NO_VEHICLE = "unknown"  # of a run that was only ingested, by a profile that names none


def enter(pipeline: Pipeline, records: Iterable[Record], now: datetime) -> list[str]:
    """Put every record of a batch, new or unchanged, into the catalogue of its archive, so that a row that was lost comes back.

    Returns what of the catalogue was damaged and set aside. Raises `UsageProblem` where it cannot be written.
    """
    from rovval.storage import catalogue

    with lock.held(pipeline.archive / catalogue.FOLDER, wait=True):
        sweep(pipeline.archive / catalogue.FOLDER)
        reports = places.name_from(pipeline.archive, pipeline.reports)
        return catalogue.update(pipeline.archive, (_row(pipeline.name, reports, record) for record in records), now)


def unusual(pipeline: Pipeline, done: Iterable[Record]) -> list[dict[str, str]]:
    """The runs that this batch has ``done`` and whose gap exceeds a tolerance over dives (``trend.surge=3``), each with the sentence that says so. Only
    the last dives of a vehicle are held against those before them: after an update of rovval the whole archive is done."""
    limits = tolerances.parse_trends(pipeline.tolerances)
    if not limits:
        return []
    from rovval.trend import recent
    from rovval.trend.series import all_series

    logs, found = {record["run"]: record["log"] for record in done}, []
    for series in all_series(rows_of(pipeline)):
        if series.of == "gap" and (sigmas := limits.get(series.name)):
            most = recent.limits(series, sigmas)
            for before, (run, value) in list(enumerate(zip(series.runs, series.values, strict=True)))[-recent.DIVES :]:
                if run in logs and value > most.get(run, value):
                    of = f"{sigmas:g} sigma above the {min(before, recent.DIVES)} dives before it"
                    said = f"trend.{series.name}: {value:.4g} {series.unit} is above the limit {most[run]:.4g}, {of}"
                    found.append({"log": logs[run], "run": run, "limit": said})
    return found


def rows_of(pipeline: Pipeline) -> list[dict[str, Any]]:
    """The rows of the catalogue that this pipeline entered, with the columns that `rovval.trend` follows."""
    from rovval.storage import catalogue
    from rovval.trend.series import COLUMNS

    return catalogue.load(pipeline.archive, COLUMNS).filter(pipeline=pipeline.name).to_dicts()


def _row(pipeline: str, reports: str, record: Record) -> dict[str, Any]:
    """The columns of `rovval.storage.catalogue` that a record (rovval.batch/1) fills; the links lead from the archive, from which the
    ``reports`` are called so."""
    steps = record["steps"]
    compared, diagnosed = steps.get("compare", {}), steps.get("diagnose", {})
    comparison = compared.get("comparison", {})
    gap = comparison.get("window", {}).get("axes") or diagnosed.get("gap") or {}
    causes = [_cause(cause) for cause in diagnosed.get("causes") or ()]
    return {
        "pipeline": pipeline,
        **{name: record.get(name) for name in ("run", "log", "sha256", "dated_by", "duration_s", "model", "rovval", "method")},
        "vehicle": comparison.get("vehicle") or diagnosed.get("vehicle") or record.get("vehicle") or NO_VEHICLE,
        "date": datetime.fromisoformat(record["began"]),
        **{axis: gap.get(axis, {}).get("rms") for axis in AXES},
        "verdict": diagnosed.get("verdict"),
        "cause": causes[0]["effect"] if causes else None,
        "causes": causes,
        "findings": [": ".join((f["code"], f["where"], f["detail"])) for f in comparison.get("findings", ())] or steps.get("ingest", {}).get("findings") or [],
        "stops": list(comparison.get("stops") or steps.get("simulate", {}).get("stops") or ()),
        "code": [step["code"] for step in steps.values()][-1],
        "report": _page(reports, compared),
        "diagnosis": _page(reports, diagnosed),
    }


def _cause(cause: Mapping[str, Any]) -> dict[str, Any]:
    sizes = [{"name": name, **{k: p.get(k) for k in ("value", "low", "high", "unit")}} for name, p in cause.get("parameters", {}).items()]
    return {
        "effect": cause["effect"],
        "kind": cause.get("kind", "effect"),
        "group": list(cause.get("group", ())),
        "probability": cause.get("probability"),
        "shrinkage": (cause.get("shrinkage") or {}).get("total"),
        "parameters": sizes,
    }


def _page(reports: str, step: Mapping[str, Any]) -> str | None:
    page = next((place for place in step.get("outputs", ()) if place.endswith(".html")), None)
    return page and f"{reports}/{page}".removeprefix("./")
