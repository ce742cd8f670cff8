"""What a batch did, as a document (rovval.summary/1); `rovval.report.batch` writes it to be read."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from typing import Any

from rovval.pipeline import tolerances

DONE, BEYOND, QUARANTINED = 0, 1, 3


def summarise(
    name: str,
    finished: Sequence[Mapping[str, Any]],
    skipped: Sequence[Mapping[str, Any]],
    set_aside: Sequence[Mapping[str, Any]],
    waiting: Sequence[tuple[Any, str]],
    limits: Sequence[str],
    seconds: float,
    why: Mapping[str, int],
) -> dict[str, Any]:
    """The summary document. ``why`` there was something to do, by `Plan.why`. Tolerances are held against every run of the plan, new or unchanged."""
    parsed = tolerances.parse(limits)
    beyond, stopped = [], []
    for record in (*finished, *skipped):
        compared = record["steps"].get("compare")
        if stops := record["steps"].get("simulate", {}).get("stops") or (compared["comparison"]["stops"] if compared else ()):
            stopped.append({"log": record["log"], "run": record["run"], "stops": list(stops)})
        lines = tolerances.exceeded(parsed, compared["comparison"]) if compared else ()
        beyond += [{"log": record["log"], "run": record["run"], "limit": line} for line in lines]
    code = QUARANTINED if set_aside else BEYOND if beyond else DONE
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
        },
        "why": dict(why),
        "done": [{"log": r["log"], "run": r["run"]} for r in finished],
        "tolerances_exceeded": beyond,
        "left_sane_limits": stopped,
        "quarantined": [{k: r[k] for k in ("log", "kind", "reason", "next")} for r in set_aside],
        "waiting": [{"log": str(log), "why": why} for log, why in waiting],
    }
