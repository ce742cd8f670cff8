"""Several scored sets together, each plant apart: the counts and the reliability that one set is too small for."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rovval.blind.scoring.outcomes import summed
from rovval.blind.scoring.score import SCHEMA
from rovval.core.errors import BadInput, UsageProblem


def pool(roots: Sequence[Path]) -> dict[str, Any]:
    """Plant -> its sets, their counts, reliability and table by effect, and the wrong logs, each with its set.

    Raises:
        UsageProblem: sets that are not scored, all of them named, or one that is given twice.
        BadInput: a score that another version of rovval wrote.
    """
    missing = [str(root) for root in roots if not (root / "score.json").is_file()]
    if missing:
        raise UsageProblem(f"no score in {', '.join(missing)}", f"score them: `rovval blind score {missing[0]}`")
    if len({root.resolve() for root in roots}) < len(roots):
        raise UsageProblem("a set is given twice and would count twice", "give each set once")
    scores = {root: json.loads((root / "score.json").read_text(encoding="utf-8")) for root in roots}
    old = [str(root) for root, score in scores.items() if score.get("schema") != SCHEMA or "summed" not in score]
    if old:
        raise BadInput(f"scored by another version of rovval: {', '.join(old)}", f"score again: `rovval blind score {old[0]}`")
    plants: dict[str, Any] = {}
    for plant in sorted({score["plant"] for score in scores.values()}):
        sets = {root: score for root, score in scores.items() if score["plant"] == plant}
        wrong = [{"set": root.name, **row} for root, score in sets.items() for row in score["wrong"]]
        names = [root.name for root in sets]
        engines = sorted({score["engine"] for score in sets.values()})
        plants[plant] = {"sets": names, "engines": engines, **summed([row for score in sets.values() for row in score["logs"]]), "wrong": wrong}
    return {"schema": "rovval.blind-pool/1", "plants": plants}
