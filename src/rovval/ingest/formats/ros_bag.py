"""ROS 1 .bag and ROS 2 bags (folder, bare .db3 or .mcap): the topics that a profile names, as columns. Of a damaged file, what is left."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.counts import counted
from rovval.core.data import Array, RawLog
from rovval.core.errors import BadInput, Finding, RovvalError, all_at_once
from rovval.core.progress import Progress, silent
from rovval.ingest.bags import recording
from rovval.ingest.bags.block import Block as Messages
from rovval.ingest.bags.block import Connection, Index
from rovval.ingest.bags.columns import Columns, Layouts, header_ns, types_of
from rovval.ingest.bags.layout import Layout
from rovval.ingest.bags.recording import Recording
from rovval.ingest.clocks.clock import increasing_stamps
from rovval.ingest.contents.block import MOST_MEMBERS, Block
from rovval.ingest.contents.flatten import LONGEST_TEXT
from rovval.ingest.files import sha256
from rovval.ingest.formats.mcap import holds_other_messages
from rovval.ingest.profile import ATTITUDE, Profile, Source

SUFFIXES = (*recording.SUFFIXES, "")  # "": a folder
ALSO: tuple[str, ...] = ()  # formats whose profiles this reads beside its own
SIM_TIME_NS = 10**18  # stamps before 2001 count from the start of a simulation, not from 1970
QUATERNION = ("w", "x", "y", "z")


def sniff(path: Path) -> bool:
    """Whether the file starts as a bag does, or the folder holds one."""
    if path.is_dir():
        return bool(recording.inside(path)) or (path / "metadata.yaml").is_file()
    with path.open("rb") as file:
        known = file.read(16).startswith(recording.MAGIC)
    return known and not holds_other_messages(path)


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required topics of ``profile`` that the bag has not, and `absent` ones that it has."""
    with _opened(path) as (bag, _):
        return _missing([c.topic for c in bag.connections()], profile)


def _missing(topics: list[str], profile: Profile) -> tuple[str, ...]:
    wanted = dict.fromkeys(s.topics for s in profile.channels.values() if not s.optional)
    gone = [" or ".join(names) for names in wanted if not any(fnmatchcase(t, name) for t in topics for name in names)]
    return (*gone, *(f"not {a}" for a in profile.absent if a in topics))


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing topic and field, or what makes the bag unreadable."""
    from rovval.ingest.assembly import build
    from rovval.ingest.assembly.markers import markers_of, not_there

    if profile.time.kind not in ("header", "record"):
        raise BadInput(f"{path}: profile {profile.name!r} takes stamps from {profile.time.kind}, a bag has header or record", "give --profile")
    with _opened(path) as (bag, findings):
        connections = bag.connections()
        if not connections and (foreign := bag.foreign()):
            told = ", ".join(f"{topic} is {how}" for topic, how in list(foreign.items())[:3])
            raise BadInput(f"{path}: no topic is serialised as ROS does: {told}", "this mcap is not of ROS; give a profile of its own format")
        if gone := [m for m in _missing([c.topic for c in connections], profile) if not m.startswith("not ")]:
            hint = "see `rovval show profile`, or give another"
            raise BadInput(all_at_once(gone, f"{path}: missing topics of profile {profile.name!r}"), hint)
        notes = _Notes(profile)
        topics = _collect(path, bag, connections, _with_topics_of(profile, [c.topic for c in connections]), findings, notes, progress)
        findings += bag.findings()
    topics = {name: topic for name, topic in topics.items() if len(topic.record)}
    if not topics:
        raise BadInput(f"{path}: no message on any topic of profile {profile.name!r}", "is this the right recording?")
    t0 = int(min((t.header if t.stamp == "header" else t.record).min() for t in topics.values()))
    signals: dict[str, Any] = {}
    for topic in topics.values():
        signals |= _signals(path, topic, t0, findings)
    facts = {"topics": ", ".join(topics), "messages": str(sum(len(t.record) for t in topics.values()))}
    if lags := [t.header - t.record for t in topics.values() if t.stamp == "header"]:
        facts["record_minus_header_s"] = f"{-np.median(np.concatenate(lags)) * 1e-9:.4f}"
    if profile.markers and not notes.texts:
        findings.append(not_there(profile))
    markers = markers_of(profile, np.asarray((np.array(notes.ns, dtype=np.int64) - t0) * 1e-9, dtype=np.float64), notes.texts)
    return build(profile, signals.items(), path, sha256(path), t0 if t0 > SIM_TIME_NS else None, findings, facts, markers)


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """Every topic of the bag with its fields, header and record stamps. Raises `BadInput` where the bag cannot be read."""
    with _opened(path) as (bag, findings):
        connections = bag.connections()
        silent = {(c.topic, c.kind) for c in connections}
        with _stage(path, "reading messages"):
            types = types_of(connections, {})
            layouts = {c: Layouts(c, types) for c in connections}
            for block in bag.blocks(frozenset(c.topic for c in connections)):
                progress("reading messages", bag.share)
                for found, rows in layouts[block.connection].of(block) if block.connection in layouts else ():
                    silent.discard((block.connection.topic, block.connection.kind))
                    yield _as_logged(block, found, rows)
        if found_ := (*findings, *bag.findings()):
            yield Block("", findings=tuple(found_))
    yield from (Block(topic, kind) for topic, kind in sorted(silent))


def _as_logged(block: Messages, found: Layout, rows: Index) -> Block:
    """All fields of the messages of one layout."""
    starts, stamps = block.start[rows], header_ns(found, block, rows)
    clocks: dict[str, Array] = {"record": np.asarray(block.record_ns[rows] * 1e-9)}
    if stamps is not None:
        clocks["header"] = np.where(stamps != 0, stamps * 1e-9, np.nan)
    few = {a: n for a, (_, _, n) in found.numbers.items() if n <= MOST_MEMBERS and not a.startswith("header.")}
    addresses = [name for a, n in few.items() for name in ([f"{a}[{i}]" for i in range(n)] or [a])]
    numbers = {a: column for a in addresses if (column := found.column(block.data, starts, a)) is not None}
    short = [a for a, (_, size) in found.texts.items() if size <= LONGEST_TEXT and not a.startswith("header.")]
    left_out = {a: f"{n} elements" for a, (_, _, n) in found.numbers.items() if n > MOST_MEMBERS}
    left_out |= {a: f"text of {size} characters" for a, (_, size) in found.texts.items() if size > LONGEST_TEXT}
    texts = {a: found.text(block.data, starts, a) for a in short}
    return Block(block.connection.topic, block.connection.kind, clocks, numbers, texts, left_out=left_out)


def _with_topics_of(profile: Profile, topics: list[str]) -> Profile:
    """The profile with one name for each topic: of several the first that the bag has."""
    one = {}
    for name, source in profile.channels.items():
        held = [known for known in source.topics if any(fnmatchcase(t, known) for t in topics)]
        one[name] = source.model_copy(update={"topic": held[0]}) if held else source
    return profile.model_copy(update={"channels": one})


Channels = dict[str, tuple[Source, tuple[str, ...]]]  # channel -> where it comes from, and the addresses of its numbers in a message


@dataclass(frozen=True, slots=True)
class _Topic:
    """One topic's messages: both clocks (ns), the one to use, and a column or four per channel."""

    name: str
    stamp: str
    sources: dict[str, Source]
    record: Index
    header: Index
    columns: dict[str, Array]


class _Notes:
    """What the topic of a profile's markers says, and when (ns)."""

    def __init__(self, profile: Profile) -> None:
        self.topic, self.field = (profile.markers.topic or "", profile.markers.field or "") if profile.markers else ("", "")
        self.header = profile.time.kind == "header"
        self.ns: list[int] = []
        self.texts: list[str] = []

    def take(self, block: Messages, layouts: Layouts) -> None:
        """Append the messages of a block."""
        for found, rows in layouts.of(block):
            if self.field in found.texts:
                stamps = header_ns(found, block, rows) if self.header else None
                self.ns += (block.record_ns[rows] if stamps is None or not stamps.all() else stamps).tolist()
                self.texts += found.text(block.data, block.start[rows], self.field)


def _collect(
    path: Path, bag: Recording, connections: list[Connection], profile: Profile, findings: list[Finding], notes: _Notes,
    progress: Progress,
) -> dict[str, _Topic]:
    """Topic by topic what the profile reads. Raises `BadInput` with every field that no message has."""
    wanted = {c: channels for c in connections if (channels := _channels(c.topic, profile))}
    with _stage(path, "reading the types of its messages"):
        noted = [c for c in connections if c.topic == notes.topic]
        types = types_of([*wanted, *noted], profile.messages)
        said = {c: Layouts(c, types) for c in noted}
        found = {c: Columns(c, types, [a for _, addresses in channels.values() for a in addresses]) for c, channels in wanted.items()}
    with _stage(path, "reading messages"):
        for block in bag.blocks(frozenset(c.topic for c in (*wanted, *noted))):
            if block.connection in found:
                found[block.connection].take(block)
            progress("reading messages", bag.share)
            if block.connection in said:
                notes.take(block, said[block.connection])
    wrong: dict[str, None] = {}
    for c, columns in found.items():
        if columns.damaged:
            findings.append(Finding("damaged_message", c.topic, f"{counted(columns.damaged, 'message')} with lengths that are not those of {c.kind}; left out"))
        gone = [source.field for source, addresses in wanted[c].values() if columns.absent & set(addresses)] if columns.taken else []
        wrong |= dict.fromkeys(f"{c.topic} ({c.kind}) has no number {field!r}" for field in gone)
    if wrong:
        raise BadInput(all_at_once(list(wrong), f"{path}: fields that profile {profile.name!r} names"), "mend the profile's field")
    names = dict.fromkeys(c.topic for c in wanted)
    return {name: _topic(name, profile.time.kind, {c: k for c, k in found.items() if c.topic == name}, _channels(name, profile)) for name in names}


def _topic(name: str, clock: str, found: dict[Connection, Columns], channels: Channels) -> _Topic:
    """What several publishers sent on one topic, in the order in which it was recorded."""
    parts = [columns.arrays() for columns in found.values()]
    record, header = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    order = np.argsort(record, kind="stable")
    columns = {}
    for channel, (_, addresses) in channels.items():
        block = np.stack([np.concatenate([part[2][a] for part in parts])[order] for a in addresses], axis=1)
        columns[channel] = block if len(addresses) > 1 else block[:, 0]
    stamp = "header" if clock == "header" and len(header) and header.all() else "record"  # a driver may leave the header's empty
    return _Topic(name, stamp, {n: source for n, (source, _) in channels.items()}, record[order], header[order], columns)


def _signals(path: Path, topic: _Topic, t0: int, findings: list[Finding]) -> dict[str, Any]:
    from rovval.ingest.assembly import Signal

    if topic.stamp == "record" and topic.header.any():
        findings.append(Finding("stamp", topic.name, "some header stamps are zero; the recorder's stamps are used"))
    ns = topic.header if topic.stamp == "header" else topic.record
    where = f"{path}: {topic.name}"
    try:
        rows, t, found = increasing_stamps(np.asarray((ns - t0) * 1e-9, dtype=np.float64), np.arange(1, len(ns) + 1), where)
    except BadInput as error:
        findings.append(Finding("unusable_topic", topic.name, error.message.removeprefix(f"{where}: ")))
        return {}
    findings += [Finding(f.code, topic.name, f.detail.replace("line", "message").replace("row", "message")) for f in found]
    return {n: Signal(t, column[rows], topic.stamp, topic.sources[n]) for n, column in topic.columns.items()}


def _channels(topic: str, profile: Profile) -> Channels:
    """Channels that the profile takes from ``topic``."""
    out: Channels = {}
    for name, source in profile.channels.items():
        if isinstance(source.topic, str) and fnmatchcase(topic, source.topic):
            found = re.fullmatch(re.escape(source.topic).replace(r"\*", "(.+)"), topic)
            member = found.group(1) if found and found.groups() else ""
            field = str(source.field)
            out[name.replace("*", member)] = (source, tuple(f"{field}.{n}".lstrip(".") for n in QUATERNION) if name == ATTITUDE else (field,))
    return out


@contextmanager
def _opened(path: Path) -> Iterator[tuple[Recording, list[Finding]]]:
    """The recording, and what was found while opening it."""
    with tempfile.TemporaryDirectory(prefix="rovval-") as scratch:
        found: list[Finding] = []
        with _stage(path, "opening"):
            bag = recording.recording(path, Path(scratch), found)
        yield bag, found


@contextmanager
def _stage(path: Path, stage: str) -> Iterator[None]:
    """A bag that is no bag makes its libraries raise a dozen unrelated types: all become one refusal."""
    try:
        yield
    except (RovvalError, KeyboardInterrupt, OSError):
        raise
    except Exception as error:
        said = str(error).splitlines()[0] if str(error) else ""
        hint = "is the file whole? `rosbag reindex` (ROS 1), `mcap recover` or `ros2 bag reindex` may mend it"
        if isinstance(error, KeyError):
            hint = "the bag does not define its message types; put their .msg texts into [messages] of a profile"
        raise BadInput(f"{path}: damaged or foreign, while {stage}: {type(error).__name__}: {said}", hint) from None
