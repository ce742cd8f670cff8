"""Which column of a table is which channel, as a profile says: by name, whatever its case, decoration and unit in brackets."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from pathlib import Path

from rovval.core.errors import BadInput, all_at_once
from rovval.core.units import SI
from rovval.ingest.profile import GEODETIC, Profile, Source
from rovval.ingest.table import text_table
from rovval.ingest.table.unit_names import unit_of

Columns = dict[str, tuple[Source, dict[str, int]]]  # channel -> its source and columns (name -> position in the header)


def wanted(profile: Profile, required: bool = False) -> list[str]:
    """The column patterns of a profile, those of its clock first; only the required ones if asked for."""
    sources = [s for s in profile.channels.values() if not (required and s.optional)]
    return [*profile.time.columns, *(c for s in sources for c in ((s.column,) if s.column else s.columns))]


def _find(path: Path, pattern: str, header: Sequence[str]) -> list[int]:
    hits = [i for i, name in enumerate(header) if text_table.fits(pattern, name)]
    exact = [i for i in hits if header[i] == pattern]
    if "*" not in pattern and len(hits) > 1 and len(exact) != 1:
        names = ", ".join(repr(header[i]) for i in hits)
        raise BadInput(f"{path}: column {pattern!r} is there {len(hits)} times ({names})", "remove or rename all but one")
    return exact if exact and "*" not in pattern else hits


def columns_of(path: Path, profile: Profile, header: Sequence[str]) -> Columns:
    """The columns of each channel. Raises `BadInput` with every missing column and near matches."""
    where: Columns = {}
    gone, units = [], []
    for name, source in profile.channels.items():
        patterns = (source.column,) if source.column else source.columns
        hits = [(p, _find(path, p, header)) for p in patterns]
        if absent := [p for p, found in hits if not found]:
            gone += [] if source.optional else absent
            continue
        units += [u for _, found in hits for i in found if (u := _unit_clash(header[i], source))]
        if "*" in name:
            for at in hits[0][1]:
                member = text_table.member(patterns[0], header[at]) or ""
                key = name.replace("*", member)
                if key in where:
                    first = next(iter(where[key][1]))
                    raise BadInput(f"{path}: two columns are {key!r}: {first!r} and {header[at]!r}", "remove one")
                where[key] = (source, {header[at]: at})
        else:
            where[name] = (source, {header[found[0]]: found[0] for _, found in hits})
    gone += [c for c in profile.time.columns if not _find(path, c, header)]
    if gone:
        raise BadInput(all_at_once([_near(c, header) for c in gone], f"{path}: missing columns of profile {profile.name!r}"), _HINT)
    if units:
        raise BadInput(all_at_once(units, f"{path}: units"), "state the unit of the header in a profile of your own")
    return where


_HINT = "rename the columns, give --profile for another source, or write a profile (a TOML file) for this one"


def _near(column: str, header: Sequence[str]) -> str:
    close = difflib.get_close_matches(text_table.plain_name(column), [text_table.plain_name(h) for h in header], n=3, cutoff=0.6)
    names = [h for h in header if text_table.plain_name(h) in close]
    return f"{column!r}" + (f" (near: {', '.join(repr(n) for n in names)})" if names else "")


def _unit_clash(cell: str, source: Source) -> str:
    stated = (text_table.stated_unit(cell) or "").strip()
    unit = unit_of(stated)
    if unit not in SI or source.unit not in SI or SI[unit] == SI[source.unit] or (unit, source.unit) == ("deg", GEODETIC):
        return ""
    return f"column {cell!r} says {stated!r}, the profile says {source.unit!r}"


def clock_columns(profile: Profile, header: Sequence[str]) -> dict[str, int]:
    """``time.COLUMN`` -> position, of the columns that hold the stamps; they are there (`columns_of`)."""
    return {f"time.{c}": i for c in profile.time.columns for i in [next(i for i, h in enumerate(header) if text_table.fits(c, h))]}


def unused(profile: Profile, header: Sequence[str], where: Columns) -> list[str]:
    """Columns that the profile says nothing of."""
    used = {c for _, columns in where.values() for c in columns}
    return [h for h in header if h and h not in used and not any(text_table.fits(c, h) for c in profile.time.columns)]
