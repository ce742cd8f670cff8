"""Files that appear whole or not at all: written beside their place, then renamed into it."""

from __future__ import annotations

import errno
import json
import os
import re
import shutil
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from rovval.core.errors import Unwritable, UsageProblem

LEFTOVER = ".*.part"  # what a kill leaves behind is named so
FULL = (errno.ENOSPC, errno.EDQUOT)
CLOSED = (errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)


@contextmanager
def drafts(*places: Path) -> Iterator[list[Path]]:
    """Where to write what will stand at ``places``: beside each, under names that no glob for logs or reports takes up.

    All of them are renamed into place when the block ends, and none where it fails. Raises `Unwritable` where the disk is full or
    closed to us, `UsageProblem` where a place cannot be a file's.
    """
    refuse_url(*places)
    beside = [place.with_name(f".{place.name}.{uuid.uuid4().hex[:8]}.part") for place in places]  # two containers share process ids
    try:
        for place in places:
            place.parent.mkdir(parents=True, exist_ok=True)
            if place.is_dir():
                raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
        yield beside
        for draft, place in zip(beside, places, strict=True):
            _sync(draft)
            draft.replace(place)
    except OSError as error:
        raise refusal(places[0] if len(places) == 1 else places[0].parent, error) from None
    finally:
        for draft in beside:
            with suppress(OSError):
                draft.unlink(missing_ok=True)


def refuse_unwritable(*places: Path | None) -> None:
    """Refuse places that cannot be written before the work of hours, not after it; None is no place."""
    for place in places:
        if place is None:
            continue
        if place.is_dir():
            raise refusal(place, IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR)))
        there = next(parent for parent in place.absolute().parents if parent.exists())
        if not there.is_dir() or not os.access(there, os.W_OK):
            code = errno.EACCES if there.is_dir() else errno.ENOTDIR
            raise refusal(place, OSError(code, os.strerror(code)))


def refuse_url(*places: Path) -> None:
    """Refuse what is the address of an object store or server: as a path it would be a local folder of that name, lost with the machine."""
    for place in places:
        if scheme := re.match(r"([A-Za-z][A-Za-z0-9+.-]+):/", str(place)):
            raise UsageProblem(
                f"{scheme[1]}://{str(place)[scheme.end() :].lstrip('/')}: {scheme[1]}:// is no place that rovval reads or writes, only folders are",
                "mount it as a folder (s3fs, rclone mount, a volume of the cluster) and give that, or copy to it afterwards",
            )


def refusal(place: Path, error: OSError) -> UsageProblem:
    """Why ``place`` cannot be written, and what to do."""
    kind = Unwritable if error.errno in FULL + CLOSED else UsageProblem
    hint = "free space on its disk" if error.errno in FULL else "mend the path or its permissions"
    return kind(f"{place}: cannot be written: {error.strerror or error}", f"{hint}, or write elsewhere")


def _sync(path: Path) -> None:
    """On disk before it is renamed, so that a power cut leaves the old file or the new one."""
    with path.open("rb") as file:
        os.fsync(file.fileno())


def write_text(path: Path, text: str) -> None:
    """Write ``text`` to ``path`` in one step: a reader sees the old file or the new one, also after a power cut."""
    with drafts(path) as [draft]:
        draft.write_text(text, encoding="utf-8", newline="\n")


def write_over(path: Path, text: str) -> None:
    """Write ``text`` in the place of a file that stands there, on the space that it takes: where the disk is full nothing else goes.
    A reader may see it in part. Raises OSError."""
    with path.open("r+", encoding="utf-8", newline="\n") as file:
        file.truncate(0)
        file.write(text)


def write_json(path: Path, document: dict[str, Any]) -> None:
    """Write a JSON document in one step."""
    write_text(path, json_text(document))


def json_text(document: dict[str, Any]) -> str:
    """A JSON document as text; NaN is refused rather than written as something that is not JSON."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def read_json(path: Path) -> dict[str, Any] | None:
    """A JSON object; None where there is none, or what lies there is damaged."""
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, IsADirectoryError, ValueError, RecursionError):
        return None
    return document if isinstance(document, dict) else None


def sweep(root: Path) -> None:
    """Remove what a kill left half-written under ``root`` (call it only while holding the lock of ``root``)."""
    for left in list(root.rglob(LEFTOVER)):
        if left.is_dir():
            shutil.rmtree(left, ignore_errors=True)
        else:
            left.unlink(missing_ok=True)
