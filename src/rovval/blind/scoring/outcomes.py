"""What an answer says first, with which probability, whether that is so, and the counts that targets are set for.

An answer says one of: a cause (the first named), ``healthy``, ``something_else`` or ``file``. A cause is right where it, and nothing of another kind, was
planted; ``healthy`` where nothing was; ``something_else`` where the library lacks what was, or it was taken out; ``file``, many coefficients off at
once, is planted by no plant and never right. Logs with effects that nobody could see in them (known ones by the fit of their own form, `oracle`, others by
the same flight without them, `twin`) are counted apart: neither answer is wrong there.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any

from rovval.blind.scoring.calibration import calibration, skill_of_kinds
from rovval.blind.scoring.intervals import Number, exact
from rovval.diagnose import Diagnosis

Row = Mapping[str, Any]
SEEN, SURE = 0.10, 3.0  # share of the gap above noise that the true effect's fit must close, and its standard errors, for an effect to count as visible
KINDS = ("healthy", "causes", "something_else")  # that a log can truly be of
WORDS = {  # count -> its words, in the order of the page
    "single_found": "visible single effects named, or in the group",
    "single_first": "visible single effects named first",
    "single_other": "visible single effects for which another name is given",
    "single_silent": "visible single effects with nothing named",
    "healthy_blamed": "healthy logs blamed",
    "healthy_alarm": "healthy logs with a gap claimed",
    "lacking_blamed": "effects that the library lacks blamed on one that it has",
    "two_both": "both of two visible effects named",
    "two_one": "one or both of two visible effects named",
}


def said(diagnosis: Diagnosis) -> tuple[str, float | None]:
    """What the answer says first and its stated probability; None in documents that state none."""
    if diagnosis.causes:
        return diagnosis.causes[0].effect, diagnosis.causes[0].probability
    belief = diagnosis.probabilities
    if diagnosis.verdict == "no_gap":
        return "healthy", belief.healthy if belief else None
    if belief and belief.miscalibrated_file > belief.something_else:
        return "file", belief.miscalibrated_file
    return "something_else", belief.something_else if belief else None


def true_kind(row: Row) -> str:
    """Which kind of model the log is truly of."""
    if row["left_out"] or any(row["foreign"]):
        return "something_else"
    return "causes" if row["truth"] else "healthy"


def visible(row: Row, best: Mapping[str, float]) -> bool:
    """Whether what was planted could be seen: each known effect's own fit closes `SEEN` of the gap above noise, surely, or the twin without what the library
    lacks has so much less of a gap. True where nothing was planted, or no twin was asked."""
    if true_kind(row) == "healthy" or (true_kind(row) != "causes" and not best):
        return True
    above = 1.0 - float(row.get("noise") or 0.0)
    closed = best.get("each", 0.0) if len(row["truth"]) > 1 else best.get("seen", 0.0)
    return bool(closed >= SEEN * above and best.get("sure", SURE) >= SURE)


def is_right(row: Row) -> bool:
    """Whether what is said first is so."""
    kind = true_kind(row)
    return bool(row["top_1"]) if row["named"] and kind == "causes" else row["said"] == kind


def reliability(rows: Sequence[Row]) -> dict[str, Any]:
    """`calibration` of the first thing said over logs that could be told, with the log score of the kinds of model, and who was left out."""
    stated = [row for row in rows if row.get("p_said") is not None]
    counted = [row for row in stated if row["visible"]]
    found = calibration([row["p_said"] for row in counted], [is_right(row) for row in counted])
    kinds = {kind: calibration([row["p_kinds"][kind] for row in counted], [true_kind(row) == kind for row in counted]) for kind in KINDS}
    brief = {kind: {key: row[key] for key in ("brier", "skill", "calibration_error")} for kind, row in kinds.items() if row["n"]}
    together = skill_of_kinds([row["p_kinds"] for row in counted], [true_kind(row) for row in counted])
    return found | {"kinds": brief, "kinds_together": together, "not_visible": len(stated) - len(counted), "without_probabilities": len(rows) - len(stated)}


def counts(rows: Sequence[Row]) -> dict[str, Number]:
    """The counts of `WORDS`, each with its 90 % interval; failed answers are silent."""
    kind = {name: [row for row in rows if true_kind(row) == name] for name in KINDS}
    single = [row for row in kind["causes"] if len(row["truth"]) == 1 and row["visible"]]
    two = [row for row in kind["causes"] if len(row["truth"]) == 2 and row["visible"]]
    return {
        "single_found": exact([bool(row.get("truth_named")) or bool(row.get("right_when_named")) for row in single]),
        "single_first": exact([bool(row["named"]) and bool(row.get("top_1")) for row in single]),
        "single_other": exact([_other(row) for row in single]),
        "single_silent": exact([not row["named"] for row in single]),
        "healthy_blamed": exact([bool(row["named"]) for row in kind["healthy"]]),
        "healthy_alarm": exact([bool(row.get("detected")) for row in kind["healthy"]]),
        "lacking_blamed": exact([bool(row["named"]) for row in kind["something_else"]]),
        "two_both": exact([bool(row.get("all_found")) for row in two]),
        "two_one": exact([bool(row.get("right_when_named")) for row in two]),
    }


def _other(row: Row) -> bool:
    """Something is named, and not the truth, alone or in the group."""
    return bool(row["named"]) and not row.get("truth_named") and not row.get("right_when_named")


def by_effect(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """A row for each vehicle and single effect (target left out): logs, visible ones, of these named or in the group, another name, silent."""
    found: dict[tuple[str, str], list[Row]] = defaultdict(list)
    for row in rows:
        if len(row["truth"]) == 1:
            found[row["vehicle"], row["truth"][0].partition("[")[0]].append(row)
    table = []
    for (vehicle, effect), logs in sorted(found.items()):
        lacking = true_kind(logs[0]) == "something_else"
        seen = [row for row in logs if row["visible"]]
        named = sum(not _other(row) and bool(row["named"]) for row in seen) if not lacking else 0
        other = sum(bool(row["named"]) if lacking else _other(row) for row in seen)
        table.append({
            "vehicle": vehicle, "effect": effect, "lacking": lacking, "logs": len(logs), "visible": len(seen), "found": named, "other": other,
            "silent": sum(not row["named"] for row in seen),
        })  # fmt: skip
    return table


def summed(rows: Sequence[Row]) -> dict[str, Any]:
    """All of this file over some logs."""
    return {"logs": len(rows), "counts": counts(rows), "reliability": reliability(rows), "by_effect": by_effect(rows)}
