"""Logs of one JSON object a line, such as what the Doppler logs of Water Linked (A50, A125) send: the object's ``type`` is its topic.

Stamps: ``record`` is what a logger wrote before the object; ``header`` the Doppler log's own, ``time_of_validity`` (us since 1970) of
``velocity`` and ``ts`` (s) of ``position_local`` (Water Linked, DVL JSON protocol, json_v3). Other objects have theirs as columns.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from rovval.core.counts import counted
from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block, Collector
from rovval.ingest.contents.flatten import flat
from rovval.ingest.profile import Profile
from rovval.ingest.table.stamped_lines import lines_of

SUFFIXES = (".jsonl", ".ndjson", ".json", ".log", ".txt")
ALSO: tuple[str, ...] = ("csv_log",)
OWN_STAMP = {"velocity": ("time_of_validity", 1e-6), "position_local": ("ts", 1.0)}  # topic of a Doppler log -> its stamp and the stamp's unit, s
UNMEASURED = {"velocity": ("velocity_valid", ("vx", "vy", "vz", "fom", "altitude"))}  # topic -> flag, and what holds no measurement without it


def sniff(path: Path) -> bool:
    """Whether the first line that holds an object is one, whole."""
    for _, line in lines_of(path, "{", []):
        return _object(line) is not None
    return False


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required topics or columns of ``profile`` that the log has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in_blocks

    return missing_in_blocks(contents(path), profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming everything that is missing."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, contents(path, progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """The objects by topic. Lines that are no object, and pings without bottom lock, are findings. Raises `BadInput` where there is none."""
    collector, findings = Collector(), list[Finding]()
    bad, count, unlocked = 0, 0, 0
    for stamp, line in lines_of(path, "{", findings, progress):
        if (found := _object(line)) is None:
            bad += 1
            continue
        count += 1
        topic = str(found.get("type", ""))
        flag, fields = UNMEASURED.get(topic, ("", ()))
        if flag and found.get(flag) is False:
            unlocked += 1
            found = {name: value for name, value in found.items() if name not in fields}
        clocks = {"record": stamp} if stamp == stamp else {}
        name, unit = OWN_STAMP.get(topic, ("", 0.0))
        if isinstance(own := found.get(name), (int, float)):
            clocks["header"] = own * unit
        values, left_out = flat({n: v for n, v in found.items() if n not in ("type", name)})
        if block := collector.add(topic, str(found.get("format", "")), clocks, values, left_out):
            yield block
    if not count:
        raise BadInput(f"{path}: no line of it is a JSON object", "is the file whole, and one object a line?")
    yield from collector.rest()
    if bad:
        findings.append(Finding("bad_line", path.name, f"{counted(bad, 'line')} without a whole JSON object; left out"))
    if unlocked:
        findings.append(Finding("no_bottom_lock", "velocity", f"{counted(unlocked, 'ping')} with velocity_valid = false; no velocity and altitude there"))
    yield Block("", findings=tuple(findings))


def _object(line: str) -> Mapping[str, Any] | None:
    try:
        found = json.loads(line)
    except ValueError:
        return None
    return found if isinstance(found, dict) else None
