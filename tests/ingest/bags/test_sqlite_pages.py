"""Rows by the page beside SQLite itself: the same numbers, stamps and bytes, up to what is not as nearly all pages are, and from there none."""

from __future__ import annotations

import sqlite3

import numpy as np
import pytest

from rovval.ingest.bags.sqlite_pages import Pages

TABLE = "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)"
SELECT = "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id"
TOPICS = [0, 1, -3, 200, 40_000]
Row = tuple[int, int, int, bytes]


def base_of(path, rows, page=4096, table=TABLE):
    base = sqlite3.connect(path)
    base.execute(f"PRAGMA page_size = {page}")
    base.execute(table)
    base.executemany("INSERT INTO messages VALUES (?, ?, ?, ?)", rows)
    base.commit()
    return base


def random_rows(count: int, longest: int = 300) -> list[Row]:
    """Integers of every width that SQLite stores them in, messages of none to ``longest`` bytes, numbers with gaps."""
    rng = np.random.default_rng(7)
    stamps = [0, 1, -1, 10**4, 10**9, -(10**12), 1_700_000_000_000_000_000]
    numbers = np.cumsum(rng.integers(1, 40, count))
    chosen = ((int(rng.choice(TOPICS)), int(rng.choice(stamps)), rng.bytes(int(rng.integers(0, longest)))) for _ in range(count))
    return [(int(number), *rest) for number, rest in zip(numbers, chosen, strict=True)]


def read(path, page=4096, topics=TOPICS) -> list[Row]:
    root = sqlite3.connect(path).execute("SELECT rootpage FROM sqlite_master WHERE name = 'messages'").fetchone()[0]
    out: list[Row] = []
    for rows in Pages(path, page).rows(root, topics):
        messages = [rows.data[start : start + size].tobytes() for start, size in zip(rows.start, rows.size, strict=True)]
        out += zip(rows.number.tolist(), rows.topic.tolist(), rows.record_ns.tolist(), messages, strict=True)
    return out


@pytest.mark.parametrize("page", [512, 4096, 32768])
@pytest.mark.parametrize("count", [0, 1, 3, 4000])
def test_every_row_that_sqlite_has(tmp_path, page, count):
    rows = random_rows(count)
    base_of(tmp_path / "a.db3", rows, page)
    assert read(tmp_path / "a.db3", page) == rows


def test_rows_that_were_deleted_are_gone(tmp_path):
    base = base_of(tmp_path / "a.db3", random_rows(3000))
    base.execute("DELETE FROM messages WHERE id % 3 = 0")
    base.commit()
    assert read(tmp_path / "a.db3") == base.execute(SELECT).fetchall()


def test_up_to_a_row_that_is_longer_than_its_page(tmp_path):
    rows = random_rows(2000, 60)
    rows[1500] = (rows[1500][0], 200, 0, bytes(5000))
    base_of(tmp_path / "a.db3", rows, 512)
    found = read(tmp_path / "a.db3", 512)
    assert 0 < len(found) <= 1500 and found == rows[: len(found)]
    assert read(tmp_path / "a.db3", 512, [0, 1]) == [row for row in rows if row[1] in (0, 1)], "images that nobody asks for are in the way of nothing"


@pytest.mark.parametrize("value", [None, 0.5, "text"])
@pytest.mark.parametrize("column", [1, 2, 3])
def test_nothing_of_rows_that_hold_something_else(tmp_path, column, value):
    row = [1, 200, 3, b"message"]
    row[column] = value
    base_of(tmp_path / "a.db3", [tuple(row)], table="CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data)")
    assert read(tmp_path / "a.db3") == []


def test_what_is_damaged_is_never_read_otherwise_than_sqlite_reads_it(tmp_path):
    """Pages that do not hang together are left to SQLite; of a spoiled byte inside a message nobody knows."""
    base_of(tmp_path / "whole.db3", random_rows(3000, 60))
    whole, rng, path, short = (tmp_path / "whole.db3").read_bytes(), np.random.default_rng(1), tmp_path / "a.db3", 0
    for _ in range(300):
        content = bytearray(whole)
        at = 4096 * int(rng.integers(1, len(whole) // 4096)) + int(rng.integers(0, 200))
        content[at : at + 2] = rng.bytes(2)
        path.write_bytes(content)
        found = read(path)
        try:
            theirs = sqlite3.connect(path).execute(SELECT).fetchall()
        except sqlite3.DatabaseError:
            theirs = None
        assert theirs is None or found == theirs[: len(found)]
        short += len(found) < 3000
    assert short > 30
