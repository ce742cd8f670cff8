"""Two runs of one pipeline never overlap: the second says so and leaves."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rovval.core.errors import UsageProblem


@contextmanager
def held(folder: Path, wait: bool = False, shared: bool = False) -> Iterator[None]:
    """Hold ``folder``'s lock, which one that is held for moments is to ``wait`` for; those that hold it ``shared`` do so together.
    The kernel lets go of it when the process ends, however it ends.

    Raises:
        UsageProblem: another process holds it, or the system has no flock.
    """
    try:
        import fcntl
    except ImportError:
        raise UsageProblem(
            "this system has no flock, which keeps two batches apart", "run the batch on Linux or macOS"
        ) from None
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / ".lock").open("a+", encoding="utf-8") as file:
        try:
            fcntl.flock(file, (fcntl.LOCK_SH if shared else fcntl.LOCK_EX) | (0 if wait else fcntl.LOCK_NB))
        except BlockingIOError:
            file.seek(0)
            raise UsageProblem(
                f"{folder}: another run is at work (process {file.read().strip() or 'unknown'})", "wait for it, or end it"
            ) from None
        if not wait and not shared:  # whom others find is told to those that do not wait
            file.truncate(0)
            file.write(str(os.getpid()))
            file.flush()
        yield
