"""A log whose reader yields blocks of columns, topic by topic or as one table -> its `RawLog`, by a profile.

This is what a format needs that has no reader of its own making: with `blocks` (its `contents`) it is read, inspected and told apart.
A profile that names ``topic`` and ``field`` takes each topic by its name: a message, a sheet of a workbook, a group of a file. One that names
``column`` takes the one table that has all that it requires, whatever the table's name.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from rovval.core.counts import counted
from rovval.core.data import Array, Marker, RawLog
from rovval.core.errors import BadInput, Finding, all_at_once
from rovval.core.long_columns import at_rest
from rovval.ingest.assembly import Signal, build
from rovval.ingest.assembly.columns import columns_of, unused, wanted
from rovval.ingest.assembly.markers import markers_of, not_there
from rovval.ingest.clocks.clock import DAY_S, Index, increasing_stamps
from rovval.ingest.contents.block import Block
from rovval.ingest.files import sha256
from rovval.ingest.profile import ATTITUDE, Profile, Source
from rovval.ingest.table import text_table

UNIX_TIME_S = 1e9  # stamps before 2001 count from a start of their own, not from 1970
MESSAGE_CLOCKS = ("header", "record")
QUATERNION = ("{0}.w {0}.x {0}.y {0}.z", "{0}[0] {0}[1] {0}[2] {0}[3]", "{0}1 {0}2 {0}3 {0}4")  # how formats write w, x, y, z


@dataclass(slots=True)
class Topic:
    """All blocks of one topic, joined: the same words as of `Block`."""

    name: str
    clocks: dict[str, Array] = field(default_factory=dict)
    numbers: dict[str, Array] = field(default_factory=dict)
    texts: dict[str, list[str]] = field(default_factory=dict)
    rows: int = 0

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of its columns."""
        return (*self.numbers, *self.texts)


@dataclass(frozen=True, slots=True)
class Part:
    """What a profile takes from one topic: channel -> its source and the fields that it is made of."""

    topic: Topic
    channels: Mapping[str, tuple[Source, tuple[str, ...]]]
    table: bool


@dataclass(frozen=True, slots=True)
class Clocked:
    """Rows to keep of a part, their stamps (s) since ``epoch_ns`` (UTC, None: since a start of its own), and which clock they are."""

    rows: Index
    t: Array
    epoch_ns: int | None
    stamp: str


def member_of(pattern: str, topic: str) -> str | None:
    """What the ``*`` of a profile's topic stands for in the name of one ("" without ``*``); None where that is another topic."""
    found = re.fullmatch(re.escape(pattern).replace(r"\*", "(.+)"), topic)
    return None if found is None else found.group(1) if found.groups() else ""


def joined(blocks: Iterable[Block]) -> tuple[dict[str, Topic], list[Finding]]:
    """Topics by name, and every finding of the blocks."""
    held: dict[str, list[Block]] = {}
    findings: list[Finding] = []
    for block in blocks:
        findings += block.findings
        if block.rows:
            held.setdefault(block.topic, []).append(block)
    return {name: _joined(name, parts) for name, parts in held.items()}, findings


def _joined(name: str, blocks: Sequence[Block]) -> Topic:
    def whole(part: str) -> dict[str, Array]:
        names = dict.fromkeys(n for b in blocks for n in getattr(b, part))
        return {n: np.concatenate([np.asarray(getattr(b, part).get(n, np.full(b.rows, np.nan)), dtype=float) for b in blocks]) for n in names}

    texts = dict.fromkeys(n for b in blocks for n in b.texts)
    cells = {n: [c for b in blocks for c in b.texts.get(n, [""] * b.rows)] for n in texts}
    return Topic(name, whole("clocks"), whole("numbers"), cells, sum(b.rows for b in blocks))


def missing_in(topics: Mapping[str, Sequence[str]], profile: Profile) -> tuple[str, ...]:
    """What a profile requires and a log (topic -> names of its fields) has not, and what its `absent` says must not be there."""
    gone: list[str] = []
    if columns := wanted(profile, required=True):
        gone += sorted((_lacking(columns, fields) for fields in topics.values()), key=len)[0] if topics else columns
    named = dict.fromkeys(s.topics for s in profile.channels.values() if s.topic is not None and not s.optional)
    gone += [" or ".join(names) for names in named if not any(member_of(name, t) is not None for t in topics for name in names)]
    there = [*topics, *(f for fields in topics.values() for f in fields)]
    return (*gone, *(f"not {a}" for a in profile.absent if any(text_table.fits(a, name) for name in there)))


def missing_in_blocks(blocks: Iterable[Block], profile: Profile) -> tuple[str, ...]:
    """The same of a log that comes as blocks, several of one topic joined."""
    return missing_in({name: topic.fields for name, topic in joined(blocks)[0].items()}, profile)


def read_blocks(path: Path, profile: Profile, blocks: Iterable[Block]) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing topic, field and column, or what else makes it useless."""
    topics, findings = joined(blocks)
    parts = [*_by_topic(path, profile, topics), *_by_column(path, profile, topics)]
    clocked = [_clocked(path, profile, part, findings) for part in parts]
    known = [(part, clock) for part, clock in zip(parts, clocked, strict=True) if clock is not None]
    if not known:
        raise BadInput(f"{path}: no topic of profile {profile.name!r} has usable stamps", "see the topics with `rovval inspect`")
    if own := [part.topic.name for part, clock in known if clock.epoch_ns is None and any(c.epoch_ns is not None for _, c in known)]:
        said = f"{path}: the stamps of {', '.join(map(repr, own))} count from a start of their own, those of the other topics from 1970"
        raise BadInput(said, "take the recorder's stamps ([time] kind = \"record\") if the log has them")
    epoch = min((c.epoch_ns for _, c in known if c.epoch_ns is not None), default=None)
    starts = [float(c.t[0]) + _since(epoch, c) for _, c in known]
    signals = {}
    for part, clock in known:
        t = at_rest(clock.t + (_since(epoch, clock) - min(starts)))  # all channels share it
        for name, (source, fields) in part.channels.items():
            values = np.stack([part.topic.numbers[f][clock.rows] for f in fields], axis=1)
            signals[name] = Signal(t, values if len(fields) > 1 else values[:, 0], clock.stamp, source)
    facts = _facts(profile, parts, known, min(starts))
    markers = _markers(path, profile, topics, known, epoch, min(starts), findings)
    t0_ns = None if epoch is None else epoch + round(min(starts) * 1e9)
    return build(profile, signals.items(), path, sha256(path), t0_ns, findings, facts, markers)


def _markers(
    path: Path, profile: Profile, topics: Mapping[str, Topic], known: Sequence[tuple[Part, Clocked]], epoch: int | None, start: float, findings: list[Finding]
) -> tuple[Marker, ...]:
    """The moments that the log names, on the clock of its channels."""
    asked = profile.markers
    if asked is None:
        return ()
    tables = [part.topic for part, _ in known if part.table]
    topic = topics.get(asked.topic) if asked.topic else next(iter(tables), None)
    name = next((f for f in (topic.fields if topic else ()) if f == asked.field or (asked.column and text_table.fits(asked.column, f))), None)
    clock = None if topic is None or name is None else _clocked(path, profile, Part(topic, {}, False), [])
    if topic is None or name is None or clock is None:
        findings.append(not_there(profile))
        return ()
    texts = topic.texts[name] if name in topic.texts else _as_text(topic.numbers[name])
    return markers_of(profile, clock.t + (_since(epoch, clock) - start), [texts[row] for row in clock.rows.tolist()])


def _since(epoch: int | None, clock: Clocked) -> float:
    return 0.0 if epoch is None or clock.epoch_ns is None else (clock.epoch_ns - epoch) * 1e-9


def _facts(profile: Profile, parts: Sequence[Part], known: Sequence[tuple[Part, Clocked]], start: float) -> dict[str, str]:
    facts = {"rows": str(sum(len(c.rows) for _, c in known))}
    if names := ", ".join(p.topic.name for p in parts if p.topic.name):
        facts["topics"] = names
    if profile.time.kind == "time_of_day":
        facts["time_of_day_s_at_start"] = f"{start % DAY_S:.3f}"
    if profile.time.kind == "elapsed" or all(c.epoch_ns is None and c.stamp != "row" for _, c in known):
        facts["stamp_s_at_start"] = repr(start)
    if profile.time.kind == "datetime":
        facts["timezone"] = profile.time.timezone or "UTC where the stamps do not say theirs"
    for part in (p for p in parts if p.table):
        where = {n: (s, dict.fromkeys(fields, 0)) for n, (s, fields) in part.channels.items()}
        facts["columns_unused"] = ", ".join(unused(profile, part.topic.fields, where))
    return facts


def _by_topic(path: Path, profile: Profile, topics: Mapping[str, Topic]) -> list[Part]:
    """The parts of the channels that name a topic: of several names of one topic the first that the log has."""
    found: dict[str, dict[str, tuple[Source, tuple[str, ...]]]] = {}
    gone: dict[str, None] = {}
    for channel, source in profile.channels.items():
        pattern = next((p for p in source.topics if any(member_of(p, t) is not None for t in topics)), None)
        if pattern is None:
            gone |= {} if source.optional or not source.topics else {" or ".join(source.topics): None}
            continue
        for topic in topics.values():
            if (stars := member_of(pattern, topic.name)) is None:
                continue
            fields = _fields(topic, str(source.field), channel == ATTITUDE)
            if fields is not None:
                found.setdefault(topic.name, {})[channel.replace("*", stars)] = (source, fields)
            elif not source.optional:
                gone[f"{topic.name} has no number {source.field!r}; it has: {', '.join(list(topic.numbers)[:8])}"] = None
    if gone:
        raise BadInput(all_at_once(list(gone), f"{path}: missing of profile {profile.name!r}"), "see the topics with `rovval inspect`")
    return [Part(topics[name], channels, False) for name, channels in found.items()]


def _fields(topic: Topic, name: str, quaternion: bool) -> tuple[str, ...] | None:
    ways = [tuple(way.format(name).split()) for way in QUATERNION] if quaternion else [(name,)]
    return next((way for way in ways if all(f in topic.numbers for f in way)), None)


def _by_column(path: Path, profile: Profile, topics: Mapping[str, Topic]) -> list[Part]:
    """The part of the channels that name columns: of the one table that has all that are required."""
    channels = {name: source for name, source in profile.channels.items() if source.topic is None}
    if not channels:
        return []
    if not topics:
        raise BadInput(f"{path}: holds no table", "is this the whole file?")
    required = wanted(profile, required=True)
    lacking = {name: len(_lacking(required, topic.fields)) for name, topic in topics.items()}
    best = [name for name, count in lacking.items() if count == min(lacking.values())]
    if len(best) > 1 and lacking[best[0]] == 0:
        raise BadInput(f"{path}: {len(best)} tables have the columns of profile {profile.name!r}: {', '.join(map(repr, best))}", _WHICH)
    topic = topics[best[0]]
    where = columns_of(path, profile.model_copy(update={"channels": channels}), topic.fields)
    texts = [f"{c!r} (such as {next(filter(None, topic.texts[c]), '')!r})" for _, held in where.values() for c in held if c in topic.texts]
    if texts:
        raise BadInput(all_at_once(texts, f"{path}: columns that hold no numbers"), "mend them, or name others in the profile")
    return [Part(topic, {name: (source, tuple(held)) for name, (source, held) in where.items()}, True)]


_WHICH = "say which with topic = and field = in place of column = in a profile of your own"


def _lacking(columns: Iterable[str], fields: Sequence[str]) -> list[str]:
    return [c for c in columns if not any(text_table.fits(c, f) for f in fields)]


def _clocked(path: Path, profile: Profile, part: Part, findings: list[Finding]) -> Clocked | None:
    """The part's rows in order of time; None, with a finding, of a topic that has no usable stamps. Raises `BadInput` for a table."""
    topic = part.topic
    t, epoch_ns, stamp = _logged(path, profile, topic, findings)
    where = f"{path}: {topic.name}" if topic.name else str(path)
    try:
        rows, t, found = increasing_stamps(t, np.arange(1, topic.rows + 1), where)
    except BadInput as error:
        if part.table:
            raise
        findings.append(Finding("unusable_topic", topic.name, error.message.removeprefix(f"{where}: ")))
        return None
    findings += [Finding(f.code, topic.name or f.where, f.detail.replace("line ", "row ").replace("lines ", "rows ")) for f in found]
    for fields in (f for _, f in part.channels.values() if part.table):
        for name in fields:
            if gone := int(np.isnan(topic.numbers[name]).sum()):
                first = int(np.flatnonzero(np.isnan(topic.numbers[name]))[0]) + 1
                findings.append(Finding("blank_cell", name, f"{counted(gone, 'blank cell')}, from row {first}; taken as missing"))
    return Clocked(rows, t, epoch_ns, stamp)


def _logged(path: Path, profile: Profile, topic: Topic, findings: list[Finding]) -> tuple[Array, int | None, str]:
    """Stamps as logged (s), what they count from, and which clock they are."""
    if profile.time.kind not in MESSAGE_CLOCKS:
        return (*_column_stamps(path, profile, topic), "row")
    kind = profile.time.kind if profile.time.kind in topic.clocks else "record"
    if kind == "header" and np.isnan(topic.clocks["header"]).any() and "record" in topic.clocks:
        findings.append(Finding("stamp", topic.name, "some header stamps are missing; the recorder's stamps are used"))
        kind = "record"
    if kind not in topic.clocks:
        hint = "name the column that holds its stamps: [time] with kind epoch, elapsed, datetime or time_of_day, and columns"
        raise BadInput(f"{path}: profile {profile.name!r} takes stamps from {profile.time.kind}, {topic.name or 'this table'} has none", hint)
    t = topic.clocks[kind]
    first = float(np.nanmin(t)) if np.isfinite(t).any() else 0.0
    whole = int(first) if first > UNIX_TIME_S else 0
    return t - whole, whole * 10**9 if whole else None, kind


def _column_stamps(path: Path, profile: Profile, topic: Topic) -> tuple[Array, int | None]:
    import polars as pl

    from rovval.ingest.clocks.stamps import stamps

    names = {}
    for column in profile.time.columns:
        hits = [f for f in topic.fields if f == column] or [f for f in topic.fields if text_table.fits(column, f)]
        if len(hits) != 1:
            said = f"{len(hits)} columns {column!r}" if hits else f"no column {column!r}; it has: {', '.join(topic.fields[:8])}"
            raise BadInput(f"{path}: the stamps of profile {profile.name!r}: {topic.name or 'the table'} has {said}", "mend [time] of the profile")
        names[f"time.{column}"] = hits[0]
    text = pl.DataFrame({key: topic.texts[n] if n in topic.texts else _as_text(topic.numbers[n]) for key, n in names.items()})
    values = {key: topic.numbers.get(n, np.full(topic.rows, np.nan)) for key, n in names.items()}
    return stamps(path, profile, text, values)


def _as_text(values: Array) -> list[str]:
    return [str(int(v)) if v.is_integer() else repr(v) if np.isfinite(v) else "" for v in values.tolist()]
