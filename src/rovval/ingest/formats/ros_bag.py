"""ROS 1 .bag and ROS 2 bags (folder, bare .db3 or .mcap). One reader per file, since definitions differ between files."""

from __future__ import annotations

import re
import shutil
import sqlite3
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np

from rovval.core.data import Array, RawLog
from rovval.core.errors import BadInput, Finding, RovvalError, all_at_once
from rovval.ingest.clock import increasing_stamps
from rovval.ingest.files import sha256
from rovval.ingest.inspection.block import Block, Collector
from rovval.ingest.inspection.flatten import flat
from rovval.ingest.profile import ATTITUDE, Profile, Source

SUFFIXES = (".bag", ".db3", ".mcap", "")  # "": a folder
MAGIC = (b"#ROSBAG V2.0", b"SQLite format 3\0", b"\x89MCAP0\r\n")
SIM_TIME_NS = 10**18  # stamps before 2001 count from the start of a simulation, not from 1970
Get = Callable[[Any], Any]


def sniff(path: Path) -> bool:
    """Whether the file starts as a bag does, or the folder holds one."""
    if path.is_dir():
        return bool(_inside(path)) or (path / "metadata.yaml").is_file()
    with path.open("rb") as file:
        return file.read(16).startswith(MAGIC)


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required topics of ``profile`` that the bag has not, and `absent` ones that it has."""
    with _opened(path, profile.messages) as (reader, _):
        return _missing([c.topic for c in reader.connections], profile)


def _missing(topics: list[str], profile: Profile) -> tuple[str, ...]:
    wanted = dict.fromkeys(s.topics for s in profile.channels.values() if not s.optional)
    gone = [" or ".join(names) for names in wanted if not any(fnmatchcase(t, name) for t in topics for name in names)]
    return (*gone, *(f"not {a}" for a in profile.absent if a in topics))


def read(path: Path, profile: Profile) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing topic and field, or what makes the bag unreadable."""
    from rovval.ingest.assembly import build

    if profile.time.kind not in ("header", "record"):
        raise BadInput(f"{path}: profile {profile.name!r} takes stamps from {profile.time.kind}, a bag has header or record", "give --profile")
    with _opened(path, profile.messages) as (reader, findings):
        if gone := [m for m in _missing([c.topic for c in reader.connections], profile) if not m.startswith("not ")]:
            hint = "see `rovval show profile`, or give another"
            raise BadInput(all_at_once(gone, f"{path}: missing topics of profile {profile.name!r}"), hint)
        topics = _collect(path, reader, _with_topics_of(profile, [c.topic for c in reader.connections]))
    findings = list(findings)
    stamps = [ns for t in topics.values() for ns in (t.header if t.stamp == "header" else t.record)]
    if not stamps:
        raise BadInput(f"{path}: no message on any topic of profile {profile.name!r}", "is this the right recording?")
    t0 = min(stamps)
    signals: dict[str, Any] = {}
    for topic in topics.values():
        signals |= _signals(path, topic, t0, findings)
    facts = {"topics": ", ".join(topics), "messages": str(sum(len(t.record) for t in topics.values()))}
    lags = [h - r for t in topics.values() if t.stamp == "header" for h, r in zip(t.header, t.record, strict=True)]
    if lags:
        facts["record_minus_header_s"] = f"{-np.median(lags) * 1e-9:.4f}"
    return build(profile, signals, path, sha256(path), t0 if t0 > SIM_TIME_NS else None, findings, facts)


def contents(path: Path) -> Iterator[Block]:
    """Every topic of the bag with its fields, header and record stamps. Raises `BadInput` where the bag cannot be read."""
    collector, done = Collector(), 0
    with _opened(path, {}) as (reader, findings):
        if findings:
            yield Block("", findings=tuple(findings))
        with _stage(path, "reading messages", lambda: f"{done} messages were read"):
            for connection, ns, raw in reader.messages():
                message = reader.deserialize(raw, connection.msgtype)
                fields, left_out = flat(message)
                stamp = _header_ns(message)
                clocks = {"record": ns * 1e-9, **({} if stamp is None else {"header": stamp * 1e-9 if stamp else np.nan})}
                values = {n: v for n, v in fields.items() if not n.startswith("header.")}
                if block := collector.add(connection.topic, connection.msgtype, clocks, values, left_out):
                    yield block
                done += 1
        silent = [c for c in reader.connections if not c.msgcount]
    yield from collector.rest()
    yield from (Block(c.topic, c.msgtype) for c in silent)


def _header_ns(message: Any) -> int | None:
    """The header's stamp in ns, 0 where a driver leaves it empty; None for a message without header."""
    stamp = getattr(getattr(message, "header", None), "stamp", None)
    return None if stamp is None else int(stamp.sec) * 10**9 + int(stamp.nanosec)


def _with_topics_of(profile: Profile, topics: list[str]) -> Profile:
    """The profile with one name for each topic: of several the first that the bag has."""
    one = {}
    for name, source in profile.channels.items():
        held = [known for known in source.topics if any(fnmatchcase(t, known) for t in topics)]
        one[name] = source.model_copy(update={"topic": held[0]}) if held else source
    return profile.model_copy(update={"channels": one})


@dataclass(slots=True)
class _Topic:
    """What is collected of one topic: both clocks, and a column per channel."""

    name: str
    stamp: str
    channels: dict[str, tuple[Source, Get]]
    header: list[int] = field(default_factory=list)
    record: list[int] = field(default_factory=list)
    columns: dict[str, list[Any]] = field(default_factory=dict)


def _collect(path: Path, reader: Any, profile: Profile) -> dict[str, _Topic]:
    topics: dict[str, _Topic] = {}
    connections = [c for c in reader.connections if _channels(c.topic, profile)]
    for c in connections:
        topics.setdefault(c.topic, _Topic(c.topic, profile.time.kind, _channels(c.topic, profile)))
    types = {c.topic: c.msgtype for c in connections}
    wrong: dict[str, None] = {}
    done = 0
    with _stage(path, "reading messages", lambda: f"{done} messages were read"):
        for connection, ns, raw in reader.messages(connections=connections):
            message = reader.deserialize(raw, connection.msgtype)
            wrong |= dict.fromkeys(_take(topics[connection.topic], message, ns, types[connection.topic]))
            done += 1
            if wrong and done > 1000:
                break
    if wrong:
        raise BadInput(all_at_once(list(wrong), f"{path}: fields that profile {profile.name!r} names"), "mend the profile's field")
    return topics


def _take(topic: _Topic, message: Any, ns: int, kind: str) -> list[str]:
    """Put one message into its topic's columns; returns the fields that it does not have."""
    values, wrong = {}, []
    for name, (source, get) in topic.channels.items():
        try:
            values[name] = get(message)
        except (AttributeError, IndexError, TypeError, ValueError):
            wrong.append(f"{topic.name} ({kind}) has no number {source.field!r}")
    if wrong:
        return wrong
    for name, value in values.items():
        topic.columns.setdefault(name, []).append(value)
    topic.header.append(_header_ns(message) or 0)
    topic.record.append(int(ns))
    if topic.stamp == "header" and topic.header[-1] == 0:
        topic.stamp = "record"  # no header, or a driver that leaves it empty
    return []


def _signals(path: Path, topic: _Topic, t0: int, findings: list[Finding]) -> dict[str, Any]:
    from rovval.ingest.assembly import Signal

    if topic.stamp == "record" and any(topic.header):
        findings.append(Finding("stamp", topic.name, "some header stamps are zero; the recorder's stamps are used"))
    ns = np.array(topic.header if topic.stamp == "header" else topic.record, dtype=np.int64)
    where = f"{path}: {topic.name}"
    try:
        rows, t, found = increasing_stamps(np.asarray((ns - t0) * 1e-9, dtype=np.float64), np.arange(1, len(ns) + 1), where)
    except BadInput as error:
        findings.append(Finding("unusable_topic", topic.name, error.message.removeprefix(f"{where}: ")))
        return {}
    findings += [Finding(f.code, topic.name, f.detail.replace("line", "message").replace("row", "message")) for f in found]
    columns: dict[str, Array] = {n: np.array(c, dtype=float)[rows] for n, c in topic.columns.items()}
    return {n: Signal(t, c, topic.stamp, topic.channels[n][0]) for n, c in columns.items()}


def _channels(topic: str, profile: Profile) -> dict[str, tuple[Source, Get]]:
    """Channels that the profile takes from ``topic``, each with how to get it out of a message."""
    out = {}
    for name, source in profile.channels.items():
        if isinstance(source.topic, str) and fnmatchcase(topic, source.topic):
            found = re.fullmatch(re.escape(source.topic).replace(r"\*", "(.+)"), topic)
            member = found.group(1) if found and found.groups() else ""
            out[name.replace("*", member)] = (source, _getter(str(source.field), name == ATTITUDE))
    return out


def _getter(address: str, quaternion: bool) -> Get:
    steps = re.findall(r"[A-Za-z_]\w*|\[\d+\]", address)

    def get(message: Any) -> Any:
        for step in steps:
            message = message[int(step[1:-1])] if step.startswith("[") else getattr(message, step)
        if quaternion:
            return float(message.w), float(message.x), float(message.y), float(message.z)
        return float(message)

    return get


@contextmanager
def _opened(path: Path, definitions: Mapping[str, str]) -> Iterator[tuple[Any, list[Finding]]]:
    """The bag's reader, and what was found while opening it."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS2_HUMBLE)
    with tempfile.TemporaryDirectory(prefix="rovval-") as scratch:
        found: list[Finding] = []
        with _stage(path, "opening"):
            for name, text in definitions.items():
                store.register(get_types_from_msg(text, name))
            reader = AnyReader([_whole(_bag(path), Path(scratch), found)], default_typestore=store)
            reader.open()
        try:
            yield reader, found
        finally:
            reader.close()


def _inside(folder: Path) -> list[Path]:
    return sorted(p for p in folder.iterdir() if p.suffix in (".db3", ".mcap"))


def _bag(path: Path) -> Path:
    """What to open: a folder without metadata.yaml stands for the one file in it."""
    if not path.is_dir() or (path / "metadata.yaml").is_file():
        return path
    inside = _inside(path)
    if len(inside) != 1:
        names = ", ".join(p.name for p in inside) or "none"
        raise BadInput(f"{path}: a folder without metadata.yaml and with {len(inside)} bag files ({names})", "give one of the files")
    return inside[0]


def _whole(bag: Path, scratch: Path, found: list[Finding]) -> Path:
    """The bag with what a crashed recorder left in SQLite's write-ahead log put back into it, in a copy.

    rosbags opens a db3 as immutable and would leave those messages out without a word.
    """
    files = [bag] if bag.is_file() else _inside(bag)
    left = [f for f in files if f.suffix == ".db3" and (wal := f.with_name(f.name + "-wal")).is_file() and wal.stat().st_size]
    if not left:
        return bag
    copy = scratch / bag.name
    if bag.is_dir():
        shutil.copytree(bag, copy)
    else:
        shutil.copy(bag, copy)
        shutil.copy(bag.with_name(bag.name + "-wal"), scratch)
    for file in left:
        database = sqlite3.connect(copy / file.name if bag.is_dir() else copy)
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        database.close()
    names = ", ".join(f.name for f in left)
    found.append(Finding("write_ahead_log", names, "the recorder did not close the file; messages of its write-ahead log are included"))
    return copy


@contextmanager
def _stage(path: Path, stage: str, done: Callable[[], str] = lambda: "") -> Iterator[None]:
    """Damaged bags make rosbags raise a dozen unrelated types: all become one refusal."""
    try:
        yield
    except (RovvalError, KeyboardInterrupt):
        raise
    except Exception as error:
        so_far = f"; {done()}" if done() else ""
        said = str(error).splitlines()[0] if str(error) else ""
        hint = "is the file whole? `rosbag reindex` (ROS 1), `mcap recover` or `ros2 bag reindex` may mend it"
        if "not ros2" in said:
            hint = "this mcap is not of ROS 2; convert it, or export it as CSV"
        if isinstance(error, KeyError) or "type definitions" in said:
            hint = "the bag does not define its message types; put their .msg texts into [messages] of a profile"
        raise BadInput(f"{path}: damaged or foreign, while {stage}: {type(error).__name__}: {said}{so_far}", hint) from None
