"""A profile held against a log: what of it matched, what it makes of the first rows, and what of the log it leaves over."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from rovval import ingest
from rovval.core.data import RawLog
from rovval.ingest.inspection.matches import Match, match
from rovval.ingest.inspection.summary import Contents, summarised
from rovval.ingest.profile import Profile
from rovval.ingest.table.text_table import fits


@dataclass(frozen=True, slots=True)
class Check:
    """``raw``: the log as the profile reads it, in SI. ``left_over``: (topic, field) that nothing maps, "" for the topic of a table."""

    profile: Profile
    raw: RawLog
    contents: Contents
    match: Match
    left_over: tuple[tuple[str, str], ...]


def checked(profile: str, path: Path, timezone: str | None = None) -> Check:
    """The log of ``path`` by ``profile`` (a name or a TOML file). Raises what `rovval.ingest.read` raises: `UsageProblem` for a wrong profile,
    `BadInput` for a log that it cannot read, each with every problem at once."""
    raw = ingest.read(Path(path), profile, timezone)
    loaded = ingest.load_profile(profile)
    with ingest.plain(Path(path)) as (whole, _):
        contents = summarised(ingest.reader_of(whole, loaded).contents(whole))
    matched = match(loaded, contents)
    used = {place for places in matched.found.values() for place in places}
    left = [(topic.name, a) for topic in contents.topics.values() for a in topic.fields if (topic.name, a) not in used]
    left = [(topic, a) for topic, a in left if not any(fits(c, a) for c in loaded.time.columns)]
    return Check(loaded, raw, contents, matched, tuple(left))
