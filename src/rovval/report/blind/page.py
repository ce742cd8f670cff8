"""The score as an HTML page in the look of the other reports, and as text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.report.blind import tables as score_tables
from rovval.report.blind.tables import COLUMNS, short
from rovval.report.common import page

DEFINITIONS = (
    "Top-1: the first cause named, or where none is named the first of the ranking, is the planted effect or one of its few aliases.",
    "One named: share right among logs with one effect where the answer names one effect and its group holds no other.",
    "Group: the truth is among the at most three names given. Errors: named and not planted, plus planted and not named.",
    "Found: any verdict but no_gap; on null logs this is the false alarm. Blamed: a library effect is named.",
    "Left out: the true effect, with all of its targets and every law that does its work, is taken out of the library; right is `unknown`.",
    "Distinguishable: the true effect, fitted to the log, closes at least a tenth of the gap on held-out windows.",
    "Oracle: share of the gap that the true effect closes, fitted to the log. x: severity. In brackets: the axis or thruster.",
    "/oracle: shrinkage over that of the true effect. Intervals are 90 %: Wilson for shares, bootstrap for the rest.",
    "Probability on the truth: the stated one for the first name; 0.8 of the rest over its group; the remainder over the library.",
)

_STRATA = "Reported apart and never averaged. Small print: 90 % interval, and the logs that a mark is about where they are not all."
_SIMPLE = "Share of logs in which the first name is the planted effect."


def text(result: Mapping[str, Any]) -> str:
    """Strata and headline marks as a table of plain text."""
    width = max(len(name) for name in result["strata"]) + 1
    lines = [f"{'stratum':<{width}}{'n':>5}" + "".join(f"{head:>11}" for head in COLUMNS.values())]
    for name, row in result["strata"].items():
        cells = "".join(f"{short(mark, row.get(mark)):>11}" for mark in COLUMNS)
        lines.append(f"{name:<{width}}{row['n']:>5}{cells}")
    return "\n".join(
        [_title(result), "", *lines, "", f"{len(result['wrong'])} answers wrong; all marks with intervals: score.html"]
    )


def html(result: Mapping[str, Any]) -> str:
    """The whole page."""
    strata = result["strata"]
    banner = "SYNTHETIC DATA: logs of an independent plant"
    body = page.head("rovval blind check", f"{result['vehicle']}: withheld effects", banner, _verdict(strata), _facts(result))
    body += page.section("Kinds of logs", score_tables.headline(strata), lead=_STRATA)
    body += page.section("Beside simple methods: the right effect first", score_tables.simple(strata, known=True), lead=_SIMPLE)
    body += page.section("Beside simple methods: an effect named where none of the library is right", score_tables.simple(strata, known=False))
    body += page.section("Wrong answers", score_tables.wrong(result["wrong"]), lead="By kind; within a kind the most visible effect first.")
    body += page.section("What the marks mean", page.listing(DEFINITIONS))
    body += page.section("All marks", *(score_tables.marks(name, row) for name, row in strata.items()))
    body += page.section("Unsealings so far", score_tables.past(result.get("unsealings", [])))
    return page.page(_title(result), body + page.footer(f"rovval {result['rovval']}, engine {result['engine']}"), {})


def _verdict(strata: Mapping[str, Any]) -> list[str]:
    """What a reader wants first: how often the effect is right, how often a healthy log is blamed, and of how many logs."""
    name = "single, distinguishable" if "single, distinguishable" in strata else "single"
    said = []
    if (single := strata.get(name)) and "top_1" in single:
        kind = "logs with one effect that can be seen in them" if name != "single" else "logs with one effect"
        said.append(f"The right effect comes first in {score_tables.long('top_1', single['top_1'])} of {single['n']} {kind}.")
    if (null := strata.get("null")) and "detected" in null:
        said.append(f"A gap is claimed in {score_tables.long('detected', null['detected'])} of {null['n']} healthy logs.")
    for name, words in (("foreign", "logs with an effect outside the library"), ("left out", "logs whose effect was taken out of the library")):
        if (row := strata.get(name)) and "blamed" in row:
            said.append(f"A wrong effect of the library is blamed in {score_tables.long('blamed', row['blamed'])} of {row['n']} {words}.")
    return said or ["No log was scored."]


def _facts(result: Mapping[str, Any]) -> dict[str, Any]:
    """What was scored; of the digests as much as tells two apart."""
    digests = {f"{name} sha256": str(result.get(f"{name}_sha256") or "")[:12] for name in ("labels", "answers")}
    times = {name: str(result.get(name) or "")[:16].replace("T", " ") for name in ("committed", "opened")}
    return {"logs": len(result["logs"]), **{name: result.get(name) for name in ("size", "seed", "engine")}, **times, **digests}


def _title(result: Mapping[str, Any]) -> str:
    return f"Blind check: {result['vehicle']}, seed {result['seed']}, {len(result['logs'])} logs, engine {result['engine']}"
