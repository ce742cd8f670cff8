"""What every reader does with a path first: is it there, is there something in it, and what is its digest."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from rovval.core.errors import BadInput
from rovval.ingest.files.dive_file import files_of_dive, is_dive


def files_of(path: Path) -> tuple[Path, ...]:
    """The files that make up a log: itself, what a folder (a ROS 2 bag) holds, in order of name, or what a dive file names."""
    if is_dive(path) and path.is_file():
        return tuple(f for part in files_of_dive(path) for f in ((part,) if part == path else files_of(part)))
    return tuple(sorted(p for p in path.rglob("*") if p.is_file())) if path.is_dir() else (path,)


def refuse_unusable(path: Path) -> None:
    """Raises `BadInput` for a path that is not there, cannot be read, or holds nothing."""
    if not path.exists():
        raise BadInput(f"{path}: no such file", "check the path")
    if not (path.is_file() or path.is_dir()):
        raise BadInput(f"{path}: neither a file nor a folder", "check the path")
    try:
        size = sum(part.stat().st_size for part in files_of(path))
        with files_of(path)[0].open("rb") as file:
            file.read(1)
    except IndexError:
        raise BadInput(f"{path}: the folder is empty", "give a log file, or a folder that is a ROS 2 bag") from None
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}", "check its permissions") from None
    if size == 0:
        raise BadInput(f"{path}: the file is empty", "was the export interrupted?")


def sha256(path: Path) -> str:
    """Digest of a log's content; of a folder, of the names and contents of its files."""
    digest = hashlib.sha256()
    for part in files_of(path):
        if path.is_dir():
            digest.update(os.fsencode(part.relative_to(path).as_posix()) + b"\0")
        elif part != path:  # a file of a dive
            digest.update(os.fsencode(part.name) + b"\0")
        with part.open("rb") as file:
            while block := file.read(1 << 20):
                digest.update(block)
    return digest.hexdigest()
