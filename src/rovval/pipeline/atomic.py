"""Files that appear whole or not at all: written beside their place, then renamed into it."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

LEFTOVER = ".*.part"  # what a kill leaves behind is named so, here and in `rovval.report.files`


def beside(path: Path) -> Path:
    """Where to write what will be renamed to ``path``: the same folder, a name that no glob for logs or reports takes up."""
    path.parent.mkdir(parents=True, exist_ok=True)
    return path.with_name(f".{path.name}.{os.getpid()}.part")


def write_text(path: Path, text: str) -> None:
    """Write ``text`` to ``path`` in one step: a reader sees the old file or the new one, also after a power cut."""
    new = beside(path)
    try:
        with new.open("w", encoding="utf-8", newline="\n") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        new.replace(path)
    finally:
        new.unlink(missing_ok=True)


def write_json(path: Path, document: dict[str, Any]) -> None:
    """Write a JSON document in one step; NaN is refused rather than written as something that is not JSON."""
    write_text(path, json.dumps(document, indent=2, allow_nan=False) + "\n")


def sweep(root: Path) -> None:
    """Remove what a kill left half-written under ``root`` (call it only while holding the lock of ``root``)."""
    for left in list(root.rglob(LEFTOVER)):
        left.unlink(missing_ok=True)
