"""Logs as a table of text, one row a sample: CSV and its relatives, however exported."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding
from rovval.ingest.assembly.columns import clock_columns, columns_of, unused, wanted
from rovval.ingest.clocks.clock import DAY_S, increasing_stamps
from rovval.ingest.contents.block import Block
from rovval.ingest.files import sha256
from rovval.ingest.files.compression import opened
from rovval.ingest.profile import Profile
from rovval.ingest.table import text_table
from rovval.ingest.table.header import header_of
from rovval.ingest.table.text_rows import TextRows

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
    place = text_table.header_place(text_table.decode(path, HEAD)[0], wanted(profile))
    header = place[0] if place else ()
    gone = [c for c in wanted(profile, required=True) if not any(text_table.fits(c, h) for h in header)]
    return (*gone, *(f"not {c}" for c in profile.absent if any(text_table.fits(c, h) for h in header)))


def read(path: Path, profile: Profile) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing column, or what else makes the file useless."""
    from rovval.ingest.assembly import Signal, build
    from rovval.ingest.clocks.stamps import stamps, written
    from rovval.ingest.table.number_columns import NumberColumns

    header, at, separator = _header(path, profile)
    where = columns_of(path, profile, header)
    clock = clock_columns(profile, header)
    table = TextRows(path, header, at, separator)
    as_text = clock if profile.time.kind == "epoch" or written(profile.time) else {}
    found = {c: k for _, columns in where.values() for c, k in columns.items()} | ({} if written(profile.time) else clock)
    numbers = NumberColumns(found, as_text, separator, len(header))
    for whole in table.blocks():
        numbers.take(whole)
    spoiled = numbers.findings(str(path))
    values, text, lines, again = numbers.arrays()
    if not len(lines):
        raise BadInput(f"{path}: a header and no complete row below it", "was the export interrupted?")
    logged, t0_ns = stamps(path, profile, text, values)
    rows, t, clock_found = increasing_stamps(logged, lines, str(path))
    start = {"time_of_day_s_at_start": f"{float(t[0]) % DAY_S:.3f}"} if profile.time.kind == "time_of_day" else {}
    if profile.time.kind == "elapsed":
        start = {"stamp_s_at_start": repr(float(t[0]))}
    if profile.time.kind == "datetime":
        start = {"timezone": profile.time.timezone or "UTC where the stamps do not say theirs"}
    since = np.asarray(t - t[0])
    since.setflags(write=False)  # all channels share it
    if len(rows) < len(lines) or (np.diff(rows) != 1).any():
        values = {name: column[rows] for name, column in values.items()}
    for column in values.values():
        column.setflags(write=False)
    signals = {}
    for name, (source, columns) in where.items():
        block = [values[c] for c in columns]
        signals[name] = Signal(since, np.stack(block, axis=1) if len(block) > 1 else block[0], "row", source)
    properties = {**start, "rows": str(len(rows)), "columns_unused": ", ".join(unused(profile, header, where))}
    t0 = None if t0_ns is None else t0_ns + round(float(t[0]) * 1e9)
    return build(profile, signals, path, sha256(path), t0, (*table.findings(), *again, *spoiled, *clock_found), properties)


def contents(path: Path) -> Iterator[Block]:
    """The table's columns, numbers or text as their cells are. Raises `BadInput` where the file holds no table with a header."""
    from rovval.ingest.table.cells import cells_of, numbers_and_texts

    text, _ = text_table.decode(path, HEAD)
    names = header_of(re.split(r"\r\n|\n|\r", text))
    place = text_table.header_place(text, names) if names else None
    named: dict[str, int] = {}
    for at, name in enumerate(place[0] if place else ()):
        named.setdefault(name or f"(column {at + 1} without a name)", at)
    facts: dict[str, str] = {}
    if place is not None:
        table = TextRows(path, *place)
        for rows in table.blocks():
            facts = {"separator": repr(place[2])}
            numbers, texts = numbers_and_texts(cells_of(rows.text, len(rows.lines), place[2], len(place[0]), named))
            yield Block("", numbers=numbers, texts=texts, facts=facts)
    if place is None or not facts:
        raise BadInput(
            f"{path}: no line of names with rows of as many cells below it in its first {text_table.HEADER_WITHIN} lines",
            "give the columns names in a first line, one a column",
        )
    twice = sorted({n for n in place[0] if n and place[0].count(n) > 1})
    again = [Finding("column_twice", ", ".join(twice), "the first of each is shown; a profile cannot name either")] if twice else []
    if found := (*table.findings(), *again):
        yield Block("", findings=found)


def _header(path: Path, profile: Profile) -> tuple[tuple[str, ...], int, str]:
    """The header, its line (from 0) and the separator. Raises `BadInput` where there is none of the profile."""
    text, _ = text_table.decode(path, HEAD)
    found = text_table.header_place(text, wanted(profile))
    if found is None:
        columns = ", ".join(wanted(profile, required=True))
        hint = "give --profile for another source, or write a profile (a TOML file) for this one"
        raise BadInput(f"{path}: no header of profile {profile.name!r} in its first {text_table.HEADER_WITHIN} lines; wanted: {columns}", hint)
    return found
