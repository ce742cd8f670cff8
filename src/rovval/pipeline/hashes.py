"""Content hashes that say whether there is something to do: of each log, kept from one run to the next, and of rovval's own code."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

from rovval.core.code_version import source_hash
from rovval.pipeline import discover
from rovval.storage.atomic import read_json, write_json

NO_RESULT = ("blind", "cli", "demo", "fly")  # rooms that no step of a batch goes through


class Hashes:
    """Content hashes by path, size and time of change, so that an archive of thousands is not read every night."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.known = read_json(path) or {}
        self.used: dict[str, Any] = {}

    def of(self, log: Path) -> str:
        """That of a log's content, read only if the log has changed."""
        stamp = [[p.stat().st_size, p.stat().st_mtime_ns] for p in ([log] if log.is_file() else sorted(log.rglob("*")))]
        entry = self.known.get(str(log))
        sha: str = entry["sha256"] if entry and entry["stamp"] == stamp else discover.sha256(log)
        self.used[str(log)] = {"stamp": stamp, "sha256": sha}
        return sha

    def save(self) -> None:
        """Keep those that were asked for."""
        if self.used != self.known:
            write_json(self.path, self.used)


def code_on_disk() -> str:
    """Hash of the sources as they stand on disk (milliseconds). Vehicles and profiles count by their own content."""
    return source_hash(NO_RESULT, (".py",))


@cache
def code_of_this_process() -> str:
    """That of this process, once: a worker goes on with the code that it began with."""
    return code_on_disk()
