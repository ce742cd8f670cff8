"""A batch as one HTML file (templates/batch.html): what needs attention first, then a row a run."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from rovval.report.batch import nights, sparklines, table
from rovval.report.batch.row import Record, Row, row
from rovval.report.common.numbers import duration, listed
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.trend import Trend

MOST_LISTED = 200  # rows of a list above the table; summary.json has all
FAILED = ("crash", "internal")  # kinds of a quarantine record that are no refusal


def text(summary: Mapping[str, Any], records: Iterable[Record], trends: Sequence[Trend] = ()) -> str:
    """The page of a batch's summary (rovval.summary/1), of the records of its runs (rovval.batch/1), new and unchanged, and of the trends of
    their vehicles."""
    rows, aside = _rows(summary, records), summary["quarantined"]
    refused, failed = ([_aside(q) for q in aside if (q["kind"] in FAILED) == fails] for fails in (False, True))
    beyond = [{"run": r, "said": ["; ".join(r.beyond)]} for r in rows if r.beyond]
    stopped = [{"run": r, "said": [_stops(r)]} for r in rows if r.stops]
    absent, halted = summary.get("missing_sources", ()), [s for s in [summary.get("stopped_by")] if s]
    attention: dict[str, Any] = {"stop before its end": halted, "source without a log": absent}
    attention |= {"beyond a tolerance": beyond, "failed": failed, "quarantined": refused, "left sane limits in the simulation": stopped}
    columns = table.columns(rows)
    return render(
        "batch.html",
        title=f"{summary['pipeline']} · rovval batch",
        eyebrow="Batch",
        name=summary["pipeline"],
        banner="",
        said=[_verdict(len(rows), attention)],
        facts=_facts(summary),
        stopped_by=[{"log": summary["pipeline"], "said": [s["reason"], s["next"]]} for s in halted],
        missing=[{"log": m["logs"], "said": [m["why"]]} for m in absent],
        beyond=beyond,
        failed=failed,
        refused=refused,
        stopped=stopped,
        waiting=[{"log": w["log"], "said": [w["why"]]} for w in summary["waiting"]],
        most=MOST_LISTED,
        nights=nights.compared(summary),
        vehicles=sparklines.vehicles(trends),
        trend_axes=sparklines.axes(trends),
        rows=rows,
        lead=table.lead(rows),
        columns=columns,
        left=[j for j, column in enumerate(columns) if column.words],
        footer=foot("the same for programs: summary.json"),
    )


def _rows(summary: Mapping[str, Any], records: Iterable[Record]) -> list[Row]:
    """In the order of the logs."""
    new = {done["log"] for done in summary["done"]}
    beyond: dict[str, list[str]] = {}
    for exceeded in summary["tolerances_exceeded"]:
        beyond.setdefault(exceeded["log"], []).append(exceeded["limit"])
    rows = sorted((row(r, r["log"] in new, beyond.get(r["log"], ())) for r in records), key=lambda r: r.log)
    return [replace(r, folder=folder) for r, folder in zip(rows, table.folders([r.log for r in rows]), strict=True)]


def _verdict(runs: int, attention: Mapping[str, Sequence[Any]]) -> str:
    said = [f"{len(found)} {what}" for what, found in attention.items() if found]
    return f"{f'{listed(said)}.' if said else 'Nothing needs attention.'} {runs} run{'s'[: runs != 1]} in the table below."


def _facts(summary: Mapping[str, Any]) -> dict[str, Any]:
    counts = {what: str(n) for what, n in summary["counts"].items() if what not in ("tolerances_exceeded", "left_sane_limits", "missing_sources")}
    return {"ended": summary["ended"], "took": duration(summary["seconds"]), **counts, "exit code": str(summary["exit_code"])}


def _aside(q: Mapping[str, Any]) -> dict[str, Any]:
    return {"log": q["log"], "said": [q["reason"].removeprefix(f"{q['log']}: "), q["next"]]}


def _stops(row: Row) -> str:
    more = f" (and {len(row.stops) - 1} more)" if len(row.stops) > 1 else ""
    return row.stops[0] + more
