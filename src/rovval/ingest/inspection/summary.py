"""Blocks of a log -> what a person wants to know of each topic and field: how much, from when to when, how often, how large."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from rovval.core.data import Array
from rovval.core.errors import Finding
from rovval.ingest.contents.block import Block

EXAMPLES = 5  # values of a field that are shown: enough to see what it is
EPOCH_S = 946_684_800.0  # 2000-01-01 UTC: a stamp below it counts from some start, not from 1970


@dataclass(frozen=True, slots=True)
class Rhythm:
    """Stamps of one clock or column: first and last (s, as logged), rate over the whole (Hz), median period, the largest gap and where it begins
    (s after the first), how often the stamps go back or repeat."""

    first_s: float
    last_s: float
    rate_hz: float
    period_s: float
    largest_gap_s: float
    gap_after_s: float
    backwards: int

    @property
    def since_1970(self) -> bool:
        """Whether the stamps are of the calendar."""
        return self.first_s > EPOCH_S


@dataclass(frozen=True, slots=True)
class FieldSummary:
    """One field of a topic or column of a table, as logged. ``low`` and ``high`` are None for text and for a field without a value; ``stamps`` are its
    values where it may be a clock (it never goes back, or its name says time)."""

    address: str
    present: int
    missing: int
    low: float | None
    high: float | None
    examples: tuple[float | str, ...]
    unit: str = ""
    largest_step: float = 0.0
    values: Array | None = None
    texts: tuple[str, ...] = ()

    @property
    def constant(self) -> bool:
        """Whether it holds one value only."""
        return (self.low is not None and self.low == self.high) or (bool(self.texts) and len(set(self.texts)) == 1)


@dataclass(frozen=True, slots=True)
class TopicSummary:
    """One topic, or the table ("")."""

    name: str
    kind: str
    rows: int
    clocks: Mapping[str, Rhythm]
    record_minus_header_s: float | None
    fields: Mapping[str, FieldSummary]
    left_out: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Contents:
    """All topics of a log by name, what the file says of itself, and the damage met while reading it."""

    topics: Mapping[str, TopicSummary]
    facts: Mapping[str, str]
    findings: tuple[Finding, ...]


def summarised(blocks: Iterable[Block]) -> Contents:
    """Fold the blocks of a log; memory is that of one block, the stamps, and the columns that may be clocks."""
    topics: dict[tuple[str, str], _Topic] = {}
    facts: dict[str, str] = {}
    findings: list[Finding] = []
    for block in blocks:
        facts |= block.facts
        findings += block.findings
        if block.rows or block.topic or block.kind:
            topics.setdefault((block.topic, block.kind), _Topic()).add(block)
    names = [name for name, _ in topics]
    return Contents(
        {(name if names.count(name) == 1 else f"{name} ({kind})"): t.summary(name, kind) for (name, kind), t in topics.items()}, facts, tuple(findings)
    )


def rhythm(stamps: Array) -> Rhythm | None:
    """What stamps (n,) in s say, NaN left out; None where there are none."""
    t = stamps[np.isfinite(stamps)]
    if not len(t):
        return None
    steps = np.diff(t)
    forward = steps[steps > 0]
    span, widest = float(forward.sum()), int(np.argmax(steps)) if len(forward) else 0
    return Rhythm(
        float(t[0]), float(t.max()), len(forward) / span if span else 0.0, float(np.median(forward)) if len(forward) else 0.0,
        float(forward.max()) if len(forward) else 0.0, float(t[widest] - t[0]), int((steps <= 0).sum()),
    )  # fmt: skip


@dataclass(slots=True)
class _Field:
    number: bool
    unit: str
    rows: int = 0
    present: int = 0
    low: float = np.inf
    high: float = -np.inf
    last: float = np.nan
    largest_step: float = 0.0
    examples: list[float | str] = field(default_factory=list)
    kept: list[Array] | None = None
    texts: list[str] = field(default_factory=list)

    def reach(self, rows: int) -> None:
        """Missing in the rows up to here: blocks of one topic may differ in their fields, and a column in what its cells are."""
        absent = rows - self.rows
        if self.kept is not None and absent > 0:
            self.kept.append(np.full(absent, np.nan))
        self.rows = max(self.rows, rows)
        if self.texts:
            self.texts += [""] * (self.rows - len(self.texts))

    def numbers(self, values: Array, keep: bool) -> None:
        known = values[np.isfinite(values)]
        if self.rows == 0 and keep:
            self.kept = []
        self.rows += len(values)
        self.present += len(known)
        if self.kept is not None:
            self.kept.append(values)
        if len(known):
            steps = np.diff(known, prepend=known[0] if np.isnan(self.last) else self.last)
            self.low, self.high = min(self.low, float(known.min())), max(self.high, float(known.max()))
            self.largest_step, self.last = max(self.largest_step, float(np.abs(steps).max())), float(known[-1])
            self.examples += known[: EXAMPLES - len(self.examples)].tolist()

    def words(self, texts: Iterable[str]) -> None:
        written = list(texts)
        self.texts += [""] * (self.rows - len(self.texts))
        if self.kept is not None:
            self.kept.append(np.full(len(written), np.nan))
        self.rows += len(written)
        self.present += sum(bool(t) for t in written)
        self.texts += written
        for text in written:
            if len(self.examples) == EXAMPLES:
                break
            if text and text not in self.examples:
                self.examples.append(text)

    def summary(self, address: str, rows: int) -> FieldSummary:
        some = self.number and self.present > 0
        kept = None if self.kept is None else np.concatenate([*self.kept, np.full(rows - self.rows, np.nan)])
        return FieldSummary(
            address, self.present, rows - self.present, self.low if some else None, self.high if some else None, tuple(self.examples), self.unit,
            self.largest_step, kept, tuple(self.texts),
        )  # fmt: skip


@dataclass(slots=True)
class _Topic:
    rows: int = 0
    clocks: dict[str, list[Array]] = field(default_factory=dict)
    fields: dict[str, _Field] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)

    def add(self, block: Block) -> None:
        table = not block.clocks
        for name, stamps in block.clocks.items():
            self.clocks.setdefault(name, []).append(np.asarray(stamps, dtype=float))
        for address, values in block.numbers.items():
            known = values[np.isfinite(values)]
            held = self._held(address, True, block.units.get(address, ""))
            held.numbers(np.asarray(values, dtype=float), keep=table and len(known) > 1 and (_clock_name(address) or bool((np.diff(known) >= 0).all())))
        for address, texts in block.texts.items():
            self._held(address, False, "").words(texts)
        self.left_out |= block.left_out
        self.rows += block.rows
        for held in self.fields.values():
            held.reach(self.rows)

    def _held(self, address: str, number: bool, unit: str) -> _Field:
        held = self.fields.setdefault(address, _Field(number, unit))
        held.number |= number
        held.reach(self.rows)
        return held

    def summary(self, name: str, kind: str) -> TopicSummary:
        clocks = {n: np.concatenate(parts) for n, parts in self.clocks.items()}
        rhythms = {n: r for n, stamps in clocks.items() if (r := rhythm(stamps)) is not None}
        lag = None
        if {"record", "header"} <= rhythms.keys() and len(clocks["record"]) == len(clocks["header"]):
            lag = float(np.nanmedian(clocks["record"] - clocks["header"]))
        fields = {a: f.summary(a, self.rows) for a, f in self.fields.items()}
        return TopicSummary(name, kind, self.rows, rhythms, lag, fields, dict(self.left_out))


def _clock_name(address: str) -> bool:
    plain = address.casefold()
    return any(word in plain for word in ("time", "stamp", "hour", "min", "sec", "zeit", "uhr", "stunde", "datum", "date"))
