"""ROS 2 bag in SQLite (.db3): rows in the order in which they were written; where a page is damaged, those beyond it all the same.

SQLite has no checksums: a damaged page is known by what it says of its rows, a missing one by its number, which is beyond the file's end.
"""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput, Finding
from rovval.ingest.bags.block import Block, Connection
from rovval.ingest.bags.damage import Damage

MAGIC = b"SQLite format 3\0"
ROWS = 20_000  # rows fetched at a time
Row = tuple[int, int, int, bytes]
Rows = tuple[Sequence[int], NDArray[np.int64], NDArray[np.int64], Sequence[bytes]]  # number, topic, stamp (ns), message


class Sqlite:
    """A `rovval.ingest.bags.block.Container`."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.findings: list[Finding] = []
        self.foreign: dict[str, str] = {}
        self.share = 0.0
        self.cut = _pages_missing(path)
        self._topics = self._read_topics()

    def connections(self) -> list[Connection]:
        """As the table of topics has them."""
        return list(self._topics.values())

    def _read_topics(self) -> dict[int, Connection]:
        definitions: dict[str, tuple[str, str]] = {}
        with closing(self._open()) as base:
            try:
                topics = base.execute("SELECT id, name, type, serialization_format FROM topics").fetchall()
            except sqlite3.Error as error:
                hint = "is it a ROS 2 bag? a damaged one may give something to `sqlite3 FILE .recover`"
                raise BadInput(f"{self.path}: damaged or foreign, while reading its table of topics: {error}", hint) from None
            try:
                found = base.execute("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions").fetchall()
                definitions = {kind: (language, text) for kind, language, text in found}
            except sqlite3.Error:
                pass  # older than ROS 2 Iron: it defines no types
        if foreign := sorted({str(form) for *_, form in topics if form != "cdr"}):
            raise BadInput(f"{self.path}: messages are serialised as {', '.join(foreign)}", "record with cdr, the format of ROS 2")
        out = {}
        for number, topic, kind, _ in topics:
            language, text = definitions.get(kind, ("", ""))
            form = {"ros2msg": "msg", "ros2idl": "idl"}.get(language, "")
            out[int(number)] = Connection(str(topic), str(kind), str(text), form, "", "cdr")  # type: ignore[arg-type]
        return out

    def blocks(self, topics: frozenset[str]) -> Iterator[Block]:
        """The messages on ``topics``, many rows at a time."""
        damage = Damage()
        if self.cut:
            damage.cut = f"the file ends {self.cut:,} pages of {pages(self.path)[1]:,} too early"
        wanted = [number for number, connection in self._topics.items() if connection.topic in topics]
        with closing(self._open()) as base:
            top = max(_last_number(base), 1)
            for numbers, ids, ns, messages in _rows(base, None if self.cut else wanted, damage, pages(self.path)[1]):
                size = np.fromiter(map(len, messages), dtype=np.int64, count=len(messages))
                start, data = np.concatenate(([0], np.cumsum(size)[:-1])), np.frombuffer(b"".join(messages), dtype=np.uint8)
                damage.found(ns)
                self.share = min(numbers[-1] / top, 1.0)
                for number in wanted:
                    if (of := ids == number).any():
                        yield Block(self._topics[number], ns[of], data, start[of], size[of])
        self.findings += damage.findings(self.path.name)

    def _open(self) -> sqlite3.Connection:
        base = sqlite3.connect(f"{self.path.absolute().as_uri()}?immutable=1", uri=True)
        base.execute("PRAGMA writable_schema=ON")  # by which SQLite opens a file that is shorter than its header says; it stays read-only
        base.text_factory = lambda raw: raw.decode("utf-8", errors="replace")
        return base


def _rows(base: sqlite3.Connection, wanted: list[int] | None, damage: Damage, most: int) -> Iterator[Rows]:
    """Whole rows, by the column, in the order of their numbers; where SQLite cannot go on, from the next number at which it can, ``most`` (pages) times."""
    which = "" if wanted is None else f" AND topic_id IN ({', '.join(map(str, wanted))})"
    query = f"SELECT id, topic_id, timestamp, data FROM messages WHERE id > ?{which} ORDER BY id"
    last, top = 0, None
    while True:
        try:
            cursor = base.execute(query, (last,))
            while rows := cursor.fetchmany(ROWS):
                last = max(last, int(rows[-1][0]))
                good = _columns(rows)
                if len(good[0]):
                    yield good
                if len(good[0]) < len(rows):
                    damage.lost["a row that holds no message"] += len(rows) - len(good[0])
            return
        except sqlite3.DatabaseError:
            rows = _singly(base, query, last)
            last = max(last, rows[-1][0]) if rows else last
            if rows and len((good := _columns(rows))[0]):
                yield good
            top = _last_number(base) if top is None else top
            most -= 1
            following = _readable_after(base, last, top) if most > 0 else None
            if following is None:
                if not damage.cut:
                    damage.lost[f"rows beyond number {last} cannot be read"] += 1
                return
            damage.lost["rows of a page that cannot be read"] += 1
            last = max(following - 1, last + 1)  # a row that is there and cannot be read is passed over


def _singly(base: sqlite3.Connection, query: str, last: int) -> list[Row]:
    """What can be had of a fetch that failed on its way."""
    rows: list[Row] = []
    try:
        for row in base.execute(query, (last,)):
            rows.append(row)
    except sqlite3.DatabaseError:
        pass
    return rows


def _columns(rows: list[Row]) -> Rows:
    """The rows that are messages, by the column: taken as such at once, since nearly always all of them are."""
    numbers, ids, stamps, messages = zip(*rows, strict=True)
    columns = np.array(ids), np.array(stamps)
    if [c.dtype.kind for c in columns] == ["i", "i"] and set(map(type, messages)) == {bytes}:
        return numbers, columns[0], columns[1], messages
    good = [row for row in rows if isinstance(row[1], int) and isinstance(row[2], int) and isinstance(row[3], bytes)]
    topics, times = (np.array([row[k] for row in good], dtype=np.int64) for k in (1, 2))
    return [row[0] for row in good], topics, times, [row[3] for row in good]


def _last_number(base: sqlite3.Connection) -> int:
    try:
        return int(base.execute("SELECT max(id) FROM messages").fetchone()[0] or 0)
    except (sqlite3.DatabaseError, TypeError, ValueError):
        return 1 << 40


def _readable_after(base: sqlite3.Connection, last: int, top: int) -> int | None:
    """The first number after ``last`` from which rows can be read again: found by doubling the step, then halving it; None to ``top``."""

    def readable(number: int) -> int | None:
        try:
            found = base.execute("SELECT id FROM messages WHERE id >= ? ORDER BY id LIMIT 1", (number,)).fetchone()
            whole = found and base.execute("SELECT length(data) FROM messages WHERE id = ?", found).fetchone()
            return int(found[0]) if whole and isinstance(found[0], int) and found[0] > last else None
        except sqlite3.DatabaseError:
            return None

    low, step = last + 1, 1
    while (high := readable(low + step)) is None:
        low, step = low + step, step * 2
        if low > top:
            return None
    found = high
    while step > 1:
        step //= 2
        if (at := readable(low + step)) is None:
            low += step
        else:
            found = min(found, at)
    return found


def pages(path: Path) -> tuple[int, int]:
    """Size of a page and number of pages, as the header says (sqlite.org/fileformat.html, 1.3)."""
    with path.open("rb") as file:
        head = file.read(100)
    if len(head) < 100:
        return 1, 0
    (size,), (pages,) = struct.unpack_from(">H", head, 16), struct.unpack_from(">I", head, 28)
    return (65536 if size == 1 else max(size, 512)), pages


def _pages_missing(path: Path) -> int:
    size, count = pages(path)
    return max(0, count - path.stat().st_size // size)

