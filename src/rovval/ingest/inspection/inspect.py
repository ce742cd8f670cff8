"""What is in a log, and which profiles would read it: reader -> blocks -> summary -> stamps and matches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from rovval import ingest
from rovval.core.errors import BadInput, Finding
from rovval.core.progress import Progress, silent
from rovval.ingest.files import refuse_unusable
from rovval.ingest.inspection.matches import Match, match
from rovval.ingest.inspection.stamps_of_table import Stamps, readings
from rovval.ingest.inspection.summary import Contents, summarised

__all__ = ["Inspection", "inspect"]


@dataclass(frozen=True, slots=True)
class Inspection:
    """What is in a log. ``stamps``: of each topic without a clock of its own (a table), every
    reading of its columns as stamps, best first. ``matches``: each built-in profile of the
    format, those that find most first; ``lacking``: its name -> what it requires and the log has not, () where it reads the log as it is."""

    path: Path
    format: str
    contents: Contents
    stamps: Mapping[str, tuple[Stamps, ...]]
    matches: tuple[Match, ...]
    lacking: Mapping[str, tuple[str, ...]]

    @property
    def fits(self) -> tuple[str, ...]:
        """Profiles that read the log as it is."""
        return tuple(m.profile for m in self.matches if not self.lacking[m.profile])

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Damage met while reading."""
        return self.contents.findings


def inspect(path: Path, progress: Progress = silent) -> Inspection:
    """Everything that the log holds, by the reader whose format it is. Raises `BadInput` for a file that no reader reads."""
    path = Path(path)
    refuse_unusable(path)
    with ingest.plain(path, progress) as (whole, lost):
        found = _inspected(whole, progress)
    return found if whole == path else replace(found, path=path, contents=replace(found.contents, findings=(*lost, *found.findings)))


def _inspected(path: Path, progress: Progress) -> Inspection:
    refused: list[BadInput] = []
    for name in ingest.formats_of(path):
        try:
            contents = summarised(ingest.reader(name).contents(path, progress))
        except BadInput as error:
            refused.append(error)
            continue
        profiles = [ingest.load_profile(p) for p in ingest.profiles()]
        mine = [p for p in profiles if p.format in (name, *ingest.reader(name).ALSO)]
        matches = sorted((match(p, contents) for p in mine), key=lambda m: (len(m.gone), -len(m.found)))
        lacking = {p.name: ingest.reader(name).missing(path, p) for p in mine}
        if len(fit := [p for p in mine if not lacking[p.name]]) > 1:
            lacking |= ingest.implausible(path, fit)
        stamps = {topic: tuple(readings(t)) for topic, t in contents.topics.items() if t.rows and not t.clocks}
        return Inspection(path, name, contents, stamps, tuple(matches), lacking)
    raise refused[0]
