"""The packets of an autopilot's log, whole or damaged: what of a file is whole goes to the format's own library, what is lost is told.

The libraries stop at damage, or read on from the wrong byte with the wrong stamp. DataFlash: every message is A3 95, its type and as many bytes as
an FMT message says of that type, without a checksum (ArduPilot, libraries/AP_Logger/README.md). A .tlog: 8 bytes of stamp (us since 1970, big
endian), then a MAVLink packet with its own CRC (mavlink.io, serialization), which the library checks.
"""

from __future__ import annotations

import mmap
import struct
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path

from rovval.core.counts import counted
from rovval.core.errors import Finding
from rovval.ingest.files.compression import scratch_folder

DATAFLASH = b"\xa3\x95"  # every DataFlash packet begins so
FORMAT, FORMAT_SIZE, COLUMNS = 0x80, 89, 25  # the type of FMT messages, their bytes, and where in them the names of columns begin
FIELD = {
    "a": 64, "b": 1, "B": 1, "h": 2, "H": 2, "i": 4, "I": 4, "f": 4, "d": 8, "n": 4, "N": 16, "Z": 64, "c": 2, "C": 2, "e": 4, "E": 4, "L": 4, "M": 1,
    "q": 8, "Q": 8, "g": 2,
}  # fmt: skip
"""Bytes of a field by the letter of its kind in an FMT message (AP_Logger/README.md)."""
PAGE = 256  # bytes: block-based loggers fill the last page up, with what is no message
MAVLINK = {0xFE: 8, 0xFD: 12}  # first byte of a MAVLink 1 and 2 packet -> its bytes beside the payload
SIGNED, SIGNATURE = 1, 13  # flag of a MAVLink 2 packet that is signed, and the signature's bytes
STAMP = 8  # bytes before each packet of a .tlog
MOST_APART_US = 3 * 86_400_000_000  # us: a stamp so far from the one before is none (as pymavlink has it)
Content = mmap.mmap | bytes


@dataclass(slots=True)
class Packets:
    """What a file holds: the stretches of whole packets (first byte, byte after the last), how many packets, the last stamp (us; None where none is
    known), and how many bytes at the ``tail`` belong to no whole packet."""

    stretches: list[tuple[int, int]] = field(default_factory=list)
    count: int = 0
    last_us: int | None = None
    tail: int = 0

    def take(self, at: int, end: int) -> None:
        """One more packet."""
        if self.stretches and self.stretches[-1][1] == at:
            self.stretches[-1] = (self.stretches[-1][0], end)
        else:
            self.stretches.append((at, end))
        self.count += 1

    def lost(self) -> tuple[int, int]:
        """Bytes between packets that belong to none, and in how many places."""
        ends = [0, *(end for _, end in self.stretches)]
        gaps = [start - end for (start, _), end in zip(self.stretches, ends, strict=False) if start > end]
        return sum(gaps), len(gaps)

    def findings(self, where: str) -> list[Finding]:
        """What is lost; () of a whole file."""
        found = []
        if self.tail:
            to = "" if self.last_us is None else f", to {_moment(self.last_us)}"
            found.append(Finding("cut_file", where, f"{counted(self.count, 'packet')}{to}; the file ends in the middle of one ({counted(self.tail, 'byte')})"))
        size, places = self.lost()
        if size:
            found.append(Finding("damaged_file", where, f"{counted(size, 'byte')} in {counted(places, 'place')} are no whole packet; left out"))
        return found


def _moment(us: int) -> str:
    return f"{datetime.fromtimestamp(us // 1_000_000, UTC):%H:%M:%S} UTC" if us > 10**15 else f"{us * 1e-6:.1f} s after the start"


@contextmanager
def whole_packets(path: Path) -> Iterator[tuple[Path, list[Finding]]]:
    """The file where all of it is whole packets, else a copy of those that are, gone afterwards; and what is lost."""
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as content:
        found = packets(content)
        if not found.tail and not found.lost()[0]:
            yield path, []
            return
        with scratch_folder(path) as folder:
            copy = folder / path.name
            with copy.open("wb") as out:
                for start, end in found.stretches:
                    out.write(content[start:end])
            yield copy, found.findings(path.name)


def packets(content: Content) -> Packets:
    """The packets of a log, DataFlash or .tlog by its first bytes."""
    if content[:2] == DATAFLASH:
        formats = _Formats()
        return _walked(content, formats.packet, formats.learn, DATAFLASH, 0)
    return _walked(content, _telemetry, lambda content, at: None, None, STAMP)


Packet = tuple[int, int | None]  # bytes of the packet at a place, 0 where none begins, and its stamp (us) where it has one


def _walked(
    content: Content, packet: Callable[[Content, int], Packet], learn: Callable[[Content, int], None], head: bytes | None, before: int
) -> Packets:
    """Packet after packet, from each of which something is learned of those that come; where none begins that another one follows, on from the next
    ``head`` (None: any of MAVLink's), ``before`` bytes ahead of which a packet begins."""
    found, at, size = Packets(), 0, len(content)
    while 0 <= at < size:
        n, us = packet(content, at)
        then = at + n
        followed = content[then : then + 2] == head if head else _follows(packet(content, then), us)  # by one of a type that is not known, too
        if n and then <= size and (then == size or followed or _padding(content, then, head)):
            found.take(at, then)
            learn(content, at)
            found.last_us = found.last_us if us is None else us
            at = then
        else:
            places = [p for h in ([head] if head else map(bytes, zip(MAVLINK, strict=True))) if (p := content.find(h, at + before + 1)) >= 0]
            at = min(places) - before if places else -1
    end = found.stretches[-1][1] if found.stretches else 0
    found.tail = 0 if _padding(content, end, head) else size - end
    return found


def _follows(packet: Packet, us: int | None) -> bool:
    """Whether a packet is one that can follow one of that stamp."""
    return packet[0] > 0 and (us is None or packet[1] is None or abs(packet[1] - us) <= MOST_APART_US)


def _padding(content: Content, at: int, head: bytes | None) -> bool:
    """Whether the rest of a file is what a block-based logger fills its last page with."""
    return head is not None and len(content) - at < PAGE and head not in content[at:]


class _Formats:
    """What the FMT messages that were taken say of messages: bytes by type, and which types begin with TimeUS."""

    def __init__(self) -> None:
        self.sizes = {FORMAT: FORMAT_SIZE}
        self.stamped: set[int] = set()

    def packet(self, content: Content, at: int) -> Packet:
        """Bytes and stamp of the message at a place."""
        if content[at : at + 2] != DATAFLASH or at + 3 > len(content):
            return 0, None
        kind = content[at + 2]
        if kind == FORMAT and not _is_format(content[at : at + FORMAT_SIZE]):
            return 0, None  # damaged: its type alone is not known
        timed = kind in self.stamped and at + 11 <= len(content)
        return self.sizes.get(kind, 0), struct.unpack_from("<Q", content, at + 3)[0] if timed else None

    def learn(self, content: Content, at: int) -> None:
        """From a message that is taken: those of a format that is left out are left out with it."""
        if content[at + 2] == FORMAT:
            self.sizes[content[at + 3]] = content[at + 4]
            if content[at + COLUMNS : at + COLUMNS + 6] == b"TimeUS":
                self.stamped.add(content[at + 3])


def _is_format(message: bytes) -> bool:
    """Whether an FMT message (type, length, name of 4, format of 16, names of columns of 64) agrees with itself."""
    kinds, names = message[9:25].rstrip(b"\0").decode("latin-1"), message[COLUMNS:].rstrip(b"\0")
    if len(message) < FORMAT_SIZE or not set(kinds) <= set(FIELD) or not message[5:9].rstrip(b"\0").isalnum() or not names.isascii():
        return False
    return message[4] == 3 + sum(FIELD[kind] for kind in kinds) and names.count(b",") + 1 == len(kinds)


def _telemetry(content: Content, at: int) -> Packet:
    if at + STAMP + 3 > len(content) or (beside := MAVLINK.get(content[at + STAMP])) is None:
        return 0, None
    signed = SIGNATURE if content[at + STAMP] == 0xFD and content[at + STAMP + 2] & SIGNED else 0
    return STAMP + beside + content[at + STAMP + 1] + signed, struct.unpack_from(">Q", content, at)[0]
