"""Logs as a workbook (.xlsx, .xls, .xlsm, .xlsb, .ods): each sheet with a header and rows below it is a table."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from datetime import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding, UsageProblem
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block
from rovval.ingest.profile import Profile

if TYPE_CHECKING:
    import polars as pl

SUFFIXES = (".xlsx", ".xls", ".xlsm", ".xlsb", ".ods")
ALSO: tuple[str, ...] = ("csv_log",)
MAGIC = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1")  # a zip (Office Open XML, OpenDocument), a compound file (Excel 97)
DAY_ZERO_YEAR = 1904  # workbooks count days from 1899-12-30, some from 1904-01-01 (ECMA-376, 18.17.4.1)


def sniff(path: Path) -> bool:
    """Whether the file begins as a workbook does."""
    with path.open("rb") as file:
        return file.read(8).startswith(MAGIC)


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns (or sheets, of a profile that names topics) that the workbook has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in

    return missing_in({b.topic: (*b.numbers, *b.texts) for b in contents(path)}, profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing column, `UsageProblem` without fastexcel."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, contents(path, progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """The table of each sheet that has one; a sheet without is said. Raises `BadInput` for a damaged file, `UsageProblem` without fastexcel."""
    try:
        import fastexcel
    except ImportError:
        raise UsageProblem(f"{path}: a workbook needs fastexcel", "pip install 'rovval[spreadsheet]'") from None
    try:
        book = fastexcel.read_excel(path)
        for number, name in enumerate(book.sheet_names):
            progress(f"reading sheet {name}", number / len(book.sheet_names))
            yield _block(book, name)
    except fastexcel.FastExcelError as error:
        said = str(error).splitlines()[0]
        raise BadInput(f"{path}: not readable as a workbook: {said}", "open it in a spreadsheet and save it again, or export CSV") from None


def _block(book: Any, name: str) -> Block:
    """The rows below the sheet's header, which may have a banner above it."""
    from rovval.ingest.contents.frame_block import block_of
    from rovval.ingest.table.header import header_of
    from rovval.ingest.table.text_table import HEADER_WITHIN

    head = book.load_sheet(name, header_row=None, skip_rows=0, n_rows=HEADER_WITHIN, dtypes="string").to_polars()
    lines = ["\t".join(" ".join(cell.split()) if cell else "" for cell in row) for row in head.iter_rows()]
    names = header_of(lines)
    if names is None:
        return Block(name, findings=(Finding("no_table", f"sheet {name!r}", "holds no line of names with rows of numbers below it"),))
    at = next(i for i, line in enumerate(lines) if tuple(cell.strip() for cell in line.split("\t")) == names)
    frame = book.load_sheet(name, header_row=None, skip_rows=at + 1).to_polars()
    return block_of(name, _days_and_times(frame.rename(dict(zip(frame.columns, _distinct(names), strict=False)))))


def _distinct(names: Sequence[str]) -> list[str]:
    """The names of a header, also of columns that share one or have none: none of them is what a profile means then."""
    again = Counter(n for n in names if n)
    seen: Counter[str] = Counter()
    out = []
    for at, name in enumerate(names, 1):
        seen[name] += 1
        out.append(f"(column {at} without a name)" if not name else f"{name} ({seen[name]} of {again[name]})" if again[name] > 1 else name)
    return out


def _days_and_times(frame: pl.DataFrame) -> pl.DataFrame:
    """A column of days alone or of times alone as such: a workbook holds both as moments, times on the day from which it counts."""
    import polars as pl

    def plain(column: pl.Series) -> pl.Series:
        if not isinstance(column.dtype, pl.Datetime) or column.null_count() == len(column):
            return column
        if int(column.dt.year().max() or 0) <= DAY_ZERO_YEAR:  # type: ignore[arg-type]
            return column.dt.time()
        return column.dt.date() if (column.dt.time().drop_nulls() == time()).all() else column

    return frame.with_columns(plain(column) for column in frame.get_columns())
