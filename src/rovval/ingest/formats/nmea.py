"""Logs of NMEA 0183 sentences: each kind is a topic under its three letters (``HDT``, ``DPT``), with the talker (``GPHDT``) where several send it.

Stamps: ``record`` is what a logger wrote before the sentence; ``header`` the time of the last sentence before it that says one (ZDA, RMC).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, date, datetime, time
from pathlib import Path
from typing import Any

from rovval.core.counts import counted
from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding, UsageProblem
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block, Collector
from rovval.ingest.contents.flatten import flat
from rovval.ingest.profile import Profile
from rovval.ingest.table.stamped_lines import lines_of

SUFFIXES = (".nmea", ".nme", ".log", ".txt")
ALSO: tuple[str, ...] = ()
LINES_SEEN = 5  # of which one has to be a sentence with a checksum that holds: a logger's own first lines may not be


def sniff(path: Path) -> bool:
    """Whether one of the first lines with a ``$`` is a sentence with a checksum that holds."""
    for seen, (_, line) in enumerate(lines_of(path, "$", [])):
        if checks(line):
            return True
        if seen >= LINES_SEEN:
            break
    return False


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required sentences of ``profile`` that the log has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in_blocks

    return missing_in_blocks(contents(path), profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming everything that is missing, `UsageProblem` without pynmeagps."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, contents(path, progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """The sentences by kind. Those that fail their checksum are a finding. Raises `BadInput` where none holds, `UsageProblem` without pynmeagps."""
    findings: list[Finding] = []
    blocks = _by_talker(path, findings, progress)
    if not blocks:
        raise BadInput(f"{path}: no sentence of NMEA 0183 with a checksum that holds", "is this the right file?")
    talkers: dict[str, set[str]] = {}
    for block in blocks:
        talkers.setdefault(block.kind, set()).add(block.topic)
    yield from (replace(b, topic=b.kind if len(talkers[b.kind]) == 1 else b.topic) for b in blocks)
    yield Block("", findings=tuple(findings))


def checks(sentence: str) -> bool:
    """Whether the exclusive or of the characters between ``$`` and ``*`` is the checksum behind them (NMEA 0183)."""
    body, star, said = sentence[1:].partition("*")
    total = 0
    for sign in body.encode("latin-1", errors="replace"):
        total ^= sign
    return bool(star) and said[:2].upper() == f"{total:02X}"


def _by_talker(path: Path, findings: list[Finding], progress: Progress) -> list[Block]:
    try:
        from pynmeagps import NMEAReader
        from pynmeagps.exceptions import NMEAMessageError, NMEAParseError, NMEATypeError
    except ImportError:
        raise UsageProblem(f"{path}: sentences of NMEA 0183 need pynmeagps", "pip install 'rovval[nmea]'") from None
    collector, blocks = Collector(), list[Block]()
    said, bad, unread = float("nan"), 0, 0
    for stamp, line in lines_of(path, "$", findings, progress):
        if not checks(line):
            bad += 1
            continue
        try:
            message = NMEAReader.parse(line)
        except (NMEAParseError, NMEAMessageError, NMEATypeError, ValueError):
            message = None
        if message is None:
            unread += 1
            continue
        said = _time_of(message, said)
        values, left_out = flat({n: v for n, v in vars(message).items() if not n.startswith("_") and isinstance(v, (int, float, str))})
        clocks = {n: at for n, at in (("record", stamp), ("header", said)) if at == at}
        if block := collector.add(message.identity, message.msgID, clocks, values, left_out):
            blocks.append(block)
    if bad:
        findings.append(Finding("bad_checksum", path.name, f"{counted(bad, 'sentence')} with a wrong checksum or none; left out"))
    if unread:
        findings.append(Finding("bad_line", path.name, f"{counted(unread, 'sentence')} not as the kind has it; left out"))
    return [*blocks, *collector.rest()]


def _time_of(message: Any, before: float) -> float:
    """The moment that a sentence says (s since 1970), else the one before."""
    at = getattr(message, "time", None)
    if not isinstance(at, time):
        return before
    try:
        day = message.date if message.msgID == "RMC" else date(message.year, message.month, message.day)
        return datetime.combine(day, at, UTC).timestamp()
    except (AttributeError, TypeError, ValueError):
        return before
