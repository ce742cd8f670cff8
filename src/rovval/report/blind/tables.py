"""The tables of the score's page: kinds of logs, simple methods beside, every mark, wrong answers, unsealings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from rovval.blind.scoring import tables
from rovval.report.common import page
from rovval.report.common.words import number

COLUMNS = {  # mark -> heading of the text's table
    "top_1": "top-1", "right_when_one_named": "one named", "group_hit": "group", "truth_named": "named", "all_found": "all named",
    "group_size": "size", "errors": "errors", "detected": "found", "blamed": "blamed", "said_unknown": "unknown",
    "axis": "axis", "of_oracle": "/oracle", "cpu_s": "CPU s",
}  # fmt: skip
PERCENT = {*tables.SHARES, "coverage_90", "share_found"}
ONE_VALUE = ("uniform guess", "commonest effect")  # by arithmetic: no interval
VERDICTS = {"no_gap": "no gap", "partly_explained": "partly explained"}


def headline(strata: Mapping[str, Any]) -> str:
    """The main kinds of logs, and the finer ones folded away."""
    fine = [name for name in strata if "," in name and not name.endswith("distinguishable")]
    main = _headline({name: row for name, row in strata.items() if name not in fine})
    rest = _headline({name: strata[name] for name in fine}) if fine else ""
    return main + _folded(f"By mission, form, severity and place: {len(fine)} finer kinds", rest)


def simple(strata: Mapping[str, Any], known: bool) -> str:
    """rovval beside the simple methods, on kinds of logs with a known effect or on those without."""
    mark = "top_1" if known else "blamed"
    chosen = {name: row for name, row in strata.items() if row["floors"] and ("top_1" in row) == known}
    methods = list(dict.fromkeys(m for row in chosen.values() for m in row["floors"]))
    if not known:
        methods = [m for m in methods if m not in ONE_VALUE]

    def table(names: Sequence[str]) -> str:
        rows = [
            [escape(name), str(chosen[name]["n"]), _cell(mark, chosen[name].get(mark)), *(_floor(m, chosen[name]["floors"].get(m)) for m in methods)]
            for name in names
        ]
        return page.table(["kind", "logs", "rovval", *map(escape, methods)], rows) if rows else ""

    fine = [name for name in chosen if "," in name and not name.endswith("distinguishable")]
    return table([name for name in chosen if name not in fine]) + _folded("Finer kinds", table(fine))


def marks(name: str, row: Mapping[str, Any]) -> str:
    """Every mark of one kind of logs, folded away."""
    words = {
        **tables.SHARES,
        **tables.MEANS,
        **tables.MEDIANS,
        "parameter_error": "relative error of parameters",
        "coverage_90": "90 % intervals that hold the truth",
    }
    cells = [[escape(label), _cell(mark, row[mark]), str(row[mark]["n"])] for mark, label in words.items() if mark in row]
    return _folded(f"{name}: {row['n']} logs", page.table(["mark", "value", "counted"], cells))


def wrong(rows: Sequence[Mapping[str, Any]]) -> str:
    """A row an answer that is wrong."""

    def cells(w: Mapping[str, Any]) -> list[str]:
        true = ", ".join(w["truth"]) + (" (left out)" if w["left_out"] else "")
        best = "–" if w["oracle"] is None else f"{100 * w['oracle']:.0f} %"
        verdict = VERDICTS.get(w["verdict"], w["verdict"])
        log = str(w["log"]).removesuffix(".csv")
        words = [w["kind"], true or "nothing", w["mission"], verdict, " or ".join(w["group"]) or "–", best, log]
        return [escape(str(x)) for x in words]

    heads = ["fault", "planted x severity", "mission", "verdict", "named", "oracle", "log"]
    return page.table(heads, map(cells, rows), left=range(7)) if rows else ""


def past(rows: Sequence[Mapping[str, Any]]) -> str:
    """Every unsealing, the oldest first."""
    lines = [[str(r["opened"])[:16].replace("T", " "), str(r["seed"]), str(r["size"]), r["vehicle"], str(r["logs"]), r["engine"]] for r in rows]
    return page.table(["opened", "seed", "size", "vehicle", "logs", "engine"], lines, left=range(6)) if lines else ""


def short(mark: str, value: Mapping[str, Any] | None) -> str:
    """The number alone: 83 %, 1.2; "" where there is none."""
    if value is None or value["value"] is None:
        return ""
    return f"{100 * value['value']:.0f} %" if mark in PERCENT else number(value["value"], 2)


def long(mark: str, value: Mapping[str, Any] | None) -> str:
    """The number with its interval: 83 % (69 to 91)."""
    return f"{short(mark, value)} ({_span(mark, value)})" if value is not None and value["value"] is not None else "none"


def _headline(strata: Mapping[str, Any]) -> str:
    used = [m for m in COLUMNS if m != "cpu_s" and any(m in row for row in strata.values())]
    rows = [[escape(name), str(row["n"]), *(_cell(m, row.get(m), row["n"]) for m in used)] for name, row in strata.items()]
    return page.table(["kind", "logs", *(COLUMNS[m] for m in used)], rows)


def _folded(title: str, content: str) -> str:
    return f"<details><summary>{escape(title)}</summary>{content}</details>" if content else ""


def _floor(method: str, value: Mapping[str, Any] | None) -> str:
    return short("top_1", value) or "–" if method in ONE_VALUE else _cell("top_1", value)


def _cell(mark: str, value: Mapping[str, Any] | None, logs: int | None = None) -> str:
    if value is None or value["value"] is None:
        return "–"
    of = f"<small>of {value['n']}</small>" if logs is not None and value["n"] != logs else ""
    return f"{short(mark, value)}<small>{_span(mark, value)}</small>{of}"


def _span(mark: str, value: Mapping[str, Any]) -> str:
    if mark in PERCENT:
        return f"{100 * value['low']:.0f} to {100 * value['high']:.0f}"
    return f"{number(value['low'], 2)} to {number(value['high'], 2)}"
