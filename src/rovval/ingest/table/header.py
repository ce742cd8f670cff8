"""Which line of a table is its header, when no profile says what to look for."""

from __future__ import annotations

import re
from collections.abc import Sequence

from rovval.ingest.table.text_table import HEADER_WITHIN, SEPARATORS, cells

ROWS_BELOW = 5  # rows below a header that have to be rows of its table: a banner has no table below it
NUMBER = re.compile(r"[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?")


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
