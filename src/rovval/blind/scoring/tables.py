"""Marks of many logs into numbers with intervals, stratum by stratum, and what the simple methods reach on the same logs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from rovval.blind.scoring import ground_truth
from rovval.blind.scoring.intervals import Number, mean, median, share

Row = Mapping[str, Any]
SHARES = {  # mark -> its words
    "detected": "something found",
    "blamed": "a library effect named",
    "fully_blamed": "explained by a library effect",
    "said_unknown": "said unknown",
    "top_1": "first of the ranking or of the causes is right",
    "named_one": "named a single effect",
    "right_when_one_named": "right when a single effect is named",
    "right_when_named": "right when causes are named",
    "group_hit": "truth in the group, where one is named",
    "truth_named": "truth in a group that is named, silence counted as a miss",
    "all_found": "every one of several effects named",
    "axis": "axis right",
    "regime": "regime right",
}
MEANS = {
    "group_size": "size of the group",
    "p_truth": "probability on the truth",
    "log_score": "log score",
    "errors": "classification errors",
}
MEANS |= {"share_found": "share of effects found", "cpu_s": "CPU seconds a log"}
MEDIANS = {
    "onset_error_s": "onset error, s",
    "shrinkage": "shrinkage",
    "of_oracle": "shrinkage over the oracle's",
    "oracle": "oracle's shrinkage",
}


def table(rows: Sequence[Row]) -> dict[str, dict[str, Any]]:
    """Stratum -> mark -> number with its interval; strata in a fixed order, empty marks left out."""
    names = sorted({s for row in rows for s in row["strata"]}, key=_order)
    return {name: _stratum([row for row in rows if name in row["strata"]]) for name in names}


def _stratum(rows: Sequence[Row]) -> dict[str, Any]:
    found: dict[str, Any] = {"n": len(rows)}
    kinds: Iterable[tuple[dict[str, str], Callable[[Sequence[float]], Number]]] = (
        (SHARES, share),
        (MEANS, mean),
        (MEDIANS, median),
    )
    for marks, how in kinds:
        for mark in marks:
            values = [row[mark] for row in rows if row.get(mark) is not None]
            if values:
                found[mark] = how(values)
    numbers = [p for row in rows for p in row["parameters"]]
    if numbers:
        found["parameter_error"] = median([p["error"] for p in numbers])
        found["coverage_90"] = share([p["covered"] for p in numbers])
    return found | {"floors": _baselines(rows)}


def _baselines(rows: Sequence[Row]) -> dict[str, Number]:
    """Top-1 of each simple method where there is a known effect, else how often it names one; guesses by arithmetic."""
    found = {}
    for method in sorted({m for row in rows for m in row["floors"]}):
        found[method] = share([row["floors"][method] for row in rows if method in row["floors"]])
    one = [row for row in rows if len(row["truth"]) == 1 and not row["left_out"] and row.get("top_1") is not None]
    if one:
        found["uniform guess"] = share([1.0 / max(row["library"], 1) for row in one])
        commonest = Counter(row["truth"][0] for row in one).most_common(1)[0][0]
        found["commonest effect"] = share([row["truth"][0] == commonest for row in one])
    return found


def confusions(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Every log whose answer is wrong, the largest oracle's share first."""
    wrong = [
        {
            "log": row["log"],
            "mission": row["mission"],
            "truth": [f"{t} x{s:g}" for t, s in zip(row["truth"], row["severity"], strict=True)],
            "left_out": row["left_out"],
            "verdict": row["verdict"],
            "named": row["named"],
            "group": row["group"],
            "said": row.get("said"),
            "probability": row.get("p_said"),
            "visible": row.get("visible"),
            "shrinkage": row.get("shrinkage"),
            "oracle": row.get("oracle"),
            "kind": kind,
        }
        for row in rows
        if (kind := error_kind(row))
    ]
    return sorted(wrong, key=lambda w: (w["kind"], -(w["oracle"] or 0.0)))


def error_kind(row: Row) -> str:
    """What is wrong with an answer, "" where nothing is."""
    if row["verdict"] == "failed":
        return "failed"
    if row["left_out"] or any(row["foreign"]):
        return "blamed" if row["blamed"] else "missed" if not row["detected"] else ""
    if not row["truth"]:
        return "false alarm" if row["detected"] else ""
    if not row["named"]:
        return "missed" if not row["detected"] else "unknown"
    if not row["right_when_named"]:
        return "confused, in group" if row["group_hit"] else "confused"
    return "" if row["errors"] == 0 else "not all or too many"


def _order(stratum: str) -> tuple[int, str]:
    heads = ("null", "single", "two", "three", "foreign", "left out")
    return next((i for i, head in enumerate(heads) if stratum.startswith(head)), len(heads)), stratum


def names_of(label: Mapping[str, Any]) -> list[str]:
    """Names of what was planted, as the library has them."""
    return [ground_truth.name(e) for e in label["effects"]]
