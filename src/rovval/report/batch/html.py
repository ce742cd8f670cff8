"""A batch as one HTML file: what needs attention first, then a row a run. It has no script: 5000 runs stay light."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from rovval.report.batch import table as batch_table
from rovval.report.batch.row import Record, Row, row
from rovval.report.common import page
from rovval.report.common.words import duration, listed
from rovval.report.comparison.json import versions

MOST = 200  # rows of a list above the table; summary.json has all
FAILED = ("crash", "internal")  # kinds of a quarantine record that are no refusal


def text(summary: Mapping[str, Any], records: Sequence[Record]) -> str:
    """The page of a batch's summary (rovval.summary/1) and of the records of its runs (rovval.batch/1), new and unchanged."""
    rows, aside = _rows(summary, records), summary["quarantined"]
    refused, failed = ([q for q in aside if (q["kind"] in FAILED) == fails] for fails in (False, True))
    beyond, stopped = [r for r in rows if r.beyond], [r for r in rows if r.stops]
    attention = {"beyond a tolerance": beyond, "failed": failed, "quarantined": refused, "left sane limits in the simulation": stopped}
    body = "".join(
        [
            page.head("Batch", summary["pipeline"], "", [_verdict(len(rows), attention)], _facts(summary)),
            _told("Tolerance exceeded", ("run", "what"), [(batch_table.link(r), escape("; ".join(r.beyond))) for r in beyond]),
            _told("Failed", ("log", "what happened", "next"), [_aside(q) for q in failed], _FAILED),
            _told("Quarantined", ("log", "reason", "next"), [_aside(q) for q in refused], _REFUSED),
            _told("Simulation left sane limits", ("run", "where"), [(batch_table.link(r), _stops(r)) for r in stopped]),
            _told("Waiting", ("log", "why"), [(escape(w["log"]), escape(w["why"])) for w in summary["waiting"]]),
            page.section(f"Runs ({len(rows)})", batch_table.table(rows), lead=batch_table.lead(rows)),
            page.footer(" · ".join(f"{k} {v}" for k, v in versions().items()) + " · the same for programs: summary.json"),
        ]
    )
    return page.page(f"{summary['pipeline']} · rovval batch", body, None)


_FAILED = "Perhaps no fault of the log: the next run tries again. The traceback, if there is one, stands in quarantine/."
_REFUSED = "They lie where they were, and are tried again when they change, or with --retry."


def _rows(summary: Mapping[str, Any], records: Sequence[Record]) -> list[Row]:
    new = {done["log"] for done in summary["done"]}
    beyond: dict[str, list[str]] = {}
    for exceeded in summary["tolerances_exceeded"]:
        beyond.setdefault(exceeded["log"], []).append(exceeded["limit"])
    rows = [row(record, record["log"] in new, beyond.get(record["log"], ())) for record in records]
    return sorted(rows, key=lambda r: r.log)


def _verdict(runs: int, attention: Mapping[str, Sequence[Any]]) -> str:
    said = [f"{len(found)} {what}" for what, found in attention.items() if found]
    return f"{f'{listed(said)}.' if said else 'Nothing needs attention.'} {runs} run{'s'[: runs != 1]} in the table below."


def _facts(summary: Mapping[str, Any]) -> dict[str, Any]:
    counts = {what: str(n) for what, n in summary["counts"].items() if what not in ("tolerances_exceeded", "left_sane_limits")}
    return {"ended": summary["ended"], "took": duration(summary["seconds"]), **counts, "exit code": str(summary["exit_code"])}


def _told(title: str, header: Sequence[str], rows: Sequence[Sequence[str]], lead: str = "") -> str:
    if not rows:
        return ""
    more = [f"and {len(rows) - MOST} more: see summary.json"] if len(rows) > MOST else []
    told = page.table(header, rows[:MOST], "told", left=range(len(header)))
    return page.section(f"{title} ({len(rows)})", told, page.listing(more), lead=lead)


def _aside(q: Mapping[str, Any]) -> tuple[str, str, str]:
    return escape(q["log"]), escape(q["reason"].removeprefix(f"{q['log']}: ")), escape(q["next"])


def _stops(row: Row) -> str:
    more = f" (and {len(row.stops) - 1} more)" if len(row.stops) > 1 else ""
    return escape(row.stops[0] + more)
