"""Which line of a table is its header, when no profile says what to look for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from rovval.ingest.table.text_table import HEADER_WITHIN, SEPARATORS, cells, header_place
from rovval.ingest.table.unit_names import NUMBER, are_units, with_units

ROWS_BELOW = 5  # rows below a header that have to be rows of its table: a banner has no table below it


@dataclass(frozen=True, slots=True)
class Header:
    """The ``names`` of a table's columns, the line that holds them (``at``, counted from 0; -1 where none does), how many lines ``below`` it are
    no rows (its units), and the ``separator``."""

    names: tuple[str, ...]
    at: int
    separator: str
    below: int = 0


def header_with(text: str, wanted: Sequence[str]) -> Header | None:
    """The header of the line that fits most of the ``wanted`` column patterns, with the units of the line below where that holds units; None where
    no line fits any."""
    place = header_place(text, wanted)
    if place is None:
        return None
    names, at, separator = place
    lines = re.split(r"\r\n|\n|\r", text)
    below = cells(lines[at + 1], separator) if at + 1 < len(lines) else []
    if len(below) == len(names) and are_units(below):
        return Header(with_units(names, below), at, separator, 1)
    return Header(names, at, separator)


def stated_header(text: str, names: Sequence[str]) -> Header | None:
    """The header of a table without a line of names: its separator is the one by which most lines have as many cells as there are ``names``; None
    where none has."""
    lines = [line for line in re.split(r"\r\n|\n|\r", text)[:HEADER_WITHIN] if line.strip()]
    fitting = {separator: sum(len(cells(line, separator)) == len(names) for line in lines) for separator in SEPARATORS}
    separator = max(fitting, key=lambda s: fitting[s])
    return Header(tuple(names), -1, separator) if fitting[separator] else None


def header_of(lines: Sequence[str]) -> tuple[str, ...] | None:
    """The cells of the first line of names that rows of as many cells follow, some of them numbers; None where no line is one.

    Of the separators the one that makes the most columns decides; a table of a single column has none.
    """
    found: tuple[int, tuple[str, ...]] | None = None
    for at, line in enumerate(lines[:HEADER_WITHIN]):
        for separator in SEPARATORS:
            names = tuple(cells(line.lstrip("# ") if line.startswith("#") else line, separator))
            if len(names) < 2 or not _names(names) or (found and len(names) <= found[0]):
                continue
            below = [cells(row, separator) for row in lines[at + 1 : at + 1 + 4 * ROWS_BELOW] if row.strip() and not row.startswith("#")][:ROWS_BELOW]
            if below and sum(_row(row, len(names)) for row in below) > 0.5 * len(below):
                found = (len(names), names)
    return found[1] if found else None


def _names(names: Sequence[str]) -> bool:
    """Whether cells are names: at most some are blank, none is a number."""
    written = [n for n in names if n]
    return len(written) > 0.5 * len(names) and not any(NUMBER.fullmatch(n) for n in written)


def _row(row: Sequence[str], width: int) -> bool:
    while len(row) > width and not row[-1]:
        row = row[:-1]
    return len(row) == width and any(NUMBER.fullmatch(cell) for cell in row)
