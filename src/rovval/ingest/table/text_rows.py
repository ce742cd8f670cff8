"""The rows of a table of text, block by block, so that a file of any size needs the memory of a block.

A block is checked as a whole: where every line of it is a row, it stays as it is; else its lines are looked at one by one.
"""

from __future__ import annotations

import codecs
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from rovval.core.counts import counted
from rovval.core.errors import BadInput, Finding
from rovval.ingest.files.compression import lost_of, opened, share_read
from rovval.ingest.table.header import Header
from rovval.ingest.table.text_table import HEAD, byte_order, cells, first_few

BLOCK = 1 << 24  # bytes of the file that are read at a time; a line that is longer is no row of it
Index = NDArray[np.int64]


@dataclass(frozen=True, slots=True)
class Rows:
    """Whole rows as text (UTF-8), a line each, and their numbers in the file from 1 (n,)."""

    text: bytes
    lines: Index


class TextRows:
    """The rows below a header; ``size`` bytes of the file are read at a time. `findings` are whole once `blocks` is through."""

    def __init__(self, path: Path, header: Header, size: int = BLOCK) -> None:
        self.path, self.header, self.size = path, header, size
        self.separator, self.width = header.separator, len(header.names)
        self.share = 0.0  # of the file that is read
        self._short, self._long, self._last = Tally(), Tally(), 0
        self._lost: tuple[Finding, ...] = ()
        self._count = 0

    def blocks(self) -> Iterator[Rows]:
        """The rows, block by block. Raises `BadInput` for a file that cannot be read."""
        again: frozenset[bytes] = frozenset()  # the lines of the header, which may be there again where files were joined
        at = self.header.at + self.header.below  # the last line that is no row
        number = 0  # lines before the block
        with opened(self.path) as file:
            try:
                for block in _texts(file, self.size):
                    count, self.share = block.count(b"\n"), share_read(file, self.path)
                    if number <= at < number + count:
                        *before, block = block.split(b"\n", at - number + 1)
                        again = frozenset(before[-1 - self.header.below :]) - {b""}
                        number, count = at + 1, block.count(b"\n")
                    if number > at and block and (rows := self._rows(block, again, number)) is not None:
                        self._last = int(rows.lines[-1])
                        yield rows
                    number += count
            except OSError as error:
                raise BadInput(f"{self.path}: cannot be read: {error.strerror or error}", "check the file") from None
            self._lost, self._count = lost_of(file, self.path), number

    def findings(self) -> tuple[Finding, ...]:
        """What was lost: the end of the file, rows of another length."""
        found = list(self._lost)
        if self.header.below:
            found.append(Finding("units_row", f"line {self.header.at + 2}", "holds units, no values; they are held against the profile"))
        cut = self._short.last == self._count > self._last > 0
        if cut:
            found.append(Finding("cut_line", f"line {self._count}", "the last line is cut; dropped"))
        ragged = self._short.count - cut + self._long.count
        if ragged:
            where = first_few([*self._short.first[: self._short.count - cut], *self._long.first], more=ragged)
            found.append(Finding("ragged_row", where, f"{counted(ragged, 'row')} without the header's {self.width} cells; dropped"))
        return tuple(found)

    def _rows(self, block: bytes, again: frozenset[bytes], number: int) -> Rows | None:
        if self._all_whole(block, again):
            return Rows(block, np.arange(number + 1, number + 1 + block.count(b"\n"), dtype=np.int64))
        rows: list[str] = []
        lines: list[int] = []
        separator, header = self.separator, {line.decode() for line in again}
        for line_number, line in enumerate(block.decode()[:-1].split("\n"), number + 1):
            if not line.strip(f"{separator} \t") or line.startswith("#") or line in header:  # a line of separators alone is a blank one
                continue
            count = line.count(separator) + 1 if '"' not in line else len(cells(line, separator))
            if (over := count - self.width) > 0 and line.endswith(separator * over):
                line, count = line[:-over], self.width
            if count == self.width:
                rows.append(line)
                lines.append(line_number)
            else:
                (self._short if count < self.width else self._long).add(line_number)
        return Rows("".join(f"{row}\n" for row in rows).encode(), np.array(lines, dtype=np.int64)) if rows else None

    def _all_whole(self, block: bytes, again: frozenset[bytes]) -> bool:
        """Whether every line is a row: no quotes, comments and repeated headers, and every ``width``-th separator or line end is a line end."""
        if b'"' in block or self.width < 2:
            return False
        content = np.frombuffer(block, dtype=np.uint8)
        newline = ord("\n")
        marks = np.flatnonzero((content == ord(self.separator)) | (content == newline))
        ends = marks[self.width - 1 :: self.width]
        if len(marks) != self.width * block.count(b"\n") or not (content[ends] == newline).all():
            return False
        firsts = content[np.concatenate(([0], ends[:-1] + 1))]
        headers = any((firsts == line[0]).any() and line in block for line in again)
        return not (headers or np.isin(firsts, (ord("#"), newline, ord(self.separator))).any())


class Tally:
    """How many lines there are of a kind, the first few of them, and the last."""

    def __init__(self) -> None:
        self.count, self.last = 0, 0
        self.first: list[int] = []

    def add(self, *lines: int) -> None:
        """Count ``lines``, which are in order."""
        self.count += len(lines)
        self.first = [*self.first, *lines][:6]
        self.last = lines[-1] if lines else self.last


def _texts(file: BinaryIO, size: int) -> Iterator[bytes]:
    """A file as blocks of whole lines in UTF-8 that end in ``\\n``. Text that is not UTF-8 is taken for latin-1."""
    rest = b""
    decoder: codecs.IncrementalDecoder | None = None
    first = True
    while True:
        read = file.read(size)
        if first:
            order = byte_order(read[:HEAD])
            decoder = codecs.getincrementaldecoder(order)(errors="replace") if order else None
        more = decoder.decode(read, final=not read).encode() if decoder else read
        rest += more.removeprefix(codecs.BOM_UTF8) if first else more
        first = False
        if not read:
            break
        end = max(rest.rfind(b"\n"), rest.rfind(b"\r", 0, len(rest) - 1)) + 1
        if end:
            yield _lines(rest[:end])
        rest = rest[end:][:size]  # a line that is longer loses its end, and is no row all the same
    if rest:
        yield _lines(rest)


def _lines(block: bytes) -> bytes:
    if not block.isascii():
        try:
            block.decode()
        except UnicodeDecodeError:
            block = block.decode("latin-1").encode()
    if b"\r" in block:
        block = block.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return block if block.endswith(b"\n") else block + b"\n"
