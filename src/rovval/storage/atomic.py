"""Files that appear whole or not at all: written beside their place, then renamed into it."""

from __future__ import annotations

import errno
import fnmatch
import json
import os
import shutil
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from pydantic_core import from_json

from rovval.core.errors import Unwritable, UsageProblem
from rovval.storage.places import is_remote, put

LEFTOVER = ".*.part"  # what a kill leaves behind is named so
FULL = (errno.ENOSPC, errno.EDQUOT)
CLOSED = (errno.EROFS, errno.EACCES, errno.EPERM, errno.EIO)


@contextmanager
def drafts(*places: Path) -> Iterator[list[Path]]:
    """Where to write what will stand at ``places``: beside each, under names that no glob for logs or reports takes up.

    All of them are renamed into place when the block ends, and none where it fails; for an object store they are made on this machine's disk and
    put there. Raises `Unwritable` where the disk is full or
    closed to us, `UsageProblem` where a place cannot be a file's.
    """
    with ExitStack() as stack:
        if remote := any(map(is_remote, places)):
            there = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="rovval-")))
            beside = [there / f"{number}-{place.name}" for number, place in enumerate(places)]
        else:
            # two containers share process ids
            beside = [place.with_name(f".{place.name}.{uuid.uuid4().hex[:8]}.part") for place in places]
        try:
            for place in () if remote else places:
                place.parent.mkdir(parents=True, exist_ok=True)
                if place.is_dir():
                    raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
            yield beside
            for draft, place in zip(beside, places, strict=True):
                put(draft, place) if remote else _into_place(draft, place)
        except OSError as error:
            raise refusal(places[0] if len(places) == 1 else places[0].parent, error) from None
        finally:
            for draft in beside:
                with suppress(OSError):
                    draft.unlink(missing_ok=True)


def _into_place(draft: Path, place: Path) -> None:
    """On disk before it is renamed, so that a power cut leaves the old file or the new one."""
    with draft.open("rb") as file:
        os.fsync(file.fileno())
    draft.replace(place)


def refuse_unwritable(*places: Path | None) -> None:
    """Refuse places that cannot be written before the work of hours, not after it; None is no place."""
    for place in places:
        if place is None or is_remote(place):
            continue
        if place.is_dir():
            raise refusal(place, IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR)))
        there = next(parent for parent in place.absolute().parents if parent.exists())
        if not there.is_dir() or not os.access(there, os.W_OK):
            code = errno.EACCES if there.is_dir() else errno.ENOTDIR
            raise refusal(place, OSError(code, os.strerror(code)))


def refusal(place: Path, error: OSError) -> UsageProblem:
    """Why ``place`` cannot be written, and what to do."""
    kind = Unwritable if error.errno in FULL + CLOSED or is_remote(place) else UsageProblem
    hint = "free space on its disk" if error.errno in FULL else "mend the path or its permissions"
    return kind(f"{place}: cannot be written: {error.strerror or error}", f"{hint}, or write elsewhere")


def write_text(path: Path, text: str) -> None:
    """Write ``text`` to ``path`` in one step: a reader sees the old file or the new one, also after a power cut."""
    with drafts(path) as [draft]:
        draft.write_text(text, encoding="utf-8", newline="\n")


def write_over(path: Path, text: str) -> None:
    """Write ``text`` in the place of a file that stands there, on the space that it takes: where the disk is full nothing else goes.
    A reader may see it in part, but for one of an object store. Raises OSError."""
    if is_remote(path):
        path.write_text(text, encoding="utf-8")
        return
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
    return read_json_with_bytes(path)[0]


def read_json_with_bytes(path: Path) -> tuple[dict[str, Any] | None, bytes]:
    """As `read_json`, and the bytes that it was read from."""
    try:
        content = path.read_bytes()
        document = _parsed(content)
    except (FileNotFoundError, IsADirectoryError, ValueError, RecursionError):
        return None, b""
    return (document if isinstance(document, dict) else None), content


def _parsed(content: bytes) -> Any:
    """What JSON says, by pydantic's reader, which takes a third of the time of Python's; what only Python's takes (half of a surrogate pair, as it
    writes of a file's name that is not UTF-8) by that. Raises ValueError and RecursionError."""
    try:
        return from_json(content)
    except ValueError:
        return json.loads(content.decode("utf-8"))


def sweep(root: Path) -> None:
    """Remove what a kill left half-written under ``root`` (call it only while holding the lock of ``root``). An object store has nothing half-written."""
    if is_remote(root):
        return
    for folder, folders, files in os.walk(root):
        for name in fnmatch.filter(folders, LEFTOVER):
            shutil.rmtree(Path(folder, name), ignore_errors=True)
        for name in fnmatch.filter(files, LEFTOVER):
            Path(folder, name).unlink(missing_ok=True)
