"""Content hashes of logs, kept from one run to the next."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rovval.pipeline import atomic, discover


class Hashes:
    """Content hashes by path, size and time of change, so that an archive of thousands is not read every night."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.known = atomic.read_json(path) or {}
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
            atomic.write_json(self.path, self.used)
