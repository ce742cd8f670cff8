"""One log's marks: its label against its answer. Definitions stand beside each mark; `score` averages them over strata."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from itertools import permutations
from math import log
from pathlib import Path
from typing import Any

from rovval.blind.scoring import ground_truth
from rovval.blind.scoring.true_values import true_values
from rovval.diagnose import Diagnosis
from rovval.diagnose.result.diagnosis import Cause
from rovval.vehicle.model import Vehicle

IN_GROUP = 0.8  # of what the first name leaves: the share of probability that the other members of its group are given
LEAST_PROBABILITY = 1e-3  # probability on the truth is never counted lower, so that a log score stays finite
LARGEST_GROUP = 3  # names of a confusion group that count


def score_log(
    label: Mapping[str, Any], answer: Mapping[str, Any], oracle: Mapping[str, float], vehicle: Vehicle, path: Path
) -> dict[str, Any]:
    """Everything that can be said about one log. Marks that do not apply are None."""
    effects = label["effects"]
    if "failed" in answer:
        return _failed(label, answer)
    diagnosis = Diagnosis.read(answer["document"])
    causes, ranking = diagnosis.causes, diagnosis.ranking
    known = [e for e in effects if not ground_truth.foreign(e)] if not label["left_out"] else []
    pairs = _paired(known, causes)
    first = causes[0] if causes else ground_truth.Member(ranking[0].effect if ranking else "")
    one = known[0] if len(known) == 1 else None
    group = [ground_truth.Member(n, causes[0].onset_s if n == causes[0].effect else None) for n in causes[0].group[:LARGEST_GROUP]] if causes else []
    shrinkage, best = diagnosis.shrinkage.total, oracle.get("dynamic")
    found: dict[str, Any] = {
        "verdict": diagnosis.verdict,
        "named": [c.effect for c in causes],
        "group": [g.effect for g in group],
        "probability": causes[0].probability if causes else None,
        "detected": diagnosis.verdict != "no_gap",
        "blamed": bool(causes),
        "fully_blamed": diagnosis.verdict == "explained",
        "said_unknown": diagnosis.verdict == "unknown",
        "top_1": any(ground_truth.accepts(e, first) for e in known) if known else None,
        "named_one": len(causes) > 0 and len(group) == 1,
        "right_when_named": bool(pairs) if known and causes else None,
        "right_when_one_named": ground_truth.accepts(known[0], causes[0]) if one and causes and len(group) == 1 else None,
        "group_hit": any(ground_truth.accepts(e, g) for e in known for g in group) if known and causes else None,
        "truth_named": any(ground_truth.accepts(one, g) for g in group) if one else None,
        "group_size": len(group) if causes else None,
        "p_truth": _p_truth(one, causes, group, len(ranking)) if one else None,
        "errors": len(causes) + len(effects if not label["left_out"] else []) - 2 * len(pairs),
        "share_found": len(pairs) / len(known) if known else None,
        "all_found": len(pairs) == len(known) if len(known) > 1 else None,
        "axis": _axis(label, diagnosis, path),
        "regime": _regime(label, diagnosis),
        "onset_error_s": _onset(pairs),
        "shrinkage": shrinkage,
        "oracle": best,
        "of_oracle": min(shrinkage / best, 1.5) if best is not None and best >= 0.1 and known and causes else None,
        "cpu_s": answer["cpu_s"],
    }
    found["log_score"] = log(max(found["p_truth"], LEAST_PROBABILITY)) if found["p_truth"] is not None else None
    found["parameters"] = [row for e, c in pairs for row in _numbers(e, c, vehicle)]
    found["floors"] = {
        method: any(ground_truth.accepts(e, ground_truth.Member(name)) for e in known) if known else bool(name)
        for method, name in answer["floors"].items()
    }  # on a log without a known effect: whether it names one all the same
    return found


def _failed(label: Mapping[str, Any], answer: Mapping[str, Any]) -> dict[str, Any]:
    known = [e for e in label["effects"] if not ground_truth.foreign(e)] if not label["left_out"] else []
    none: dict[str, Any] = {
        "verdict": "failed",
        "named": [],
        "group": [],
        "failed": answer["failed"],
        "parameters": [],
        "floors": {},
    }
    missed: dict[str, Any] = {"top_1": False if known else None, "truth_named": False if len(known) == 1 else None}
    missed |= {"all_found": False if len(known) > 1 else None}
    return none | missed | {"errors": len(label["effects"]), "cpu_s": answer["cpu_s"]}


def _paired(known: Sequence[ground_truth.Row], causes: Sequence[Cause]) -> list[tuple[ground_truth.Row, Cause]]:
    """The largest matching of planted effects and causes; each is used once."""
    best: list[tuple[ground_truth.Row, Cause]] = []
    if len(known) <= len(causes):
        matchings = [list(zip(known, order, strict=True)) for order in permutations(causes, len(known))]
    else:
        matchings = [list(zip(order, causes, strict=True)) for order in permutations(known, len(causes))]
    for both in matchings:
        right = [(e, c) for e, c in both if ground_truth.accepts(e, c)]
        best = max(best, right, key=len)
    return best


def _p_truth(effect: ground_truth.Row, causes: Sequence[Cause], group: Sequence[ground_truth.Member], library: int) -> float:
    """The answer's probability of the truth: the stated one for the first name; `IN_GROUP` of the rest over its group, what then
    remains over the library; an answer that names nothing says 1 / library."""
    if not causes:
        return 1.0 / max(library, 1)
    stated = causes[0].probability
    if ground_truth.accepts(effect, causes[0]):
        return stated
    inside = IN_GROUP if len(group) > 1 else 0.0
    if any(ground_truth.accepts(effect, g) for g in group):
        return (1.0 - stated) * inside / (len(group) - 1)
    return (1.0 - stated) * (1.0 - inside) / max(library - len(group), 1)


def _axis(label: Mapping[str, Any], diagnosis: Diagnosis, path: Path) -> bool | None:
    """Whether the unknown force's first axis, or else the worst slice's, is one that an effect acts on."""
    where = diagnosis.gap.where
    said = diagnosis.left.axes[0] if diagnosis.verdict == "unknown" and diagnosis.left else None
    said = said or (where[0].axis if where else None)
    true = {axis for e in label["effects"] for axis in ground_truth.axes(e, path)}
    return None if said is None or not true else said in true


def _regime(label: Mapping[str, Any], diagnosis: Diagnosis) -> bool | None:
    """Whether one of the worst regimes, or of the unknown force's features, is what the effect goes with (logs with one effect)."""
    if len(label["effects"]) != 1 or not diagnosis.gap.where:
        return None
    pattern = ground_truth.goes_with(label["effects"][0])
    said = [one.regime for one in diagnosis.gap.where] + list(diagnosis.left.depends_on if diagnosis.left else ())
    return None if pattern is None else any(re.search(pattern, words) for words in said)


def _onset(pairs: Sequence[tuple[ground_truth.Row, Cause]]) -> float | None:
    for effect, cause in pairs:
        if effect["onset_s"] is not None and cause.onset_s is not None:
            return abs(cause.onset_s - float(effect["onset_s"]))
    return None


def _numbers(effect: ground_truth.Row, cause: Cause, vehicle: Vehicle) -> list[dict[str, Any]]:
    """Each parameter whose true value maps onto the library's: relative error and whether the 90 % interval holds the truth."""
    if cause.effect != ground_truth.name(effect):
        return []
    rows = []
    for key, true in true_values(effect, vehicle).items():
        p = cause.parameters.get(key)
        if p is None:
            continue
        error = abs(p.value - true) / max(abs(true), 1e-9)
        rows.append(
            {
                "name": f"{cause.effect}.{key}",
                "true": true,
                "value": p.value,
                "error": error,
                "covered": p.low <= true <= p.high,
            }
        )
    return rows
