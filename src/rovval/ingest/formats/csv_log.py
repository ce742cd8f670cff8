"""Logs as a table of text, one row a sample: CSV and its relatives, however exported."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding
from rovval.ingest import text_table
from rovval.ingest.clock import DAY_S, increasing_stamps
from rovval.ingest.columns import clock_columns, columns_of, unused, wanted
from rovval.ingest.compression import opened
from rovval.ingest.files import sha256
from rovval.ingest.header import header_of
from rovval.ingest.inspection.block import Block
from rovval.ingest.profile import Profile

SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".log", ".asc")
ALSO: tuple[str, ...] = ()  # formats whose profiles this reads beside its own
HEAD = 262_144  # bytes that hold the banner and the header


def sniff(path: Path) -> bool:
    """Whether the file can be a table of text."""
    with opened(path) as file:
        head = file.read(4096)
    return text_table.byte_order(head) is not None or (b"\0" not in head and b"\n" in head.replace(b"\r", b"\n"))


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns of ``profile`` that the file has not, and `absent` ones that it has."""
    table = text_table.split(text_table.decode(path, HEAD)[0], wanted(profile))
    header = table.header if table else ()
    gone = [c for c in wanted(profile, required=True) if not any(text_table.fits(c, h) for h in header)]
    return (*gone, *(f"not {c}" for c in profile.absent if any(text_table.fits(c, h) for h in header)))


def read(path: Path, profile: Profile) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing column, or what else makes the file useless."""
    from rovval.ingest.assembly import Signal, build
    from rovval.ingest.cells import frame, numbers
    from rovval.ingest.stamps import stamps, written

    table, lost = _table(path, profile)
    where = columns_of(path, profile, table.header)
    if not table.rows:
        raise BadInput(f"{path}: a header and no complete row below it", "was the export interrupted?")
    text = frame(table, {c: at for _, columns in where.values() for c, at in columns.items()} | clock_columns(profile, table.header))
    as_text = [c for c in text.columns if c.startswith("time.") and written(profile.time)]
    values, found = numbers(text.drop(as_text), table, str(path))
    logged, t0_ns = stamps(path, profile, text, values)
    rows, t, clock_found = increasing_stamps(logged, np.array(table.lines), str(path))
    start = {"time_of_day_s_at_start": f"{float(t[0]) % DAY_S:.3f}"} if profile.time.kind == "time_of_day" else {}
    if profile.time.kind == "datetime":
        start = {"timezone": profile.time.timezone or "UTC where the stamps do not say theirs"}
    signals = {}
    for name, (source, columns) in where.items():
        block = np.stack([values[c][rows] for c in columns], axis=1)
        signals[name] = Signal(t - t[0], block if len(columns) > 1 else block[:, 0], "row", source)
    properties = {**start, "rows": str(len(rows)), "columns_unused": ", ".join(unused(profile, table.header, where))}
    t0 = None if t0_ns is None else t0_ns + round(float(t[0]) * 1e9)
    return build(profile, signals, path, sha256(path), t0, (*lost, *table.findings, *found, *clock_found), properties)


def contents(path: Path) -> Iterator[Block]:
    """The table's columns, numbers or text as their cells are. Raises `BadInput` where the file holds no table with a header."""
    from rovval.ingest.cells import frame, numbers_and_texts

    text, lost = text_table.decode(path)
    header = header_of(re.split(r"\r\n|\n|\r", text[:HEAD]))
    table = text_table.split(text, header) if header else None
    if table is None or not table.rows:
        raise BadInput(
            f"{path}: no line of names with rows of as many cells below it in its first {text_table.HEADER_WITHIN} lines",
            "give the columns names in a first line, one a column",
        )
    named: dict[str, int] = {}
    for at, name in enumerate(table.header):
        named.setdefault(name or f"(column {at + 1} without a name)", at)
    twice = sorted({n for n in table.header if n and table.header.count(n) > 1})
    again = [Finding("column_twice", ", ".join(twice), "the first of each is shown; a profile cannot name either")] if twice else []
    numbers, texts = numbers_and_texts(frame(table, named))
    facts = {"separator": repr(table.separator)}
    yield Block("", numbers=numbers, texts=texts, facts=facts, findings=(*lost, *table.findings, *again))


def _table(path: Path, profile: Profile) -> tuple[text_table.Table, tuple[Finding, ...]]:
    text, lost = text_table.decode(path)
    table = text_table.split(text, wanted(profile))
    if table is None:
        columns = ", ".join(wanted(profile, required=True))
        hint = "give --profile for another source, or write a profile (a TOML file) for this one"
        raise BadInput(f"{path}: no header of profile {profile.name!r} in its first {text_table.HEADER_WITHIN} lines; wanted: {columns}", hint)
    return table, lost
