"""A batch as one HTML file (templates/batch.html): what needs attention first, then a row a run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any

from markupsafe import Markup

from rovval.report.batch import nights, sparklines, table
from rovval.report.batch.row import Record, Row, row
from rovval.report.common.numbers import duration, listed
from rovval.report.common.page import render
from rovval.report.common.versions import foot
from rovval.trend import Trend

FIRST_LISTED = 10  # rows of a list above the table that are seen at once (chosen: half a screen)
MOST_LISTED = 200  # rows of a list above the table; summary.json has all
AT_ONCE = 100  # rows of the table that are written together
ROWS = "<!-- rows -->"  # in the page, where they go; what is no markup of ours is escaped
FAILED = ("crash", "internal")  # kinds of a quarantine record that are no refusal


def text(summary: Mapping[str, Any], records: Sequence[Record], trends: Sequence[Trend] = ()) -> str:
    """The whole page; see `pieces`."""
    return "".join(pieces(summary, records, trends))


def pieces(summary: Mapping[str, Any], records: Sequence[Record], trends: Sequence[Trend] = ()) -> Iterator[str]:
    """The page of a batch's summary (rovval.summary/1), of the records of its runs (rovval.batch/1), new and unchanged, and of the trends of
    their vehicles. Its rows come some at a time, and each is made twice, since what the columns are depends on all of them."""
    seen = table.Seen()
    beyond, stopped = [], []
    for run in _rows(summary, records):
        seen.add(run)
        if run.beyond:
            beyond.append({"run": run, "said": ["; ".join(run.beyond)]})
        if run.stops:
            stopped.append({"run": run, "said": [_stops(run)]})
    columns = seen.columns()
    before, _, after = _page(summary, trends, beyond, stopped, seen, columns).partition(ROWS)
    yield before
    rows, folders = _rows(summary, records), table.folders(seen.parents)
    while some := [replace(run, folder=folders[table.parent(run.log)]) for run in islice(rows, AT_ONCE)]:
        yield render("batch_rows.html", rows=some, columns=columns)
    yield after


def _page(
    summary: Mapping[str, Any], trends: Sequence[Trend], beyond: Sequence[Any], stopped: Sequence[Any], seen: table.Seen, columns: Sequence[table.Column]
) -> str:
    """All of it but for the rows of the runs, with `ROWS` in their place."""
    aside = summary["quarantined"]
    refused, failed = ([_aside(q) for q in aside if (q["kind"] in FAILED) == fails] for fails in (False, True))
    absent, halted = summary.get("missing_sources", ()), [s for s in [summary.get("stopped_by")] if s]
    attention: dict[str, Any] = {"stop before its end": halted, "source without a log": absent}
    attention |= {"beyond a tolerance": beyond, "failed": failed, "quarantined": refused, "left sane limits in the simulation": stopped}
    return render(
        "batch.html",
        title=f"{summary['pipeline']} · rovval batch",
        eyebrow="Batch",
        name=summary["pipeline"],
        banner="",
        said=[_verdict(seen.runs, attention)],
        facts=_facts(summary),
        stopped_by=[{"log": summary["pipeline"], "said": [s["reason"], s["next"]]} for s in halted],
        missing=[{"log": m["logs"], "said": [m["why"]]} for m in absent],
        beyond=beyond,
        failed=failed,
        refused=refused,
        stopped=stopped,
        waiting=[{"log": w["log"], "said": [w["why"]]} for w in summary["waiting"]],
        first=FIRST_LISTED,
        most=MOST_LISTED,
        nights=nights.compared(summary),
        vehicles=sparklines.vehicles(trends),
        trend_axes=sparklines.axes(trends),
        runs=seen.runs,
        place_of_rows=Markup(ROWS),
        lead=seen.lead(),
        columns=columns,
        left=[j for j, column in enumerate(columns) if column.words],
        footer=foot("the same for programs: summary.json"),
    )


def _rows(summary: Mapping[str, Any], records: Sequence[Record]) -> Iterator[Row]:
    """In the order of the logs, made one by one."""
    new = {done["log"] for done in summary["done"]}
    beyond: dict[str, list[str]] = {}
    for exceeded in summary["tolerances_exceeded"]:
        beyond.setdefault(exceeded["log"], []).append(exceeded["limit"])
    logs = [record["log"] for record in records]
    for number in sorted(range(len(logs)), key=logs.__getitem__):
        yield row(records[number], logs[number] in new, beyond.get(logs[number], ()))


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
