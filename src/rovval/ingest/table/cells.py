"""Cells of text into numbers: what is blank is missing, what is neither is counted and named, nothing is guessed."""

from __future__ import annotations

import io
from collections.abc import Mapping

import numpy as np
import polars as pl

from rovval.core.data import Array
from rovval.ingest.table.text_table import cells

BLANK = ("", "nan", "-", "--", "null", "none", "n/a", "na", "#n/a", "-nan", "nan(ind)", "-nan(ind)")
LONGEST_EXAMPLE = 40  # characters of a cell that a message shows
DECIMAL_COMMA = r"^[+-]?\d+,\d*([eE][+-]?\d+)?$"


def cells_of(text: bytes, rows: int, separator: str, width: int, columns: Mapping[str, int]) -> pl.DataFrame:
    """The wanted columns (name -> position) of ``rows`` lines of ``width`` cells as text, stripped."""
    names = [f"c{i}" for i in range(width)]
    quote = '"' if b'"' in text else None
    try:
        wide = pl.read_csv(io.BytesIO(text), has_header=False, infer_schema=False, separator=separator, quote_char=quote, new_columns=names)
    except pl.exceptions.PolarsError:
        wide = pl.DataFrame()
    if wide.shape != (rows, width):  # a stray quote makes rows run together: take them one by one
        apart = [cells(row, separator) for row in text.decode().split("\n")[:-1]]
        wide = pl.DataFrame({n: [row[i] if i < len(row) else None for row in apart] for i, n in enumerate(names)}, schema=dict.fromkeys(names, pl.String))
    return wide.select(pl.col(f"c{at}").str.strip_chars().alias(name) for name, at in columns.items())


def numbers_and_texts(text: pl.DataFrame) -> tuple[dict[str, Array], dict[str, list[str]]]:
    """Columns of which at least half of the written cells are numbers as float, NaN elsewhere; the others as text, "" where blank."""
    values: dict[str, Array] = {}
    texts: dict[str, list[str]] = {}
    for column in text.iter_columns():
        blank = (column.is_null() | column.str.to_lowercase().is_in(BLANK)).to_numpy()
        value = _cast(column)
        if np.isfinite(value).sum() >= 0.5 * (~blank).sum():
            value[blank | ~np.isfinite(value)] = np.nan
            values[column.name] = value
        else:
            texts[column.name] = ["" if empty else str(cell) for cell, empty in zip(column, blank, strict=True)]
    return values, texts


def shown(cell: str) -> str:
    """A cell as a message quotes it: its beginning, and how long it is, where a damaged row made it endless."""
    return repr(cell) if len(cell) <= LONGEST_EXAMPLE else f"{cell[:LONGEST_EXAMPLE]!r}... of {len(cell)} characters"


def _cast(column: pl.Series) -> Array:
    value = column.cast(pl.Float64, strict=False)
    failed = column.filter(value.is_null())
    if failed.str.contains(DECIMAL_COMMA).any() and not column.str.contains(r"\d\.\d").any():
        value = column.str.replace(",", ".", literal=True).cast(pl.Float64, strict=False)
    return np.array(value.fill_null(np.nan).to_numpy(), dtype=float)
