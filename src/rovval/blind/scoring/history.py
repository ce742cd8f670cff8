"""The history of unsealings: one JSON line for each set whose labels were ever looked at, kept with the source."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rovval.core.errors import UsageProblem


def default(root: Path) -> Path:
    """The repository's own file where rovval runs from its source tree, else a file beside the set."""
    tree = Path(__file__).parents[4]
    return tree / "reports" / "blind" / "history.jsonl" if (tree / "pyproject.toml").is_file() else root.with_name("blind-history.jsonl")


def read(path: Path) -> list[dict[str, Any]]:
    """Every unsealing so far."""
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()] if path.is_file() else []


def refuse_other_answers(path: Path, labels: str, answers: str) -> None:
    """These labels were opened before with other answers: what is scored now would not be blind."""
    for row in read(path):
        if row["labels_sha256"] == labels and row["answers_sha256"] != answers:
            raise UsageProblem(
                f"these labels were opened at {row['opened']} to score other answers; these were made or changed since",
                "make a new set with another seed, or restore the answers that were scored",
            )


def append(path: Path, row: dict[str, Any]) -> None:
    """Add one unsealing; the same answers to the same labels are not entered twice."""
    same = (row["labels_sha256"], row["answers_sha256"])
    if any((r["labels_sha256"], r["answers_sha256"]) == same for r in read(path)):
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("a", encoding="utf-8") as file:
        file.write(json.dumps(row, allow_nan=False) + "\n")
