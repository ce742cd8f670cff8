"""Size and digest of written files, by which a later run knows that they are still what was written."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from stat import S_ISREG
from typing import Any

from rovval.storage.places import name_from, named, status

BLOCK = 1 << 20


def contents(outputs: Iterable[Path], base: Path) -> dict[str, dict[str, Any]]:
    """Bytes and sha256 of every file of ``outputs`` (files, and folders with all that is in them), by its path relative to ``base``."""
    files = [f for output in outputs for f in (sorted(output.rglob("*")) if output.is_dir() else [output]) if f.is_file()]
    return {name_from(base, file): {"bytes": file.stat().st_size, "sha256": digest(file)} for file in files}


def damage(files: Mapping[str, Mapping[str, Any]], base: Path, digests: bool = False) -> dict[str, str]:
    """Which of ``files`` (as `contents` returned them) is gone or another, and how; by size, and by content if ``digests``."""
    found = {}
    for name, wanted in files.items():
        try:
            there = status(base, name)
        except (FileNotFoundError, NotADirectoryError):
            found[name] = "gone"
            continue
        if not S_ISREG(there.st_mode):
            found[name] = "gone"
        elif there.st_size != wanted["bytes"]:
            found[name] = f"{there.st_size} bytes, {wanted['bytes']} were written"
        elif digests and digest(named(base, name)) != wanted["sha256"]:
            found[name] = "another content than was written"
    return found


def digest(file: Path) -> str:
    """Sha256 of a file's content."""
    total = hashlib.sha256()
    with file.open("rb") as stream:
        while block := stream.read(BLOCK):
            total.update(block)
    return total.hexdigest()
