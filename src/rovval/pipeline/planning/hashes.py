"""Content hashes that say whether there is something to do: of each log, kept from one run to the next, and of rovval's own code."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

from rovval.core.code_version import source_hash
from rovval.ingest.files import files_of, sha256
from rovval.storage import places
from rovval.storage.atomic import read_json, write_json

NO_RESULT = ("blind", "cli", "demo", "fly")  # rooms that no step of a batch goes through


class Hashes:
    """Digests of logs' content, so that an archive of thousands is not read every night.

    A log is read again when the number, size, times (of change and of status) or inode of its files differ from those of the last time: the
    time of status is the kernel's own, which no program sets back. (Of an object of a store its tag and size.) ``afresh`` reads every log.
    """

    def __init__(self, path: Path, afresh: bool = False) -> None:
        self.path = path
        self.known: dict[str, str] = {log: entry for log, entry in (read_json(path) or {}).items() if _whole(entry)}
        self.used: dict[str, str] = {}  # by log: digest and stamp, as text, which is the smallest
        self.afresh = afresh

    def of(self, log: Path) -> str:
        """That of a log's content, read only if the log has changed. Raises OSError for one that cannot be read."""
        stamp = _stamp(log)
        entry = self.known.get(str(log), "")
        if entry.partition(" ")[2] != stamp or self.afresh:
            entry = f"{sha256(log)} {stamp}"
        self.used[str(log)] = entry
        return entry.partition(" ")[0]

    def below(self, folders: Sequence[Path]) -> list[tuple[Path, str]]:
        """The logs that were in ``folders`` the last time, and their digests; they stay known."""
        were = {log: entry for log, entry in self.known.items() if any(places.is_inside(places.place(log), folder) for folder in folders)}
        self.used = were | self.used
        return [(places.place(log), entry.partition(" ")[0]) for log, entry in were.items()]

    def save(self) -> None:
        """Keep those that were asked for."""
        if self.used != self.known:
            write_json(self.path, self.used)


def _stamp(log: Path) -> str:
    return json.dumps([places.stamp(part) for part in files_of(log)])


def _whole(entry: Any) -> bool:
    """Whether an entry of the file is one: the file may have been damaged."""
    return isinstance(entry, str) and re.match(r"[0-9a-f]{64} ", entry) is not None


def code_on_disk() -> str:
    """Hash of the sources as they stand on disk (milliseconds). Vehicles and profiles count by their own content."""
    return source_hash(NO_RESULT, (".py",))


@cache
def code_of_this_process() -> str:
    """That of this process, once: a worker goes on with the code that it began with."""
    return code_on_disk()
