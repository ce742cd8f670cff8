"""Logs as a table of text, one row a sample: CSV and its relatives, however exported."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rovval.core.data import RawLog
from rovval.core.errors import BadInput, Finding, all_at_once
from rovval.core.units import SI
from rovval.ingest import text_table
from rovval.ingest.clock import DAY_S, increasing_stamps
from rovval.ingest.compression import opened
from rovval.ingest.files import sha256
from rovval.ingest.header import header_of
from rovval.ingest.inspection.block import Block
from rovval.ingest.profile import Profile, Source

if TYPE_CHECKING:
    import polars as pl

SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".log", ".asc")
HEAD = 262_144  # bytes that hold the banner and the header
SPELLINGS = {
    "°": "deg", "degrees": "deg", "degree": "deg", "°/s": "deg/s", "dps": "deg/s", "m/s^2": "m/s2", "m/s²": "m/s2",
    "1/min": "rpm", "r/min": "rpm", "metre": "m", "meter": "m", "metres": "m", "meters": "m", "mps": "m/s", "v": "V", "knots": "knot",
    "radps": "rad/s", "radians": "rad", "kn": "knot", "kt": "knot",
}  # fmt: skip


def sniff(path: Path) -> bool:
    """Whether the file can be a table of text."""
    with opened(path) as file:
        head = file.read(4096)
    return text_table.byte_order(head) is not None or (b"\0" not in head and b"\n" in head.replace(b"\r", b"\n"))


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns of ``profile`` that the file has not, and `absent` ones that it has."""
    table = text_table.split(text_table.decode(path, HEAD)[0], _wanted(profile))
    header = table.header if table else ()
    gone = [c for c in _wanted(profile, required=True) if not any(text_table.fits(c, h) for h in header)]
    return (*gone, *(f"not {c}" for c in profile.absent if any(text_table.fits(c, h) for h in header)))


def read(path: Path, profile: Profile) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing column, or what else makes the file useless."""
    from rovval.ingest.assembly import Signal, build
    from rovval.ingest.cells import frame, numbers
    from rovval.ingest.stamps import stamps

    table, lost = _table(path, profile)
    where = _columns(path, profile, table)
    text = frame(table, {c: at for _, columns in where.values() for c, at in columns.items()} | _clock_columns(profile, table))
    values, found = numbers(_only_numbers(text, profile), table, str(path))
    logged, t0_ns = stamps(path, profile, text, values)
    rows, t, clock_found = increasing_stamps(logged, np.array(table.lines), str(path))
    start = {"time_of_day_s_at_start": f"{float(t[0]) % DAY_S:.3f}"} if profile.time.kind == "time_of_day" else {}
    signals = {}
    for name, (source, columns) in where.items():
        block = np.stack([values[c][rows] for c in columns], axis=1)
        signals[name] = Signal(t - t[0], block if len(columns) > 1 else block[:, 0], "row", source)
    properties = {**start, "rows": str(len(rows)), "columns_unused": ", ".join(_unused(profile, table, where))}
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


def _wanted(profile: Profile, required: bool = False) -> list[str]:
    sources = [s for s in profile.channels.values() if not (required and s.optional)]
    return [*profile.time.columns, *(c for s in sources for c in ((s.column,) if s.column else s.columns))]


def _table(path: Path, profile: Profile) -> tuple[text_table.Table, tuple[Finding, ...]]:
    text, lost = text_table.decode(path)
    table = text_table.split(text, _wanted(profile))
    if table is None:
        wanted = ", ".join(_wanted(profile, required=True))
        hint = "give --profile for another source, or write a profile (a TOML file) for this one"
        raise BadInput(f"{path}: no header of profile {profile.name!r} in its first {text_table.HEADER_WITHIN} lines; wanted: {wanted}", hint)
    return table, lost


def _find(path: Path, pattern: str, header: Sequence[str]) -> list[int]:
    hits = [i for i, name in enumerate(header) if text_table.fits(pattern, name)]
    exact = [i for i in hits if header[i] == pattern]
    if "*" not in pattern and len(hits) > 1 and len(exact) != 1:
        names = ", ".join(repr(header[i]) for i in hits)
        raise BadInput(f"{path}: column {pattern!r} is there {len(hits)} times ({names})", "remove or rename all but one")
    return exact if exact and "*" not in pattern else hits


def _columns(path: Path, profile: Profile, table: text_table.Table) -> dict[str, tuple[Source, dict[str, int]]]:
    """Channel -> its source and columns (name -> position). Raises `BadInput` with every missing column and near matches."""
    where: dict[str, tuple[Source, dict[str, int]]] = {}
    gone, units = [], []
    for name, source in profile.channels.items():
        patterns = (source.column,) if source.column else source.columns
        hits = [(p, _find(path, p, table.header)) for p in patterns]
        if absent := [p for p, found in hits if not found]:
            gone += [] if source.optional else absent
            continue
        units += [u for _, found in hits for i in found if (u := _unit_clash(table.header[i], source))]
        if "*" in name:
            for at in hits[0][1]:
                member = text_table.member(patterns[0], table.header[at]) or ""
                key = name.replace("*", member)
                if key in where:
                    first = next(iter(where[key][1]))
                    raise BadInput(f"{path}: two columns are {key!r}: {first!r} and {table.header[at]!r}", "remove one")
                where[key] = (source, {table.header[at]: at})
        else:
            where[name] = (source, {table.header[found[0]]: found[0] for _, found in hits})
    gone += [c for c in profile.time.columns if not _find(path, c, table.header)]
    if gone:
        raise BadInput(all_at_once([_near(c, table.header) for c in gone], f"{path}: missing columns of profile {profile.name!r}"), _HINT)
    if units:
        raise BadInput(all_at_once(units, f"{path}: units"), "state the unit of the header in a profile of your own")
    if not table.rows:
        raise BadInput(f"{path}: a header and no complete row below it", "was the export interrupted?")
    return where


_HINT = "rename the columns, give --profile for another source, or write a profile (a TOML file) for this one"


def _near(column: str, header: Sequence[str]) -> str:
    close = difflib.get_close_matches(text_table.plain_name(column), [text_table.plain_name(h) for h in header], n=3, cutoff=0.6)
    names = [h for h in header if text_table.plain_name(h) in close]
    return f"{column!r}" + (f" (near: {', '.join(repr(n) for n in names)})" if names else "")


def _unit_clash(cell: str, source: Source) -> str:
    stated = (text_table.stated_unit(cell) or "").strip()
    unit = stated if stated in SI else SPELLINGS.get(stated.casefold(), stated)
    if unit not in SI or source.unit not in SI or SI[unit] == SI[source.unit]:
        return ""
    return f"column {cell!r} says {stated!r}, the profile says {source.unit!r}"


def _clock_columns(profile: Profile, table: text_table.Table) -> dict[str, int]:
    return {f"time.{c}": i for c in profile.time.columns for i in [next(i for i, h in enumerate(table.header) if text_table.fits(c, h))]}


def _only_numbers(text: pl.DataFrame, profile: Profile) -> pl.DataFrame:
    return text.select([c for c in text.columns if not (profile.time.kind == "datetime" and c.startswith("time."))])


def _unused(profile: Profile, table: text_table.Table, where: dict[str, tuple[Source, dict[str, int]]]) -> list[str]:
    used = {c for _, columns in where.values() for c in columns}
    return [h for h in table.header if h and h not in used and not any(text_table.fits(c, h) for c in profile.time.columns)]
