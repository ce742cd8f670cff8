"""Who may be at work in a folder: one alone, or several together. Two runs of one pipeline never overlap: the second says so and leaves."""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path

from rovval.core.errors import UsageProblem
from rovval.storage import lease, places
from rovval.storage.atomic import refusal

LOCK, SHARED = ".lock", ".shared"
KNOWN = find_spec("fcntl") is not None  # whether this system has locks of files
Check = Callable[[], None]


@contextmanager
def held(folder: Path, wait: bool = False, shared: bool = False) -> Iterator[Check]:
    """Hold ``folder``'s lock, which one that is held for moments is to ``wait`` for; those that hold it ``shared`` do so together.
    The kernel lets go of it when the process ends, however it ends; in an object store it is a lease (`rovval.storage.lease`). Gives a function that
    raises `UsageProblem` where the lock was lost meanwhile.

    Raises:
        UsageProblem: another process holds it, it cannot be written, the system has no flock, or the object store cannot be used.
    """
    with _in_store(folder, wait, shared) if places.is_remote(folder) else _on_disk(folder, wait, shared) as check:
        yield check


@contextmanager
def _in_store(folder: Path, wait: bool, shared: bool) -> Iterator[Check]:
    """Each side first puts its own mark and then looks for the other's, so that of two at once one at least is refused."""
    if shared:
        with lease.held(folder / SHARED / uuid.uuid4().hex) as mine:
            lease.refuse_held([folder / LOCK])
            yield mine.check
    else:
        with lease.held(folder / LOCK, wait) as mine:
            lease.refuse_held((folder / SHARED).glob("*"))
            yield mine.check


@contextmanager
def _on_disk(folder: Path, wait: bool, shared: bool) -> Iterator[Check]:
    if not KNOWN:
        raise UsageProblem(
            "this system has no flock, which keeps two batches apart", "run the batch on Linux or macOS"
        )
    import fcntl

    try:
        folder.mkdir(parents=True, exist_ok=True)
        opened = (folder / LOCK).open("a+", encoding="utf-8")
    except OSError as error:
        raise refusal(folder / LOCK, error) from None
    with opened as file:
        try:
            fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | (0 if wait else fcntl.LOCK_NB))
        except BlockingIOError:
            file.seek(0)
            raise UsageProblem(
                f"{folder}: another run is at work (process {file.read().strip() or 'unknown'})", "wait for it, or end it"
            ) from None
        if not wait and not shared:  # whom others find is told to those that do not wait
            _say(file.fileno())
        yield lambda: None


def _say(lock: int) -> None:
    """Write who holds it into the lock; on a full disk it is held without."""
    with suppress(OSError):
        os.ftruncate(lock, 0)
        os.write(lock, str(os.getpid()).encode())
