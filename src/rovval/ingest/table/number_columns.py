"""Rows of text -> columns of numbers, block by block: what is blank is missing, what is neither is counted and named.

A block whose cells are all numbers or empty is read in one step; any other cell by cell (`rovval.ingest.table.cells`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import polars as pl

from rovval.core.counts import counted
from rovval.core.data import Array
from rovval.core.errors import BadInput, Finding, all_at_once
from rovval.core.long_columns import LongColumn, at_rest
from rovval.ingest.table.cells import BLANK, DECIMAL_COMMA, cells_of, shown
from rovval.ingest.table.text_rows import Index, Rows, Tally
from rovval.ingest.table.text_table import first_few

POINT = r"\d\.\d"


class NumberColumns:
    """``columns``: name -> position in the header, of numbers; ``texts`` the same of what is kept as text, such as stamps, which are more than
    a float holds. `arrays` and `findings` are whole once every block was taken."""

    def __init__(self, columns: Mapping[str, int], texts: Mapping[str, int], separator: str, width: int) -> None:
        self.columns, self.texts, self.separator, self.width = columns, texts, separator, width
        self._texts: dict[str, list[pl.Series]] = {name: [] for name in texts}
        self._values = {name: LongColumn() for name in columns}
        self._lines = LongColumn(np.int64)
        self._blank = {name: Tally() for name in columns}
        self._bad = {name: Tally() for name in columns}
        self._examples: dict[str, list[str]] = {name: [] for name in columns}
        self._broken: set[str] = set()  # columns that held a number that is not whole
        self._comma: set[str] = set()  # columns with a decimal comma
        self._both: set[str] = set()  # and those that have points further on

    def take(self, rows: Rows) -> None:
        """Append the numbers of some rows."""
        self._lines.append(rows.lines)
        if (read := self._read(rows)) is None:
            self._take_cells(rows)
            return
        for name, at in self.texts.items():
            self._texts[name].append(read[f"c{at}"].str.strip_chars())
        for name, at in self.columns.items():
            column = read[f"c{at}"]
            if column.dtype == pl.String:
                self._take_column(name, column.str.strip_chars(), rows.lines)
                continue
            if column.null_count():
                self._blank[name].add(*rows.lines[column.is_null().to_numpy()].tolist())
            self._append(name, column.fill_null(np.nan).to_numpy())

    def _append(self, name: str, more: Array) -> None:
        self._values[name].append(more)
        if name not in self._broken and (np.mod(more[np.isfinite(more)], 1.0) != 0).any():
            self._broken.add(name)

    def _read(self, rows: Rows) -> pl.DataFrame | None:
        """The columns as numbers; None where a cell is neither a number nor empty, or a quote may hide a separator."""
        if b'"' in rows.text or (self._comma and (self.separator == "," or b"." in rows.text)):
            return None
        kept: dict[str, type[pl.DataType]] = {f"c{at}": pl.Float64 for at in self.columns.values()} | {f"c{at}": pl.String for at in self.texts.values()}
        schema = {f"c{i}": kept.get(f"c{i}", pl.String) for i in range(self.width)}
        head = self.separator.join(schema).encode() + b"\n"
        try:
            read = pl.read_csv(
                head + rows.text, separator=self.separator, quote_char=None, schema=schema, columns=list(kept), decimal_comma=bool(self._comma)
            )
        except pl.exceptions.PolarsError:
            return None
        if len(read) != len(rows.lines):
            return None
        numbers = [read[n] for n, kind in kept.items() if kind == pl.Float64]
        return read if all(bool((c.is_finite() | c.is_null()).all()) for c in numbers) else None

    def _take_cells(self, rows: Rows) -> None:
        text = cells_of(rows.text, len(rows.lines), self.separator, self.width, {f"c{at}": at for at in (*self.columns.values(), *self.texts.values())})
        for name, at in self.texts.items():
            self._texts[name].append(text[f"c{at}"])
        for name, at in self.columns.items():
            self._take_column(name, text[f"c{at}"], rows.lines)

    def _take_column(self, name: str, column: pl.Series, lines: Index) -> None:
        """Cell by cell: blank, number, or neither."""
        blank = (column.is_null() | column.str.to_lowercase().is_in(BLANK)).to_numpy()
        value = self._cast(name, column)
        bad = ~blank & ~np.isfinite(value)
        value[blank | bad] = np.nan
        self._append(name, value)
        self._blank[name].add(*lines[blank].tolist())
        if bad.any():
            self._bad[name].add(*lines[bad].tolist())
            self._examples[name] = [*self._examples[name], *(shown(c) for c in column.filter(pl.Series(bad))[:3])][:3]

    def _cast(self, name: str, column: pl.Series) -> Array:
        """Numbers with a decimal point, or with a comma where the column has that and never had a point."""
        value = column.cast(pl.Float64, strict=False)
        pointed = column.str.contains(POINT).any()
        if pointed and name in self._comma:
            self._both.add(name)
        failed = column.filter(value.is_null())
        if len(failed) and failed.str.contains(DECIMAL_COMMA).any() and not pointed and (name in self._comma or name not in self._broken):
            self._comma.add(name)
            value = column.str.replace(",", ".", literal=True).cast(pl.Float64, strict=False)
        return np.array(value.fill_null(np.nan).to_numpy(), dtype=float)

    def arrays(self) -> tuple[dict[str, Array], pl.DataFrame, Index, tuple[Finding, ...]]:
        """The numbers (NaN where missing), the columns kept as text, the rows' lines, each row once, and what was found of rows that were
        there again."""
        lines = self._lines.array()
        values = {name: column.array() for name, column in self._values.items()}
        text = pl.DataFrame({name: pl.concat(parts) if parts else pl.Series(dtype=pl.String) for name, parts in self._texts.items()})
        again = _repeated(values, text)
        if not len(again):
            return values, text, lines, ()
        once = np.ones(len(lines), dtype=bool)
        once[again] = False
        detail = f"{counted(len(again), 'row')} repeated, stamp included; dropped"
        found = Finding("repeated_row", first_few(lines[again].tolist()), detail)
        return {n: at_rest(v[once]) for n, v in values.items()}, text.filter(pl.Series(once)) if text.width else text, lines[once], (found,)

    def findings(self, path: str) -> tuple[Finding, ...]:
        """Blank cells and cells that are no numbers. Raises `BadInput` naming every column of which more than half are not."""
        findings: list[Finding] = []
        hopeless = [f"column {name!r} has decimal commas, and further on decimal points" for name in self.columns if name in self._both]
        rows = len(self._lines)
        for name in self.columns:
            blank, bad = self._blank[name], self._bad[name]
            if blank.count:
                findings.append(Finding("blank_cell", name, f"{counted(blank.count, 'blank cell')}, from line {blank.first[0]}; taken as missing"))
            if bad.count:
                examples, where = ", ".join(self._examples[name]), first_few(bad.first, more=bad.count)
                findings.append(Finding("not_a_number", name, f"{counted(bad.count, 'cell')} without a number ({examples}; {where}); dropped"))
                if bad.count > 0.5 * (rows - blank.count):
                    hopeless.append(f"column {name!r}: {bad.count} of {rows - blank.count} cells are not numbers, such as {examples} ({where})")
        if hopeless:
            hint = "are separator and decimal sign mixed, or is this another column than the profile means?"
            raise BadInput(all_at_once(hopeless, f"{path}: unreadable"), hint)
        return tuple(findings)


def _repeated(values: Mapping[str, Array], text: pl.DataFrame) -> Index:
    """Rows that are an earlier one again in every column (k,): looked for among those alone whose stamp was there before."""
    stamps: dict[str, Array | pl.Series] = {n: v for n, v in values.items() if n.startswith("time.") and n not in text.columns}
    stamp = pl.DataFrame(stamps | {n: text[n] for n in text.columns})
    if not stamp.width or not len(stamp) or (not text.width and _rising([values[n] for n in stamps])):
        return np.zeros(0, dtype=np.int64)
    twice = np.flatnonzero(stamp.is_duplicated().to_numpy())
    if not len(twice):
        return np.zeros(0, dtype=np.int64)
    table = pl.DataFrame({n: v[twice] for n, v in values.items()} | {f"text:{n}": text[n].gather(twice) for n in text.columns})
    first = table.select(pl.struct(pl.all()).is_first_distinct()).to_series().to_numpy()
    return np.asarray(twice[~first], dtype=np.int64)


def _rising(columns: Sequence[np.ndarray[Any, Any]]) -> bool:
    """Whether each row comes after the one before it, by the first column, then the second, ...: then none is there twice."""
    after = np.zeros(len(columns[0]) - 1, dtype=bool)
    for column in reversed(columns):
        after = (column[1:] > column[:-1]) | ((column[1:] == column[:-1]) & after)
    return bool(after.all())
