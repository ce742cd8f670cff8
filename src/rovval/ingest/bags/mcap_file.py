"""MCAP (mcap.dev/spec), read by its chunks: with a summary, without one, cut or spoiled. Every chunk is held against its CRC.

The records are parsed by the format's own library, all but messages: those stand at offsets of the chunk, to be read by the column.
"""

from __future__ import annotations

import io
import mmap
import struct
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import IO, Any, Literal, cast

import numpy as np

from rovval.core.errors import Finding
from rovval.ingest.bags.block import Block, Connection, numbers_at
from rovval.ingest.bags.damage import Damage

MAGIC = b"\x89MCAP0\r\n"
SCHEMA, CHANNEL, MESSAGE, CHUNK, DATA_END = 3, 4, 5, 6, 15  # opcodes
HEAD = struct.Struct("<BQ")  # opcode and length of every record
_length = struct.Struct("<Q").unpack_from
MESSAGE_HEAD = 22  # bytes of a message's record before its data: channel, sequence, two stamps
TOGETHER = 1 << 24  # bytes of messages outside chunks that are taken at a time
LANGUAGES: dict[str, Literal["msg", "idl"]] = {"ros1msg": "msg", "ros2msg": "msg", "ros2idl": "idl"}


class Mapped(mmap.mmap):
    """A file whose reads never ask for more memory than it has bytes, whatever a damaged length says."""

    def seekable(self) -> bool:
        """It is."""
        return True


class Mcap:
    """A `rovval.ingest.bags.block.Container`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.findings: list[Finding] = []
        self.foreign: dict[str, str] = {}
        self.share = 0.0
        with path.open("rb") as file:
            self._file = Mapped(file.fileno(), 0, access=mmap.ACCESS_READ)
        self._summary = self._read_summary()

    def _read_summary(self) -> Any:
        from mcap.exceptions import McapError
        from mcap.reader import make_reader

        try:
            return make_reader(cast(IO[bytes], self._file)).get_summary()
        except (McapError, ValueError, KeyError, struct.error, OverflowError, OSError, MemoryError):
            return None

    def connections(self) -> list[Connection]:
        """As the summary at the end has them, or, where there is none, as the chunks have them."""
        known = _Known(self.foreign)
        if self._summary is not None and self._summary.channels:
            for schema in self._summary.schemas.values():
                known.schemas[schema.id] = schema
            for channel in self._summary.channels.values():
                known.note_channel(channel)
        else:
            for _ in self._blocks(frozenset(), known, Damage()):
                pass
        return list(known.connections.values())

    def blocks(self, topics: frozenset[str]) -> Iterator[Block]:
        """The messages on ``topics``, chunk by chunk."""
        known, damage = _Known(self.foreign), Damage()
        yield from self._blocks(topics, known, damage)
        self.findings += damage.findings(self.path.name)

    def _blocks(self, topics: frozenset[str], known: _Known, damage: Damage) -> Iterator[Block]:
        """Walk the records of the file; where their lengths lead nowhere, go on with the next chunk that the summary knows."""
        at, end, loose = len(MAGIC), len(self._file), len(MAGIC)
        while at + HEAD.size <= end:
            op, length = HEAD.unpack_from(self._file, at)
            self.share = min(at + HEAD.size + length, end) / end
            after = at + HEAD.size + length
            if op != MESSAGE or at - loose > TOGETHER or after > end:
                yield from _messages(self._file[loose:at], topics, known, damage)
                loose = at
            if op == DATA_END and length == 4:
                self._hold_against_crc(at, known, damage)
                return
            if after > end or not 0 < op < 0x80:
                following = self._chunk_after(at)
                if following is None:
                    damage.cut = f"the file ends in the middle of a {'chunk' if op == CHUNK else 'record'}"
                    if op == CHUNK:
                        yield from _messages(_unpacked(self._file[at + HEAD.size :], damage), topics, known, damage)
                    return
                damage.lost["a record that cannot be read"] += 1
                at = loose = following
                continue
            if op == CHUNK:
                known.chunks += 1
                yield from _messages(_unpacked(self._file[at + HEAD.size : after], damage), topics, known, damage)
            elif op in (SCHEMA, CHANNEL):
                known.note(op, self._file[at + HEAD.size : after], damage)
            loose = loose if op == MESSAGE else after
            at = after
        yield from _messages(self._file[loose:at], topics, known, damage)
        damage.cut = "the file ends without its summary: the recorder did not close it, or it is cut"

    def _hold_against_crc(self, at: int, known: _Known, damage: Damage) -> None:
        """Messages outside chunks have the CRC of the whole file alone, which cannot say where it is spoiled."""
        (expected,) = struct.unpack_from("<I", self._file, at + HEAD.size)
        if expected and known.chunks == 0:
            with memoryview(self._file) as content, content[:at] as before:
                if zlib.crc32(before) != expected:
                    damage.lost["the file does not fit its CRC: some byte of it, which cannot be told, is not as it was written"] += 1

    def _chunk_after(self, at: int) -> int | None:
        places = [] if self._summary is None else sorted(c.chunk_start_offset for c in self._summary.chunk_indexes)
        return next((place for place in places if place > at and self._file[place] == CHUNK), None)


class _Known:
    """The schemas and channels, and how many chunks, that were met so far."""

    def __init__(self, foreign: dict[str, str]) -> None:
        self.schemas: dict[int, Any] = {}
        self.connections: dict[int, Connection] = {}
        self.foreign = foreign
        self.chunks = 0
        self.channels: set[int] = set()

    def note(self, op: int, content: bytes, damage: Damage) -> None:
        """A schema's or channel's record, unless it is damaged."""
        from mcap.data_stream import ReadDataStream
        from mcap.exceptions import McapError
        from mcap.records import Channel, Schema

        stream = ReadDataStream(io.BytesIO(content))
        try:
            if op == SCHEMA:
                schema = Schema.read(stream)
                self.schemas[schema.id] = schema
            else:
                self.note_channel(Channel.read(stream))
        except (McapError, ValueError, struct.error, OverflowError, MemoryError):
            damage.lost["a schema or channel that cannot be read"] += 1

    def note_channel(self, channel: Any) -> None:
        """A channel, if its messages are serialised as ROS does; else it is ``foreign``."""
        from rosbags.typesys.msg import normalize_msgtype

        self.channels.add(channel.id)
        schema = self.schemas.get(channel.schema_id)
        if schema is None or channel.message_encoding not in ("ros1", "cdr") or schema.encoding not in LANGUAGES:
            self.foreign[channel.topic] = f"{channel.message_encoding or 'no encoding'} ({schema.encoding if schema else 'no schema'})"
            return
        text, kind = schema.data.decode(errors="replace"), normalize_msgtype(schema.name)
        self.connections[channel.id] = Connection(channel.topic, kind, text, LANGUAGES[schema.encoding], "", channel.message_encoding)


def _unpacked(record: bytes, damage: Damage) -> bytes:
    """A chunk's content; b"" where it is spoiled, what is there of one that is cut and not compressed."""
    import zstandard
    from mcap.data_stream import ReadDataStream
    from mcap.exceptions import McapError
    from mcap.records import Chunk
    from mcap.stream_reader import CRCValidationError, get_chunk_data_stream

    if damage.cut:
        (letters,) = struct.unpack_from("<I", record, 28) if len(record) >= 40 else (1,)
        return record[40:] if letters == 0 else b""
    try:
        chunk = Chunk.read(ReadDataStream(io.BytesIO(record)))
        if chunk.compression == "zstd":
            _refuse_other_size(chunk.data, chunk.uncompressed_size)
        stream, length = get_chunk_data_stream(chunk, validate_crc=True)
        return bytes(stream.read(length))
    except CRCValidationError:
        damage.lost["a chunk that does not fit its CRC"] += 1
    except (McapError, zstandard.ZstdError, ValueError, RuntimeError, struct.error, OverflowError, MemoryError):
        damage.lost["a chunk that cannot be unpacked"] += 1
    return b""


def _refuse_other_size(data: bytes, size: int) -> None:
    """A spoiled size would have zstd ask for any amount of memory."""
    import zstandard

    try:
        said = zstandard.frame_content_size(data)
    except zstandard.ZstdError as error:
        raise ValueError(str(error)) from None
    if said not in (-1, size):
        raise ValueError(f"{said} bytes, the chunk says {size}")


def _messages(content: bytes, topics: frozenset[str], known: _Known, damage: Damage) -> Iterator[Block]:
    """The messages of a chunk, by channel; its schemas and channels go to ``known``."""
    places, at, last = [], 0, len(content) - HEAD.size
    while at <= last:
        places.append(at)
        at += HEAD.size + _length(content, at + 1)[0]
    if at != len(content) and not damage.cut:
        damage.lost["a record that cannot be read"] += 1
    bounds = np.array([*places, at] if at <= len(content) else places, dtype=np.int64)
    data, starts, ends = np.frombuffer(content, dtype=np.uint8), bounds[:-1], bounds[1:]
    ops, body = data[starts], starts + HEAD.size
    for place in np.flatnonzero((ops == SCHEMA) | (ops == CHANNEL)):
        known.note(int(ops[place]), content[body[place] : ends[place]], damage)
    of_message = (ops == MESSAGE) & (ends - body >= MESSAGE_HEAD)
    body, size = body[of_message], (ends - body)[of_message] - MESSAGE_HEAD
    channels = numbers_at(data, "<u2", body)
    ns = numbers_at(data, "<i8", body + 6).astype(np.int64)
    for channel in np.unique(channels):
        of = channels == channel
        if int(channel) not in known.channels:
            damage.lost["messages of a channel that is not defined"] += int(of.sum())
            continue
        damage.found(ns[of])
        connection = known.connections.get(int(channel))
        if connection is not None and connection.topic in topics:
            yield Block(connection, ns[of], data, body[of] + MESSAGE_HEAD, size[of])
