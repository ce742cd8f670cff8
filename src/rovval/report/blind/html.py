"""The score of a blind check as an HTML page (templates/blind.html)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rovval.report.blind.honesty import sums
from rovval.report.blind.marks import COLUMNS, LABELS, Mark, long, mark, title
from rovval.report.common.numbers import MISSING, per_cent
from rovval.report.common.page import render

DEFINITIONS = (
    "Top-1: the first cause named, or where none is named the first of the ranking, is the planted effect or one of its few aliases.",
    "One named: share right among logs with one effect where the answer names one effect and its group holds no other.",
    "Group: the truth is among the at most three names given. Errors: named and not planted, plus planted and not named.",
    "Found: any verdict but no_gap; on null logs this is the false alarm. Blamed: a library effect is named.",
    "Left out: the true effect, with all of its targets and every law that does its work, is taken out of the library; right is `unknown`.",
    "Distinguishable: the true effect, fitted to the log, reduces the squared gap on held-out windows by at least a tenth.",
    "Oracle: share by which the true effect, fitted to the log, reduces the squared gap. x: severity. In brackets: the axis or thruster.",
    "/oracle: shrinkage over that of the true effect. Intervals are 90 %: Wilson for shares, bootstrap for the rest.",
    "Probability on the truth: the stated one for the first name; 0.8 of the rest over its group; the remainder over the library.",
)
ONE_VALUE = ("uniform guess", "commonest effect")  # by arithmetic: no interval
VERDICTS = {"no_gap": "no gap", "partly_explained": "partly explained"}

Strata = Mapping[str, Mapping[str, Any]]  # kind of logs -> marks


def text(result: Mapping[str, Any]) -> str:
    """The whole page."""
    strata: Strata = result["strata"]
    return render(
        "blind.html",
        title=title(result),
        eyebrow="rovval blind check",
        name=f"{result['vehicle']}: withheld effects",
        banner="SYNTHETIC DATA: logs of an independent plant",
        said=_verdict(strata),
        facts=_facts(result),
        headline=_split(strata, _headline),
        known=_split(*_beside(strata, known=True)),
        unknown=_split(*_beside(strata, known=False)),
        sums=sums(result["summed"]),
        wrong=[_wrong(w) for w in result["wrong"]],
        definitions=DEFINITIONS,
        all=[{"name": name, "logs": row["n"], "marks": [(label, mark(m, row[m])) for m, label in LABELS.items() if m in row]} for name, row in strata.items()],
        past=[_unsealing(r) for r in result.get("unsealings", [])],
        footer=f"rovval {result['rovval']}, engine {result['engine']}",
    )


def _verdict(strata: Strata) -> list[str]:
    """What a reader wants first: how often the effect is right, how often a healthy log is blamed, and of how many logs."""
    name = "single, distinguishable" if "single, distinguishable" in strata else "single"
    said = []
    if (single := strata.get(name)) and "top_1" in single:
        kind = "logs with one effect that can be seen in them" if name != "single" else "logs with one effect"
        said.append(f"The right effect comes first in {long('top_1', single['top_1'])} of {single['n']} {kind}.")
    if (null := strata.get("null")) and "detected" in null:
        said.append(f"A gap is claimed in {long('detected', null['detected'])} of {null['n']} healthy logs.")
    for name, words in (("foreign", "logs with an effect outside the library"), ("left out", "logs whose effect was taken out of the library")):
        if (row := strata.get(name)) and "blamed" in row:
            said.append(f"A wrong effect of the library is blamed in {long('blamed', row['blamed'])} of {row['n']} {words}.")
    return said or ["No log was scored."]


def _facts(result: Mapping[str, Any]) -> dict[str, Any]:
    """What was scored; of the digests as much as tells two apart."""
    digests = {f"{name} sha256": str(result.get(f"{name}_sha256") or "")[:12] for name in ("labels", "answers")}
    times = {name: _minute(result.get(name)) for name in ("committed", "opened")}
    return {"logs": len(result["logs"]), **{name: result.get(name) for name in ("plant", "size", "seed", "engine")}, **times, **digests}


def _split(strata: Strata, table: Any) -> dict[str, Any]:
    """The table of the main kinds of logs and that of the finer ones, by mission, form, severity and place."""
    fine = [name for name in strata if "," in name and not name.endswith("distinguishable")]
    return {"main": table({n: row for n, row in strata.items() if n not in fine}), "fine": table({n: strata[n] for n in fine})}


def _headline(strata: Strata) -> dict[str, Any]:
    """The headline marks that some of the kinds have."""
    used = [m for m in COLUMNS if m != "cpu_s" and any(m in row for row in strata.values())]
    rows = [{"name": name, "logs": row["n"], "marks": [mark(m, row.get(m)) for m in used]} for name, row in strata.items()]
    return {"headings": [COLUMNS[m] for m in used], "rows": rows, "counted": True}


def _beside(strata: Strata, known: bool) -> tuple[Strata, Any]:
    """rovval beside the simple methods, on kinds of logs with a ``known`` effect or on those without; the kinds, and what makes their table."""
    name = "top_1" if known else "blamed"
    chosen = {kind: row for kind, row in strata.items() if row["floors"] and ("top_1" in row) == known}
    methods = [m for m in dict.fromkeys(m for row in chosen.values() for m in row["floors"]) if known or m not in ONE_VALUE]

    def table(kinds: Strata) -> dict[str, Any]:
        rows = [
            {"name": kind, "logs": row["n"], "marks": [mark(name, row.get(name)), *(_simple(m, row["floors"].get(m)) for m in methods)]}
            for kind, row in kinds.items()
        ]
        return {"headings": ["rovval", *methods], "rows": rows, "counted": False}

    return chosen, table


def _simple(method: str, value: Mapping[str, Any] | None) -> Mark | None:
    found = mark("top_1", value)
    return Mark(found.value, "", found.n) if found and method in ONE_VALUE else found


def _wrong(w: Mapping[str, Any]) -> list[str]:
    """An answer that is wrong, as a row of words."""
    true = ", ".join(w["truth"]) + (" (left out)" if w["left_out"] else "")
    verdict, named = VERDICTS.get(w["verdict"], w["verdict"]), " or ".join(w["group"]) or MISSING
    if w.get("visible") is False:
        true += " (not visible)"
    stated = MISSING if w["probability"] is None else f"{w['probability']:.2f}"
    return [w["kind"], true or "nothing", w["mission"], verdict, named, stated, per_cent(w["oracle"]), str(w["log"]).removesuffix(".csv")]


def _unsealing(r: Mapping[str, Any]) -> list[str]:
    return [_minute(r["opened"]), *(str(r[k]) for k in ("seed", "size", "vehicle", "logs", "engine"))]


def _minute(stamp: Any) -> str:
    """An ISO time stamp to the minute, as people read it."""
    return str(stamp or "")[:16].replace("T", " ")
