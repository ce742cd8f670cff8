"""Blocks of serialised messages -> columns of numbers, by the types that the bag defines or that are known without."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from rovval.core.data import Array
from rovval.ingest.bags.block import Block, Connection, Index
from rovval.ingest.bags.layout import Damaged, Layout, Types, layout

STAMP = ("header.stamp.sec", "header.stamp.nanosec")


def types_of(connections: Iterable[Connection], more: Mapping[str, str]) -> dict[str, Types]:
    """The types for each encoding: what the bag defines, before ``more`` (name -> text of the .msg), before those that come with ROS.

    Raises what rosbags raises for a definition that is no definition.
    """
    from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

    extra = {k: v for name, text in more.items() for k, v in get_types_from_msg(text, name).items()}
    known: dict[str, dict[str, object]] = {}
    for c in connections:
        if c.encoding not in known:
            known[c.encoding] = {**get_typestore(Stores.ROS1_NOETIC if c.encoding == "ros1" else Stores.ROS2_HUMBLE).fielddefs, **extra}
        if c.language == "msg":
            known[c.encoding] |= get_types_from_msg(c.definition, c.kind)
        elif c.language == "idl":
            rule = "=" * 80 + "\n"
            for text in c.definition.split(rule):
                known[c.encoding] |= get_types_from_idl(text.partition("\n")[2] if text.startswith("IDL: ") else text) if text.strip() else {}
    return dict(known)


class Layouts:
    """The layouts that messages of one connection were met in. Raises `KeyError` for a type that is not defined."""

    def __init__(self, connection: Connection, types: Mapping[str, Types]) -> None:
        self.connection, self._types = connection, types[connection.encoding]
        self._known: dict[int, list[Layout]] = {}

    def of(self, block: Block) -> Iterator[tuple[Layout, Index]]:
        """Each layout of the messages of ``block`` with the rows that have it; rows of damaged messages are in none."""
        for size in np.unique(block.size):
            yield from self._of_size(block, int(size), np.flatnonzero(block.size == size))

    def _of_size(self, block: Block, size: int, rows: Index) -> Iterator[tuple[Layout, Index]]:
        known = self._known.setdefault(size, [])
        for found in known:
            fit = found.fits(block.data, block.start[rows])
            if fit.any():
                yield found, rows[fit]
                rows = rows[~fit]
        while len(rows):
            start = int(block.start[rows[0]])
            try:
                found = layout(self._types, self.connection.kind, block.data[start : start + size].tobytes(), self.connection.encoding == "cdr")
            except Damaged:
                rows = rows[1:]
                continue
            known.append(found)
            fit = found.fits(block.data, block.start[rows])
            yield found, rows[fit]
            rows = rows[~fit]


def header_ns(found: Layout, block: Block, rows: Index) -> Index | None:
    """The stamps of the headers of ``rows`` (n,) in ns, 0 where a driver leaves them empty; None for messages without header."""
    seconds, rest = (found.column(block.data, block.start[rows], address) for address in STAMP)
    return None if seconds is None or rest is None else seconds.astype(np.int64) * 10**9 + rest.astype(np.int64)


class Columns:
    """What is collected of one connection's messages: both clocks (ns; ``header`` is 0 where there is none), a column for each address
    (NaN where a message has it not), and how many messages were ``taken`` and are ``damaged``."""

    def __init__(self, connection: Connection, types: Mapping[str, Types], addresses: Sequence[str]) -> None:
        self.layouts = Layouts(connection, types)
        self._record: list[Index] = []
        self._header: list[Index] = []
        self._columns: dict[str, list[Array]] = {address: [] for address in addresses}
        self.taken = self.damaged = 0
        self.absent = set(addresses)  # addresses that no message has

    def take(self, block: Block) -> None:
        """Append the messages of ``block``."""
        n = len(block.start)
        kept = np.zeros(n, dtype=bool)
        header = np.zeros(n, dtype=np.int64)
        columns = {address: np.full(n, np.nan) for address in self._columns}
        for found, rows in self.layouts.of(block):
            kept[rows] = True
            if (stamps := header_ns(found, block, rows)) is not None:
                header[rows] = stamps
            for address, column in columns.items():
                if (values := found.column(block.data, block.start[rows], address)) is not None:
                    column[rows] = values
                    self.absent.discard(address)
        self.taken += int(kept.sum())
        self.damaged += n - int(kept.sum())
        self._record.append(block.record_ns[kept])
        self._header.append(header[kept])
        for address, column in columns.items():
            self._columns[address].append(column[kept])

    def arrays(self) -> tuple[Index, Index, dict[str, Array]]:
        """Stamps of the record and of the header (n,), and the columns (n,), in the order of the file."""
        none = np.zeros(0, dtype=np.int64)
        columns = {a: np.concatenate(c) if c else np.zeros(0) for a, c in self._columns.items()}
        return np.concatenate(self._record or [none]), np.concatenate(self._header or [none]), columns
