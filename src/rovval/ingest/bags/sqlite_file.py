"""ROS 2 bag in SQLite (.db3): rows in the order in which they were written; where a page is damaged, those beyond it all the same.

SQLite has no checksums: a damaged page is known by what it says of its rows, a missing one by its number, which is beyond the file's end.
"""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np

from rovval.core.errors import BadInput, Finding
from rovval.ingest.bags.block import Block, Connection
from rovval.ingest.bags.damage import Damage
from rovval.ingest.bags.sqlite_pages import Pages, Rows

MAGIC = b"SQLite format 3\0"
ROWS = 20_000  # rows fetched at a time
COLUMNS = [("id", 1), ("topic_id", 0), ("timestamp", 0), ("data", 0)]  # of the table of messages, and which one is the row's number
Row = tuple[int, int, int, bytes]


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
            for rows in self._rows(base, wanted, damage):
                damage.found(rows.record_ns)
                self.share = min(int(rows.number[-1]) / top, 1.0)
                for number in wanted:
                    if (of := rows.topic == number).any():
                        yield Block(self._topics[number], rows.record_ns[of], rows.data, rows.start[of], rows.size[of])
        self.findings += damage.findings(self.path.name)

    def _rows(self, base: sqlite3.Connection, wanted: list[int], damage: Damage) -> Iterator[Rows]:
        """By the page as long as pages are as nearly all are, then by SQLite, which finds nothing more in a whole file."""
        last, (page, count) = 0, pages(self.path)
        if not self.cut and (root := _root(base)):
            for rows in Pages(self.path, page).rows(root, wanted):
                last = int(rows.number[-1])
                yield rows
        yield from _rows_after(last, base, None if self.cut else wanted, damage, count)

    def _open(self) -> sqlite3.Connection:
        base = sqlite3.connect(f"{self.path.absolute().as_uri()}?immutable=1", uri=True)
        base.execute("PRAGMA writable_schema=ON")  # by which SQLite opens a file that is shorter than its header says; it stays read-only
        base.text_factory = lambda raw: raw.decode("utf-8", errors="replace")
        return base


def _root(base: sqlite3.Connection) -> int | None:
    """The first page of the table of messages; None where it has other columns than ROS 2 gives it."""
    try:
        columns = base.execute("SELECT name, pk FROM pragma_table_info('messages')").fetchall()
        (root,) = base.execute("SELECT rootpage FROM sqlite_master WHERE type = 'table' AND name = 'messages'").fetchone()
    except (sqlite3.DatabaseError, TypeError):
        return None
    return int(root) if columns == COLUMNS else None


def _rows_after(last: int, base: sqlite3.Connection, wanted: list[int] | None, damage: Damage, most: int) -> Iterator[Rows]:
    """Whole rows, by the column, in the order of their numbers; where SQLite cannot go on, from the next number at which it can, ``most`` (pages) times."""
    which = "" if wanted is None else f" AND topic_id IN ({', '.join(map(str, wanted))})"
    query = f"SELECT id, topic_id, timestamp, data FROM messages WHERE id > ?{which} ORDER BY id"
    top = None
    while True:
        try:
            cursor = base.execute(query, (last,))
            while rows := cursor.fetchmany(ROWS):
                last = max(last, int(rows[-1][0]))
                good = _columns(rows)
                if len(good.number):
                    yield good
                if len(good.number) < len(rows):
                    damage.lost["a row that holds no message"] += len(rows) - len(good.number)
            return
        except sqlite3.DatabaseError:
            rows = _singly(base, query, last)
            last = max(last, rows[-1][0]) if rows else last
            if rows and len((good := _columns(rows)).number):
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
    """The rows that are messages, by the column."""
    good = [row for row in rows if isinstance(row[1], int) and isinstance(row[2], int) and isinstance(row[3], bytes)]
    number, topic, ns = (np.array([row[k] for row in good], dtype=np.int64) for k in (0, 1, 2))
    size = np.array([len(row[3]) for row in good], dtype=np.int64)
    return Rows(number, topic, ns, np.frombuffer(b"".join(row[3] for row in good), dtype=np.uint8), np.cumsum(size) - size, size)


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

