"""The score as an HTML page in the look of the other reports, and as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from rovval.blind import tables
from rovval.report import page

COLUMNS = {  # mark -> heading of the text's table
    "top_1": "top-1", "right_when_one_named": "one named", "group_hit": "group", "group_size": "size", "errors": "errors",
    "detected": "found", "blamed": "blamed", "said_unknown": "unknown", "axis": "axis", "of_oracle": "/oracle", "cpu_s": "CPU s",
}  # fmt: skip
PERCENT = {*tables.SHARES, "coverage_90", "share_found"}
DEFINITIONS = (
    "Top-1: the first cause named, or where none is named the first of the ranking, is the planted effect or one of its few aliases.",
    "One named: share right among logs with one effect where the answer names one effect and its group holds no other.",
    "Group: the truth is among the at most three names given. Errors: named and not planted, plus planted and not named.",
    "Found: any verdict but no_gap; on null logs this is the false alarm. Blamed: a library effect is named.",
    "Left out: the true effect, with all of its targets and laws that contain it, is taken out of the library; right is `unknown`.",
    "Distinguishable: the true effect, fitted to the log, closes at least a tenth of the gap on held-out windows.",
    "/oracle: shrinkage over that of the true effect. Intervals are 90 %: Wilson for shares, bootstrap for the rest.",
    "Probability on the truth: the stated one for the first name; 0.8 of the rest over its group; the remainder over the library.",
)


def text(result: Mapping[str, Any]) -> str:
    """Strata and headline marks as a table of plain text."""
    width = max(len(name) for name in result["strata"]) + 1
    lines = [f"{'stratum':<{width}}{'n':>5}" + "".join(f"{head:>11}" for head in COLUMNS.values())]
    for name, row in result["strata"].items():
        cells = "".join(f"{_short(mark, row.get(mark)):>11}" for mark in COLUMNS)
        lines.append(f"{name:<{width}}{row['n']:>5}{cells}")
    return "\n".join(
        [_title(result), "", *lines, "", f"{len(result['wrong'])} answers wrong; all marks with intervals: score.html"]
    )


def html(result: Mapping[str, Any]) -> str:
    """The whole page."""
    strata = result["strata"]
    facts = {
        name: result.get(name) for name in ("seed", "size", "engine", "committed", "opened", "labels_sha256", "answers_sha256")
    }
    single = strata.get("single, distinguishable", strata.get("single", {}))
    verdict = [
        f"{_long('top_1', single.get('top_1'))} of distinguishable single effects are named first.",
        f"Something is found in {_long('detected', strata.get('null', {}).get('detected'))} of healthy logs.",
    ]
    body = page.head(
        "rovval blind check", f"{result['vehicle']}: withheld effects", "Synthetic logs of an independent plant", verdict, facts
    )
    body += page.section("Strata", _headline(strata), lead="Reported apart and never averaged. Intervals in small print.")
    body += page.section(
        "Simple methods on the same logs",
        _simple(strata),
        lead="Top-1 as above; on logs without a known effect, how often a method names one.",
    )
    body += page.section("All marks", *(_marks(name, row) for name, row in strata.items()))
    body += page.section("Wrong answers", _wrong(result["wrong"]), lead="In order of kind, the most visible first.")
    body += page.section("Definitions", page.listing(DEFINITIONS))
    body += page.section("Unsealings so far", _past(result.get("unsealings", [])))
    return page.page(_title(result), body + page.footer(f"rovval {result['rovval']}, engine {result['engine']}"), {})


def _title(result: Mapping[str, Any]) -> str:
    return f"Blind check: {result['vehicle']}, seed {result['seed']}, {len(result['logs'])} logs, engine {result['engine']}"


def _headline(strata: Mapping[str, Any]) -> str:
    rows = [[escape(name), str(row["n"]), *(_cell(m, row.get(m)) for m in COLUMNS)] for name, row in strata.items()]
    return page.table(["stratum", "logs", *COLUMNS.values()], rows)


def _simple(strata: Mapping[str, Any]) -> str:
    methods = list(dict.fromkeys(m for row in strata.values() for m in row["floors"]))
    rows = [
        [escape(name), _cell("top_1", row.get("top_1")), *(_cell("top_1", row["floors"].get(m)) for m in methods)]
        for name, row in strata.items()
        if row["floors"]
    ]
    return page.table(["stratum", "rovval", *map(escape, methods)], rows) if rows else ""


def _marks(name: str, row: Mapping[str, Any]) -> str:
    words = {
        **tables.SHARES,
        **tables.MEANS,
        **tables.MEDIANS,
        "parameter_error": "relative error of parameters",
        "coverage_90": "90 % intervals that hold the truth",
    }
    cells = [[escape(label), _cell(mark, row[mark]), str(row[mark]["n"])] for mark, label in words.items() if mark in row]
    return f"<h3>{escape(name)}</h3>" + page.table(["mark", "value", "logs"], cells)


def _wrong(rows: Sequence[Mapping[str, Any]]) -> str:
    def cells(w: Mapping[str, Any]) -> list[str]:
        true = ", ".join(w["truth"]) + (" (left out)" if w["left_out"] else "")
        best = "" if w["oracle"] is None else f"{w['oracle']:.2f}"
        return [
            escape(w["kind"]),
            escape(true or "nothing"),
            w["mission"],
            w["verdict"],
            escape(" / ".join(w["group"])),
            best,
            w["log"],
        ]

    return (
        page.table(["kind", "truth", "mission", "verdict", "named", "oracle", "log"], map(cells, rows), left=range(7))
        if rows
        else ""
    )


def _past(rows: Sequence[Mapping[str, Any]]) -> str:
    lines = [[r["opened"], str(r["seed"]), str(r["size"]), r["vehicle"], str(r["logs"]), r["engine"]] for r in rows]
    return page.table(["opened", "seed", "size", "vehicle", "logs", "engine"], lines, left=range(6)) if lines else ""


def _short(mark: str, number: Mapping[str, Any] | None) -> str:
    if number is None or number["value"] is None:
        return ""
    return f"{100 * number['value']:.0f} %" if mark in PERCENT else f"{number['value']:.2g}"


def _long(mark: str, number: Mapping[str, Any] | None) -> str:
    if number is None or number["value"] is None:
        return "none"
    scale, unit = (100.0, " %") if mark in PERCENT else (1.0, "")
    return f"{scale * number['value']:.3g}{unit} ({scale * number['low']:.3g} to {scale * number['high']:.3g})"


def _cell(mark: str, number: Mapping[str, Any] | None) -> str:
    if number is None or number["value"] is None:
        return "–"
    scale = 100.0 if mark in PERCENT else 1.0
    return f"{_short(mark, number)}<small>{scale * number['low']:.3g} to {scale * number['high']:.3g}</small>"
