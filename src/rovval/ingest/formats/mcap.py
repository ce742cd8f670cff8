"""MCAP with other messages than those of ROS (which `ros_bag` reads): JSON and Protocol Buffers, and ROS's beside them.

Stamps: ``record`` is the log time; ``header`` the message's own, from ``header.stamp`` or ``timestamp`` where that has seconds and nanoseconds.
"""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Iterator, Mapping
from datetime import UTC, datetime
from itertools import takewhile
from pathlib import Path
from typing import Any

from rovval.core.counts import counted
from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding, UsageProblem
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block, Collector
from rovval.ingest.contents.flatten import flat
from rovval.ingest.profile import Profile

SUFFIXES = (".mcap",)
ALSO: tuple[str, ...] = ("ros_bag",)
MAGIC = b"\x89MCAP0\r\n"  # MCAP specification
OF_ROS = ("cdr", "ros1")  # message encodings that `ros_bag` reads
TOLD_EVERY = 5_000  # messages between two words on how far it is
LONGEST_RECORD = 1 << 32  # bytes that a record may claim: a damaged length is no reason to ask for all memory
STAMPS = ("header.stamp", "timestamp", "stamp")
SECONDS, NANOSECONDS = ("sec", "secs", "seconds"), ("nanosec", "nsec", "nsecs", "nanos")
Decoder = Callable[[bytes], Any]


def sniff(path: Path) -> bool:
    """Whether the file is MCAP with other messages than those of ROS."""
    return holds_other_messages(path)


def holds_other_messages(path: Path) -> bool:
    """Whether the file is MCAP with messages that are not serialised as ROS does; of a file without its end the first channels decide."""
    from mcap.records import Message

    with path.open("rb") as file:
        if file.read(len(MAGIC)) != MAGIC:
            return False
    if (channels := _channels(path)) is None:
        try:
            channels = [r for r in takewhile(lambda r: not isinstance(r, Message), _records(path, [])) if hasattr(r, "message_encoding")]
        except BadInput:
            return False  # nothing in it can be read: the reader of bags says what is wrong
    return any(channel.message_encoding not in OF_ROS for channel in channels)


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required topics of ``profile`` that the file has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in

    return missing_in(dict.fromkeys(_topics(path), ()), profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming everything that is missing, `UsageProblem` without what decodes its messages."""
    from rovval.ingest.assembly.topics import member_of, read_blocks

    patterns = {p for s in profile.channels.values() for p in s.topics}
    return read_blocks(path, profile, _blocks(path, lambda topic: any(member_of(p, topic) is not None for p in patterns), progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """Every topic with its fields, log times and the stamps of headers. What cannot be decoded is a finding; damage is one where something
    was read before it."""
    return _blocks(path, lambda topic: True, progress)


def _topics(path: Path) -> set[str]:
    """Names of the topics, by the file's summary where it has one."""
    channels = _channels(path)
    return {r.topic for r in (channels if channels is not None else _records(path, [])) if hasattr(r, "message_encoding")}


def _summary(path: Path) -> Any:
    """The end of the file: which channels it has and where its chunks begin; None of a file without its end."""
    import zstandard
    from mcap.exceptions import McapError
    from mcap.reader import make_reader

    try:
        with path.open("rb") as file:
            return make_reader(file).get_summary()
    except (McapError, zstandard.ZstdError, ValueError, RuntimeError, OSError, OverflowError, MemoryError, struct.error):
        return None


def _channels(path: Path) -> list[Any] | None:
    """The channels that the end of the file lists; None of a file without its end."""
    summary = _summary(path)
    return list(summary.channels.values()) if summary is not None and summary.channels else None


def _blocks(path: Path, wanted: Callable[[str], bool], progress: Progress) -> Iterator[Block]:
    from mcap.records import Channel, Message, Schema

    schemas: dict[int, Any] = {}
    topics: dict[int, tuple[str, str, Decoder | None]] = {}
    findings: list[Finding] = []
    undecoded: dict[str, str] = {}
    collector, seen = Collector(), set[int]()
    for record in _records(path, findings, progress):
        if isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel) and record.id not in topics and wanted(record.topic):
            schema = schemas.get(record.schema_id)
            topics[record.id] = (record.topic, schema.name if schema else record.message_encoding, _decoder(path, record, schema, undecoded))
        elif isinstance(record, Message) and record.channel_id in topics:
            topic, kind, decode = topics[record.channel_id]
            seen.add(record.channel_id)
            if decode is None:
                continue
            try:
                fields, left_out = flat(decode(record.data))
            except Exception as error:  # a decoder of another's making: whatever it raises, this message is not what its schema says
                undecoded[topic] = f"a message of {kind} is not what its schema says ({type(error).__name__}: {error}); left out"
                continue
            if block := collector.add(topic, kind, {"record": record.log_time * 1e-9, **_header(fields)}, fields, left_out):
                yield block
    yield from collector.rest()
    yield from (Block(topic, kind) for channel, (topic, kind, _) in topics.items() if channel not in seen)
    findings += [Finding("undecoded", topic, why) for topic, why in undecoded.items()]
    yield Block("", findings=tuple(findings))


def _records(path: Path, findings: list[Finding], progress: Progress = silent) -> Iterator[Any]:
    """Every record outside of the file's end, checked by its CRC; a chunk that is damaged is passed over where the file's end says where the next one
    begins, and what is lost is a finding. Raises `BadInput` where no message can be read."""
    import zstandard
    from mcap.exceptions import McapError
    from mcap.records import DataEnd, Message
    from mcap.stream_reader import StreamReader

    count, last, lost, why, good = 0, 0, 0, "", len(MAGIC)
    summary = _summary(path)
    size = path.stat().st_size  # a damaged index points anywhere
    chunks = [] if summary is None else sorted(c.chunk_start_offset for c in summary.chunk_indexes if c.chunk_start_offset < size)
    with path.open("rb") as file:
        at: int | None = 0
        while at is not None:
            file.seek(at)
            try:
                for record in StreamReader(file, skip_magic=at > 0, validate_crcs=True, record_size_limit=LONGEST_RECORD).records:
                    if isinstance(record, DataEnd):
                        break
                    if isinstance(record, Message):
                        count, last = count + 1, record.log_time
                        if count % TOLD_EVERY == 0:
                            progress("reading messages", file.tell() / path.stat().st_size)
                    good = max(good, file.tell())
                    yield record
                else:
                    why = "ends without its summary"
                at = None
            except (McapError, zstandard.ZstdError, ValueError, RuntimeError, OSError, EOFError, OverflowError, MemoryError, struct.error) as error:
                why = f"{type(error).__name__}{str(error) and ': '}{error}"
                at = next((place for place in chunks if place > max(at or 0, good - 1)), None)
                lost += 1
    if not count:
        raise BadInput(f"{path}: no message can be read: the file is damaged: {why}", "`mcap recover` may mend it")
    told = f"{counted(count, 'message is', 'messages are')} read, to {datetime.fromtimestamp(last * 1e-9, UTC):%H:%M:%S} UTC; "
    if why and summary is None:
        findings.append(Finding("cut_file", path.name, f"{told}the file is cut there, or damaged ({why})"))
    elif lost:
        findings.append(Finding("damaged_file", path.name, f"{told}{counted(lost, 'time')} something cannot be read and is left out ({why})"))


def _decoder(path: Path, channel: Any, schema: Any, undecoded: dict[str, str]) -> Decoder | None:
    """What turns the bytes of a channel's messages into fields; None, with the reason among ``undecoded``, where nothing does."""
    kind = schema.name if schema else ""
    way = (channel.message_encoding, schema.encoding if schema else "")
    if way[0] == "json":
        return _json
    if way == ("protobuf", "protobuf"):
        return _protobuf(path, schema)
    if way in (("ros1", "ros1msg"), ("cdr", "ros2msg"), ("cdr", "ros2idl")):
        return _ros(schema, way)
    undecoded[channel.topic] = f"messages of {kind or 'no schema'} are encoded as {'/'.join(filter(None, way))}, which is not read; left out"
    return None


def _json(data: bytes) -> Mapping[str, Any]:
    found = json.loads(data)
    return found if isinstance(found, dict) else {"data": found}


def _protobuf(path: Path, schema: Any) -> Decoder:
    try:
        from mcap_protobuf.decoder import DecoderFactory
    except ImportError:
        raise UsageProblem(f"{path}: messages as Protocol Buffers need mcap-protobuf-support", "pip install 'rovval[protobuf]'") from None
    decode = DecoderFactory().decoder_for("protobuf", schema)
    return lambda data: _members(decode(data)) if decode else {}


def _members(message: Any) -> Any:
    """A message of Protocol Buffers as a mapping of its fields; its lists and messages inside likewise."""
    if hasattr(message, "DESCRIPTOR"):
        return {f.name: _members(getattr(message, f.name)) for f in message.DESCRIPTOR.fields}
    return message if isinstance(message, (str, bytes, bool, int, float)) else [_members(part) for part in message]


def _ros(schema: Any, way: tuple[str, str]) -> Decoder:
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

    store = get_typestore(Stores.EMPTY)
    text, name = schema.data.decode(), schema.name if schema.name.count("/") == 2 else schema.name.replace("/", "/msg/")
    store.register(get_types_from_idl(text) if way[1] == "ros2idl" else get_types_from_msg(text, name))
    return lambda data: store.deserialize_ros1(data, name) if way[0] == "ros1" else store.deserialize_cdr(data, name)


def _header(fields: Mapping[str, float | str]) -> dict[str, float]:
    for stamp in STAMPS:
        s = next((fields[f"{stamp}.{n}"] for n in SECONDS if f"{stamp}.{n}" in fields), None)
        ns = next((fields[f"{stamp}.{n}"] for n in NANOSECONDS if f"{stamp}.{n}" in fields), None)
        if isinstance(s, float) and isinstance(ns, float):
            return {"header": s + ns * 1e-9 if s or ns else float("nan")}
    return {}
