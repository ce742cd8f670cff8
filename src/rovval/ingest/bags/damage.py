"""The account of a damaged file: what was lost and where, how many messages were read all the same, and up to when."""

from __future__ import annotations

from collections import Counter
from datetime import UTC, datetime

from rovval.core.errors import Finding
from rovval.ingest.bags.block import Index

FIRST_UTC_NS = 10**18  # stamps before 2001 count from the start of a simulation


class Damage:
    """Counts the messages that a container finds, and keeps what it says is lost."""

    def __init__(self) -> None:
        self.messages = 0
        self.last_ns = 0
        self.cut = ""
        self.lost: Counter[str] = Counter()

    def found(self, record_ns: Index) -> None:
        """Messages that were read, by their stamps."""
        if len(record_ns):
            self.messages += len(record_ns)
            self.last_ns = max(self.last_ns, int(record_ns.max()))

    def findings(self, where: str) -> list[Finding]:
        """One finding for an end that is missing, one for each kind of damage before it; none for a whole file."""
        told = [Finding("damaged_file", where, what if times == 1 else f"{what} ({times:,} times)") for what, times in self.lost.items()]
        if self.cut:
            told.insert(0, Finding("cut_file", where, f"{self.messages:,} messages, to {clock(self.last_ns)}; {self.cut}"))
        return told


def clock(ns: int) -> str:
    """A stamp as a reader looks for it: the time of day, or seconds where it does not count from 1970."""
    if ns < FIRST_UTC_NS:
        return f"{ns * 1e-9:.1f} s"
    return f"{datetime.fromtimestamp(ns // 10**9, UTC):%H:%M:%S} UTC"
