"""ROS 1 bag, format 2.0 (wiki.ros.org/Bags/Format/2.0), read by its chunks: with an index, without one, cut or spoiled.

rosbags reads a bag by its index alone and message by message. Here chunks are walked as they lie in the file; where a record's lengths
lead nowhere, the next header that makes sense is looked for.
"""

from __future__ import annotations

import bz2
import io
import mmap
import re
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rovval.core.errors import Finding
from rovval.ingest.bags.block import Block, Bytes, Connection, Index, numbers_at
from rovval.ingest.bags.damage import Damage

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, CHUNK, CHUNK_INFO, CONNECTION = 2, 5, 6, 7  # ops of records; 3 is the bag's header, 4 the index of a chunk
OPS = range(2, 8)
NEEDED = {MESSAGE: {"conn", "time"}, CHUNK: {"compression", "size"}, CONNECTION: {"conn", "topic"}}
LONGEST_HEADER = 4096  # bytes; the longest name of a topic is far shorter
LARGEST_CHUNK = 1 << 30  # bytes that a chunk may unpack to; recorders write chunks of about 1e6
_u32 = struct.Struct("<I").unpack_from


class Rosbag1:
    """A `rovval.ingest.bags.block.Container`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.findings: list[Finding] = []
        self.foreign: dict[str, str] = {}
        self.share = 0.0
        with path.open("rb") as file:
            self._file = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)

    def connections(self) -> list[Connection]:
        """As the index at the end of the file has them, or, where there is none, as the chunks have them."""
        return list(self._by_id().values())

    def _by_id(self) -> dict[int, Connection]:
        found = self._of_index()
        if found is None:
            found = {}
            for op, header, data in self._records(Damage()):
                if op == CHUNK and (content := _unpacked(header, data, Damage())):
                    for at in _headers(content, b"op=\x07", 0):
                        _note_connection(content, at, found)
                elif op == CONNECTION:
                    _note(header, data, found)
        return found

    def _of_index(self) -> dict[int, Connection] | None:
        """The connections that the bag's header promises at ``index_pos``; None where they are not all there."""
        record = _record(self._file, len(MAGIC))
        if record is None or not {"index_pos", "conn_count"} <= set(record[1]) or len(record[1]["index_pos"]) != 8:
            return None
        (at,), (count,) = struct.unpack("<Q", record[1]["index_pos"]), struct.unpack("<I", record[1]["conn_count"])
        found: dict[int, Connection] = {}
        for _ in range(count if at else 0):
            record = _record(self._file, at)
            if record is None or record[0] != CONNECTION:
                return None
            _note(record[1], record[2], found)
            at = record[3]
        return found if len(found) == count and count else None

    def blocks(self, topics: frozenset[str]) -> Iterator[Block]:
        """The messages on ``topics``, chunk by chunk."""
        known, damage = self._by_id(), Damage()
        for op, header, data in self._records(damage):
            if op == CHUNK:
                yield from _messages(_unpacked(header, data, damage), known, topics, damage)
            elif op == CONNECTION:
                _note(header, data, known)
            elif op == MESSAGE:  # of a chunk whose own header is lost
                alone = struct.pack("<I", len(_joined(header))) + _joined(header) + struct.pack("<I", len(data)) + data
                yield from _messages(alone, known, topics, damage)
        self.findings += damage.findings(self.path.name)

    def _records(self, damage: Damage) -> Iterator[tuple[int, dict[str, bytes], bytes]]:
        """Op, header and content of every record of the file; the last one may be cut."""
        at, end, closed = len(MAGIC), len(self._file), False
        while at < end:
            record = _record(self._file, at)
            if record is not None:
                op, header, data, at = record
                self.share = at / end
                closed |= op == CHUNK_INFO
                yield op, header, data
                continue
            cut = _record(self._file, at, whole=False)
            following = next(_headers(self._file, rb"op=\x05" if cut else rb"op=[\x02\x05]", at + 1), None)
            if following is None:
                damage.cut = f"the file ends in the middle of {'a chunk' if cut is None or cut[0] == CHUNK else 'its index'}"
                if cut is not None:
                    yield cut[0], cut[1], cut[2]
                return
            damage.lost["a record that cannot be read"] += 1
            at = following
        if not closed:
            damage.cut = "the file ends without its index: the recorder did not close it, or it is cut"


def _record(file: mmap.mmap | bytes, at: int, whole: bool = True) -> tuple[int, dict[str, bytes], bytes, int] | None:
    """Op, header, content and end of the record at ``at``; None where there is none. Unless ``whole``, its content may be cut."""
    header = _header(file, at)
    if header is None:
        return None
    body = at + 4 + _u32(file, at)[0]
    if body + 4 > len(file):
        return None
    end = body + 4 + _u32(file, body)[0]
    if whole and end > len(file):
        return None
    return header["op"][0], header, file[body + 4 : min(end, len(file))], end


def _header(file: mmap.mmap | bytes, at: int) -> dict[str, bytes] | None:
    """The fields of the header at ``at`` (its length first); None where it is no record's."""
    if at + 4 > len(file) or not 8 <= (size := _u32(file, at)[0]) <= LONGEST_HEADER or at + 4 + size > len(file):
        return None
    fields = _fields(file[at + 4 : at + 4 + size])
    if len(fields.get("op", b"")) != 1 or fields["op"][0] not in OPS or not NEEDED.get(fields["op"][0], set()) <= set(fields):
        return None
    return fields


def _fields(content: bytes) -> dict[str, bytes]:
    """``name=value`` fields, each with its length before it; {} where they do not fill the content."""
    from rosbags.rosbag1.reader import Header, ReaderError

    try:
        return dict(Header.read(io.BytesIO(struct.pack("<I", len(content)) + content)))
    except (ReaderError, UnicodeDecodeError):
        return {}


def _joined(header: dict[str, bytes]) -> bytes:
    fields = (name.encode() + b"=" + value for name, value in header.items())
    return b"".join(struct.pack("<I", len(field)) + field for field in fields)


def _headers(file: mmap.mmap | bytes, op: bytes, at: int) -> Iterator[int]:
    """Where headers with such an ``op`` begin, from ``at`` on."""
    for hit in re.compile(op, re.DOTALL).finditer(file, at):
        for start in range(hit.start() - 8, max(at, hit.start() - LONGEST_HEADER) - 1, -1):
            if hit.end() - start - 4 <= _u32(file, start)[0] <= LONGEST_HEADER and _header(file, start) is not None:
                yield start
                break


def _note_connection(content: bytes, at: int, found: dict[int, Connection]) -> None:
    if (record := _record(content, at)) is not None and record[0] == CONNECTION:
        _note(record[1], record[2], found)


def _note(header: dict[str, bytes], data: bytes, found: dict[int, Connection]) -> None:
    """Put a connection's record where messages find it, unless it is damaged."""
    from rosbags.rosbag1.reader import normalize
    from rosbags.typesys.msg import normalize_msgtype

    fields = _fields(data)
    if len(header["conn"]) != 4 or not {"type", "md5sum", "message_definition"} <= set(fields):
        return
    try:
        topic, kind, digest, text = (b.decode() for b in (header["topic"], fields["type"], fields["md5sum"], fields["message_definition"]))
    except UnicodeDecodeError:
        return
    if topic and kind:
        found.setdefault(_u32(header["conn"])[0], Connection(normalize(topic), normalize_msgtype(kind), text, "msg", digest, "ros1"))


def _unpacked(header: dict[str, bytes], data: bytes, damage: Damage) -> bytes:
    """A chunk's content, as much of it as is there; b"" where it is spoiled."""
    import lz4.frame

    how, size = header["compression"], header["size"]
    most = min(_u32(size)[0] if len(size) == 4 else LARGEST_CHUNK, LARGEST_CHUNK)
    try:
        content = data if how == b"none" else bytes({b"bz2": bz2.BZ2Decompressor, b"lz4": lz4.frame.LZ4FrameDecompressor}[how]().decompress(data, most))
    except (KeyError, OSError, RuntimeError, EOFError):
        damage.lost["a chunk that cannot be unpacked"] += 1
        return b""
    if len(content) != most and not damage.cut:
        damage.lost["a chunk of another length than its header says"] += 1
    return content


def _messages(content: bytes, known: dict[int, Connection], topics: frozenset[str], damage: Damage) -> Iterator[Block]:
    """The messages of a chunk, by connection."""
    data = np.frombuffer(content, dtype=np.uint8)
    starts = np.array(_starts(content, damage), dtype=np.int64)
    length = numbers_at(data, "<u4", starts).astype(np.int64)
    for size in np.unique(length):
        places = starts[length == size]
        while len(places):
            header = _header(content, int(places[0]))
            if header is None or header["op"][0] != MESSAGE or len(header["conn"]) != 4 or len(header["time"]) != 8:
                if header is None:
                    damage.lost["a record that cannot be read"] += 1
                elif header["op"][0] == CONNECTION:
                    _note_connection(content, int(places[0]), known)
                places = places[1:]
                continue
            same = _alike(data, places, int(size))
            yield from _grouped(data, places[same], content[int(places[0]) : int(places[0]) + 4 + int(size)], known, topics, damage)
            places = places[~same]


def _starts(content: bytes, damage: Damage) -> list[int]:
    """Where the records of a chunk begin. Nearly all headers are as long as the one before: both lengths of a record are then read in one step."""
    at, end, starts = 0, len(content), []
    header, lengths = 0, struct.Struct("<II").unpack_from
    while at < end:
        try:
            long, body = lengths(content, at)
            if long != header:
                header, lengths = long, struct.Struct(f"<I{long}xI").unpack_from
                continue
            after = at + 8 + header + body
        except struct.error:
            after = end + 1
        if after > end:
            following = next(_headers(content, rb"op=[\x02\x07]", at + 1), None)
            if following is None and damage.cut:
                break
            damage.lost["a record that cannot be read"] += 1
            at = end if following is None else following
            header, lengths = 0, struct.Struct("<II").unpack_from
            continue
        starts.append(at)
        at = after
    return starts


def _values(header: bytes) -> tuple[int, int]:
    """Where in a message's header (its length first) the number of its connection and its stamp begin."""
    return header.index(b"conn=") + 5, header.index(b"time=") + 5


def _alike(data: Bytes, places: Index, size: int) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Which headers at ``places`` are the first one's but for connection and stamp (n,)."""
    first = data[places[0] : places[0] + 4 + size]
    conn, time = _values(first.tobytes())
    fixed = np.ones(4 + size, dtype=bool)
    fixed[conn : conn + 4] = fixed[time : time + 8] = False
    where = np.flatnonzero(fixed)
    return np.asarray((data[places[:, None] + where] == first[where]).all(axis=1))


def _grouped(data: Bytes, places: Index, header: bytes, known: dict[int, Connection], topics: frozenset[str], damage: Damage) -> Iterator[Block]:
    conn, time = _values(header)
    ids = numbers_at(data, "<u4", places + conn)
    ns = numbers_at(data, "<u4", places + time).astype(np.int64) * 10**9 + numbers_at(data, "<u4", places + time + 4).astype(np.int64)
    body = places + len(header)
    size = numbers_at(data, "<u4", body).astype(np.int64)
    for one in np.unique(ids):
        of = ids == one
        connection = known.get(int(one))
        if connection is None:
            damage.lost["messages of a connection that is not defined"] += int(of.sum())
            continue
        damage.found(ns[of])
        if connection.topic in topics:
            yield Block(connection, ns[of], data, body[of] + 4, size[of])
