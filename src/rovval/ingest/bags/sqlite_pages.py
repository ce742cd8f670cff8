"""Rows of messages by the column, from the pages of an SQLite file as they lie (sqlite.org/fileformat2.html, 1.6 and 2.1): some three times as fast as row by
row through SQLite.

This reads what nearly every page is: whole, its rows in order, each row's message inside it (images are not, and are passed over unless they are asked
for). At anything else it stops, for SQLite itself to go on.
"""

from __future__ import annotations

import mmap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from rovval.ingest.bags.block import Bytes, Index, numbers_at

INTERIOR, LEAF = 5, 13  # first byte of a page of a table: pointers to pages, or rows
FIRST_POINTER = {INTERIOR: 12, LEAF: 8}  # bytes of the page's head, after which two bytes a cell say where it begins
OUTSIDE = 35  # a row of more bytes than the page less these goes on in pages of its own
WIDTHS = np.array([0, 1, 2, 3, 4, 6, 8, 0, 0, 0])  # bytes of an integer by its type
ZERO, ONE = 8, 9  # types of the integers 0 and 1, which take no bytes
INTEGERS = (1, 2, 3, 4, 5, 6, ZERO, ONE)
FIRST_BLOB = 12  # type of a blob: this, and two more for each byte of it
LONGEST_VARINT = 8  # bytes; one of nine is a number that no row has


class Unusual(Exception):
    """A page that is damaged, or written as few are."""


@dataclass(frozen=True, slots=True)
class Rows:
    """Rows of the table of messages: row i has that number, is of that topic, and its message is ``data[start[i] : start[i] + size[i]]``."""

    number: Index
    topic: Index
    record_ns: Index
    data: Bytes
    start: Index
    size: Index


class Pages:
    """An SQLite file by its pages of so many bytes."""

    def __init__(self, path: Path, page: int) -> None:
        with path.open("rb") as file:
            self.data: Bytes = np.frombuffer(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ), dtype=np.uint8)
        self._page = page

    def rows(self, root: int, topics: Sequence[int]) -> Iterator[Rows]:
        """The rows of ``topics`` in a table ``(id, topic_id, timestamp, data)`` whose root is that page, in the order of their numbers, many at a
        time; up to the first page that is unusual."""
        last = 0
        try:
            for leaves in self._leaves(np.array([root]), set()):
                found = self._rows(leaves, topics)
                if (np.diff(found.number, prepend=last) <= 0).any():
                    return
                if len(found.number):
                    last = int(found.number[-1])
                    yield found
        except (Unusual, IndexError):
            return

    def _leaves(self, numbers: Index, seen: set[int]) -> Iterator[Index]:
        """The pages of rows among and below ``numbers``, as many at a time as have one parent."""
        if numbers.min() < 1 or not seen.isdisjoint(numbers.tolist()):
            raise Unusual
        places = (numbers - 1) * self._page
        kinds = set(self.data[places].tolist())
        if kinds not in ({INTERIOR}, {LEAF}):
            raise Unusual
        seen.update(numbers.tolist())
        if kinds == {LEAF}:
            yield places
            return
        for place in places:
            children = self._numbers(self._cells(np.array([place]), INTERIOR), 4)
            yield from self._leaves(np.append(children, self._numbers(np.array([place + 8]), 4)), seen)

    def _rows(self, leaves: Index, topics: Sequence[int]) -> Rows:
        cells = self._cells(leaves, LEAF)
        whole, at = self._varints(cells)
        number, length = self._varints(cells + at)
        head = cells + at + length
        length, at = self._varints(head)
        types = self.data[(head + at)[:, None] + [0, 1, 2]].astype(np.int64)  # of id (none: it is the row's number), topic and stamp
        if types[:, 0].any() or not np.isin(types[:, 1:], INTEGERS).all():
            raise Unusual
        topic = self._integers(head + length, types[:, 1])
        of = np.isin(topic, topics)
        cells, whole, number, head, length, at, types, topic = (part[of] for part in (cells, whole, number, head, length, at, types, topic))
        of_data, at_data = self._varints(head + at + 3)
        stamp = head + length + WIDTHS[types[:, 1]]
        start, size = stamp + WIDTHS[types[:, 2]], (of_data - FIRST_BLOB) // 2
        end = head + whole
        message = (of_data >= FIRST_BLOB) & (of_data % 2 == 0) & (at + 3 + at_data == length) & (start + size == end)
        inside = (whole <= self._page - OUTSIDE) & (end <= cells - cells % self._page + self._page)
        if not (message & inside).all():
            raise Unusual
        return Rows(number, topic, self._integers(stamp, types[:, 2]), self.data, start, size)

    def _cells(self, places: Index, kind: int) -> Index:
        """Where the cells of pages of one kind begin."""
        count = self._numbers(places + 3, 2)
        page = np.repeat(places, count)
        within = np.arange(len(page)) - np.repeat(np.cumsum(count) - count, count)
        return page + self._numbers(page + FIRST_POINTER[kind] + 2 * within, 2)

    def _numbers(self, places: Index, width: int) -> Index:
        """Unsigned numbers, the highest byte first."""
        return numbers_at(self.data, f">u{width}", places).astype(np.int64)

    def _varints(self, places: Index) -> tuple[Index, Index]:
        """Numbers of seven bits a byte, and how many bytes each has: all but its last have the highest bit set."""
        value, length = np.zeros(len(places), np.int64), np.zeros(len(places), np.int64)
        going = np.ones(len(places), dtype=bool)
        for _ in range(LONGEST_VARINT):
            byte = self.data[places + length].astype(np.int64)
            value = np.where(going, value << 7 | byte & 0x7F, value)
            length += going
            going &= byte >= 0x80
            if not going.any():
                return value, length
        raise Unusual

    def _integers(self, places: Index, types: Index) -> Index:
        """Signed integers, each of the width that its type has."""
        out = np.where(types == ONE, 1, 0)
        for kind in np.unique(types[types < ZERO]):
            of = types == kind
            at = places[of]
            value = self.data[at].astype(np.int8).astype(np.int64)
            for byte in range(1, WIDTHS[kind]):
                value = value << 8 | self.data[at + byte]
            out[of] = value
        return out
