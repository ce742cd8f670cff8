"""What a batch did, as a document (rovval.summary/1); `rovval.report.batch` writes it to be read."""

from __future__ import annotations

import time
from collections.abc import Collection, Mapping, Sequence
from itertools import chain
from typing import Any

from rovval.core.errors import UsageProblem
from rovval.pipeline import tolerances

ATTENTION = ("quarantined", "tolerances_exceeded", "left_sane_limits")
DONE, BEYOND, STOPPED, UNUSABLE, LEFT_LIMITS = 0, 1, 2, 3, 4


def summarise(
    name: str,
    finished: Collection[Mapping[str, Any]],
    skipped: Collection[Mapping[str, Any]],
    set_aside: Sequence[Mapping[str, Any]],
    waiting: Sequence[tuple[Any, str]],
    limits: Sequence[str],
    seconds: float,
    why: Mapping[str, int],
    missing: Sequence[tuple[str, str]] = (),
    stopped_by: UsageProblem | None = None,
    unusual: Sequence[Mapping[str, str]] = (),
    damaged: Sequence[str] = (),
) -> dict[str, Any]:
    """The summary document. ``why`` there was something to do, by `Plan.why`. Tolerances are held against every run of the plan, new or
    unchanged. ``missing`` are sources without a log, each with the reason; ``stopped_by`` is what ended the batch before its end. ``unusual``
    are runs beyond a tolerance over dives, ``damaged`` what was set aside of the catalogue."""
    parsed = tolerances.parse(tolerances.of_one_run(limits))
    beyond, stopped = [], []
    for record in chain(finished, skipped):
        compared = record["steps"].get("compare")
        if stops := record["steps"].get("simulate", {}).get("stops") or (compared["comparison"]["stops"] if compared else ()):
            stopped.append({"log": record["log"], "run": record["run"], "stops": list(stops)})
        lines = tolerances.exceeded(parsed, compared["comparison"]) if compared else ()
        beyond += [{"log": record["log"], "run": record["run"], "limit": line} for line in lines]
    beyond += [dict(u) for u in unusual]
    ends = ((STOPPED, stopped_by), (UNUSABLE, set_aside or missing), (LEFT_LIMITS, stopped), (BEYOND, beyond))
    code = next((code for code, holds in ends if holds), DONE)
    return {
        "schema": "rovval.summary/1",
        "pipeline": name,
        "exit_code": code,
        "ended": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
        "seconds": round(seconds, 3),
        "counts": {
            "done": len(finished),
            "unchanged": len(skipped),
            "quarantined": len(set_aside),
            "waiting": len(waiting),
            "tolerances_exceeded": len(beyond),
            "left_sane_limits": len(stopped),
            "missing_sources": len(missing),
        },
        "why": dict(why),
        "damaged": list(damaged),
        "stopped_by": {"reason": stopped_by.message, "next": stopped_by.hint} if stopped_by else None,
        "missing_sources": [{"logs": logs, "why": why} for logs, why in missing],
        "done": [{"log": r["log"], "run": r["run"]} for r in finished],
        "tolerances_exceeded": beyond,
        "left_sane_limits": stopped,
        "quarantined": [{k: r[k] for k in ("log", "kind", "reason", "next")} for r in set_aside],
        "waiting": [{"log": str(log), "why": why} for log, why in waiting],
    }


def night_before(summary: Mapping[str, Any] | None) -> dict[str, Any] | None:
    """What of the summary of the batch before is kept beside this one's: its counts, and the logs that needed attention. None where there is none."""
    if summary is None or not {"ended", "counts", *ATTENTION} <= summary.keys():
        return None
    return {
        "ended": summary["ended"],
        "counts": summary["counts"],
        "attention": sorted({row["log"] for part in ATTENTION for row in summary[part]}),
    }
