"""A file that tells how much of it was read, for libraries that read a log in one call."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

from rovval.core.progress import Progress

BLOCK = 1 << 20  # bytes between two tellings


def watched(path: Path, step: str, progress: Progress) -> io.BufferedReader:
    """The file, open for reading; ``progress`` hears ``step`` and the share that was reached."""
    return io.BufferedReader(_Watched(path, step, progress), BLOCK)


class _Watched(io.FileIO):
    def __init__(self, path: Path, step: str, progress: Progress) -> None:
        super().__init__(path)
        self.step, self.progress, self.reached = step, progress, 0
        self.size = max(path.stat().st_size, 1)

    def readinto(self, buffer: Any, /) -> int | None:
        count = super().readinto(buffer)
        self.reached = max(self.reached, self.tell())
        self.progress(self.step, min(self.reached / self.size, 1.0))
        return count
