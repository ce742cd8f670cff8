"""A polars data frame -> a block: numbers as float, moments as ISO text, structures and short arrays field by field."""

from __future__ import annotations

import numpy as np
import polars as pl

from rovval.core.data import Array
from rovval.ingest.contents.block import MOST_MEMBERS, Block
from rovval.ingest.table.cells import numbers_and_texts

DAY, TIME = "%Y-%m-%d", "%H:%M:%S%.f"


def block_of(topic: str, frame: pl.DataFrame) -> Block:
    """The block of a table. Rows that hold nothing at all are left out; what is no number, text or moment is named in ``left_out``."""
    flat, left_out = _flat(frame)
    if flat.width:
        flat = flat.filter(~pl.all_horizontal(pl.all().is_null()))
    numbers: dict[str, Array] = {}
    texts: dict[str, list[str]] = {}
    units: dict[str, str] = {}
    for column in flat.iter_columns():
        kind = column.dtype
        if kind.is_numeric() or kind == pl.Boolean:
            numbers[column.name] = np.array(column.cast(pl.Float64).fill_null(np.nan).to_numpy(), dtype=np.float64)
        elif isinstance(kind, pl.Duration):
            numbers[column.name] = np.array(column.cast(pl.Duration("ns")).cast(pl.Int64).cast(pl.Float64).fill_null(np.nan).to_numpy()) * 1e-9
            units[column.name] = "s"
        elif isinstance(kind, pl.Datetime):
            utc = column.dt.convert_time_zone("UTC").dt.replace_time_zone(None) if kind.time_zone else column
            texts[column.name] = utc.dt.strftime(f"{DAY} {TIME}").fill_null("").to_list()
        elif kind in (pl.Date, pl.Time):
            texts[column.name] = column.dt.strftime(DAY if kind == pl.Date else TIME).fill_null("").to_list()
        else:
            found, words = numbers_and_texts(column.str.strip_chars().to_frame())
            numbers |= found
            texts |= words
    return Block(topic, numbers=numbers, texts=texts, units=units, left_out=left_out)


def _flat(frame: pl.DataFrame) -> tuple[pl.DataFrame, dict[str, str]]:
    """The frame without nesting: ``a.b`` of structures, ``a[0]`` of arrays; and what cannot be a column."""
    columns: dict[str, pl.Series] = {}
    left_out: dict[str, str] = {}
    waiting = [(c.name, c) for c in reversed(frame.get_columns())]
    while waiting:
        name, column = waiting.pop()
        kind = column.dtype
        if isinstance(kind, pl.Struct):
            waiting += [(f"{name}.{f.name}", column.struct.field(f.name)) for f in reversed(kind.fields)]
        elif isinstance(kind, (pl.List, pl.Array)):
            lists = column.cast(pl.List(kind.inner)) if isinstance(kind, pl.Array) else column
            longest = int(lists.list.len().max() or 0)  # type: ignore[arg-type]
            if longest > MOST_MEMBERS:
                left_out[name] = f"{longest} elements"
            else:
                waiting += [(f"{name}[{i}]", lists.list.get(i, null_on_oob=True)) for i in reversed(range(longest))]
        elif kind.is_numeric() or kind.is_temporal() or kind in (pl.Boolean, pl.String, pl.Categorical, pl.Enum):
            columns[name] = column.cast(pl.String) if kind in (pl.Categorical, pl.Enum) else column
        else:
            left_out[name] = str(kind)
    return pl.DataFrame({name: c.alias(name) for name, c in columns.items()}), left_out
