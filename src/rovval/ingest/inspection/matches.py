"""Which channels of a profile a log holds, by what `contents` says of it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from fnmatch import fnmatchcase

from rovval.ingest.inspection.summary import Contents
from rovval.ingest.profile import ATTITUDE, Profile, Source
from rovval.ingest.table import text_table

QUATERNIONS = ([".w", ".x", ".y", ".z"], ["[0]", "[1]", "[2]", "[3]"], ["1", "2", "3", "4"])  # how the formats name the members of one


@dataclass(frozen=True, slots=True)
class Match:
    """``found``: channel -> its places in the log, (topic, field) each, "" for the topic of a table; ``gone``: channels that it has not, with the
    optional ones apart."""

    profile: str
    found: dict[str, tuple[tuple[str, str], ...]]
    gone: tuple[str, ...]
    optional_gone: tuple[str, ...]


def match(profile: Profile, contents: Contents) -> Match:
    """What of ``profile`` the log holds."""
    found: dict[str, tuple[tuple[str, str], ...]] = {}
    gone: list[str] = []
    optional: list[str] = []
    for name, source in profile.channels.items():
        here = dict(_places(name, source, contents))
        found |= here
        if not here:
            (optional if source.optional else gone).append(name)
    return Match(profile.name, found, tuple(gone), tuple(optional))


def _places(name: str, source: Source, contents: Contents) -> Iterator[tuple[str, tuple[tuple[str, str], ...]]]:
    if source.column or source.columns:
        for topic, table in contents.topics.items():
            yield from _columns(name, source, topic, list(table.fields))
        return
    held = [known for known in source.topics if any(fnmatchcase(topic, known) for topic in contents.topics)]
    for topic, summary in contents.topics.items():
        pattern = re.escape(held[0]).replace(r"\*", "(.+)") if held else "$^"
        if (hit := re.fullmatch(pattern, topic)) is None:
            continue
        fields = _fields(name, str(source.field), list(summary.fields))
        if fields:
            yield name.replace("*", hit.group(1) if hit.groups() else ""), tuple((topic, f) for f in fields)


def _columns(name: str, source: Source, topic: str, header: list[str]) -> Iterator[tuple[str, tuple[tuple[str, str], ...]]]:
    if source.columns:
        hits = [next((h for h in header if text_table.fits(c, h)), None) for c in source.columns]
        if all(hits):
            yield name, tuple((topic, str(h)) for h in hits)
        return
    pattern = str(source.column)
    for h in header:
        if text_table.fits(pattern, h):
            yield (name.replace("*", text_table.member(pattern, h) or "") if "*" in pattern else name), ((topic, h),)
            if "*" not in pattern:
                return


def _fields(name: str, address: str, fields: list[str]) -> list[str]:
    if name != ATTITUDE:
        return [address] if address in fields else []
    return next((whole for ends in QUATERNIONS if set(whole := [address + e for e in ends]) <= set(fields)), [])
