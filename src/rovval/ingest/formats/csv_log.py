"""Logs as a table of text, one row a sample: CSV and its relatives, however exported."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rovval.core.data import Array, RawLog
from rovval.core.errors import BadInput, Finding
from rovval.core.long_columns import at_rest
from rovval.core.progress import Progress, silent
from rovval.ingest.assembly.columns import Columns, clock_columns, columns_of, unused, wanted
from rovval.ingest.clocks.clock import DAY_S, increasing_stamps
from rovval.ingest.contents.block import Block
from rovval.ingest.files import sha256
from rovval.ingest.files.compression import opened
from rovval.ingest.profile import Profile
from rovval.ingest.table import text_table
from rovval.ingest.table.header import Header, header_of, header_with, stated_header
from rovval.ingest.table.text_rows import Index, TextRows

if TYPE_CHECKING:
    from rovval.ingest.assembly import Signal

SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".log", ".asc")
ALSO: tuple[str, ...] = ()  # formats whose profiles this reads beside its own
MARKERS = "markers"  # the key of the column that names moments
HEAD = 262_144  # bytes that hold the banner and the header


def sniff(path: Path) -> bool:
    """Whether the file can be a table of text."""
    with opened(path) as file:
        head = file.read(4096)
    return text_table.byte_order(head) is not None or (b"\0" not in head and b"\n" in head.replace(b"\r", b"\n"))


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns of ``profile`` that the file has not, and `absent` ones that it has."""
    place = _place(path, profile)
    header = place.names if place else ()
    gone = [c for c in wanted(profile, required=True) if not any(text_table.fits(c, h) for h in header)]
    return (*gone, *(f"not {c}" for c in profile.absent if any(text_table.fits(c, h) for h in header)))


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing column, or what else makes the file useless."""
    from rovval.ingest.assembly import build
    from rovval.ingest.assembly.markers import markers_of, not_there
    from rovval.ingest.clocks.stamps import stamps, written
    from rovval.ingest.table.number_columns import NumberColumns

    place = _header(path, profile)
    header = place.names
    where = columns_of(path, profile, header)
    clock = clock_columns(profile, header)
    table = TextRows(path, place)
    as_text = clock if profile.time.kind == "epoch" or written(profile.time) else {}
    found = {c: k for _, columns in where.values() for c, k in columns.items()} | ({} if written(profile.time) else clock)
    noted = _marker_column(profile, header)
    numbers = NumberColumns(found, {**as_text, **noted}, place.separator, len(header))
    for whole in table.blocks():
        numbers.take(whole)
        progress("reading rows", table.share)
    spoiled = numbers.findings(str(path))
    values, text, lines, again = numbers.arrays()
    del numbers  # it holds the columns, too
    if not len(lines):
        raise BadInput(f"{path}: a header and no complete row below it", "was the export interrupted?")
    logged, t0_ns = stamps(path, profile, text, values)
    rows, t, clock_found = increasing_stamps(logged, lines, str(path))
    start = {"time_of_day_s_at_start": f"{float(t[0]) % DAY_S:.3f}"} if profile.time.kind == "time_of_day" else {}
    if profile.time.kind == "elapsed":
        start = {"stamp_s_at_start": repr(float(t[0]))}
    if profile.time.kind == "datetime":
        start = {"timezone": profile.time.timezone or "UTC where the stamps do not say theirs"}
    since = at_rest(np.asarray(t - t[0]))
    since.setflags(write=False)  # all channels share it
    kept = rows if len(rows) < len(lines) or (np.diff(rows) != 1).any() else None
    properties = {**start, "rows": str(len(rows)), "columns_unused": ", ".join(unused(profile, header, where))}
    t0 = None if t0_ns is None else t0_ns + round(float(t[0]) * 1e9)
    markers = markers_of(profile, since, text[MARKERS].fill_null("").gather(rows).to_list()) if noted else ()
    found_all = [*table.findings(), *again, *spoiled, *clock_found, *([not_there(profile)] if profile.markers and not noted else [])]
    return build(profile, _signals(where, values, kept, since), path, sha256(path), t0, found_all, properties, markers)


def _marker_column(profile: Profile, header: Sequence[str]) -> dict[str, int]:
    """Where the column stands that names moments, if the profile has one and the file has it."""
    column = profile.markers.column if profile.markers else None
    at = next((i for i, name in enumerate(header) if column and text_table.fits(column, name)), None)
    return {} if at is None else {MARKERS: at}


def _signals(where: Columns, values: dict[str, Array], rows: Index | None, since: Array) -> Iterator[tuple[str, Signal]]:
    """Each channel's signal, of the ``rows`` that are kept. A column leaves ``values`` with the last channel that is made of it, so that a log is not
    held twice, as logged and in SI."""
    from rovval.ingest.assembly import Signal

    last = {c: name for name, (_, columns) in where.items() for c in columns}
    for name, (source, columns) in where.items():
        block = [values.pop(c) if last[c] == name else values[c] for c in columns]
        block = block if rows is None else [column[rows] for column in block]
        for column in block:
            column.setflags(write=False)
        yield name, Signal(since, np.stack(block, axis=1) if len(block) > 1 else block[0], "row", source)


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """The table's columns, numbers or text as their cells are. Raises `BadInput` where the file holds no table with a header."""
    from rovval.ingest.table.cells import cells_of, numbers_and_texts

    text, _ = text_table.decode(path, HEAD)
    names = header_of(re.split(r"\r\n|\n|\r", text))
    place = header_with(text, names) if names else None
    named: dict[str, int] = {}
    for at, name in enumerate(place.names if place else ()):
        named.setdefault(name or f"(column {at + 1} without a name)", at)
    facts: dict[str, str] = {}
    if place is not None:
        table = TextRows(path, place)
        for rows in table.blocks():
            progress("reading rows", table.share)
            facts = {"separator": repr(place.separator)}
            numbers, texts = numbers_and_texts(cells_of(rows.text, len(rows.lines), place.separator, len(place.names), named))
            yield Block("", numbers=numbers, texts=texts, facts=facts)
    if place is None or not facts:
        raise BadInput(
            f"{path}: no line of names with rows of as many cells below it in its first {text_table.HEADER_WITHIN} lines",
            "give the columns names in a first line, one a column, or in the profile (header = [...])",
        )
    twice = sorted({n for n in place.names if n and place.names.count(n) > 1})
    again = [Finding("column_twice", ", ".join(twice), "the first of each is shown; a profile cannot name either")] if twice else []
    if found := (*table.findings(), *again):
        yield Block("", findings=found)


def _place(path: Path, profile: Profile) -> Header | None:
    """The header of a file by a profile, which may state it; None where there is none of it."""
    text, _ = text_table.decode(path, HEAD)
    return stated_header(text, profile.header) if profile.header else header_with(text, wanted(profile))


def _header(path: Path, profile: Profile) -> Header:
    """The same. Raises `BadInput` where there is none of the profile."""
    found = _place(path, profile)
    if found is None and profile.header:
        hint = "count the columns of a line: header names each of them, in order"
        raise BadInput(f"{path}: no line has the {len(profile.header)} cells that header of profile {profile.name!r} names", hint)
    if found is None:
        columns = ", ".join(wanted(profile, required=True))
        hint = "give --profile for another source, or write a profile (a TOML file) for this one; header = [...] there for a file without a line of names"
        raise BadInput(f"{path}: no header of profile {profile.name!r} in its first {text_table.HEADER_WITHIN} lines; wanted: {columns}", hint)
    return found
