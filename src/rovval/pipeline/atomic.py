"""Texts and documents that appear whole or not at all, and the sweeping of what a kill left of them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from rovval.storage.atomic import LEFTOVER, drafts


def write_text(path: Path, text: str) -> None:
    """Write ``text`` to ``path`` in one step: a reader sees the old file or the new one, also after a power cut."""
    with drafts(path) as [draft]:
        draft.write_text(text, encoding="utf-8", newline="\n")


def write_json(path: Path, document: dict[str, Any]) -> None:
    """Write a JSON document in one step."""
    write_text(path, json_text(document))


def json_text(document: dict[str, Any]) -> str:
    """A JSON document as text; NaN is refused rather than written as something that is not JSON."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def read_json(path: Path) -> dict[str, Any] | None:
    """A JSON document; None where there is none, or a kill by other means left it broken."""
    try:
        document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, json.JSONDecodeError):
        return None
    return document


def sweep(root: Path) -> None:
    """Remove what a kill left half-written under ``root`` (call it only while holding the lock of ``root``)."""
    for left in list(root.rglob(LEFTOVER)):
        left.unlink(missing_ok=True)
