"""Text that a log has at a moment -> markers, which `--from` and `--to` name."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from rovval.core.data import Array, Marker
from rovval.core.errors import Finding
from rovval.ingest.profile import Profile

LONGEST_NAME = 80  # characters of a text that are its marker's name: what a person would type or paste


def markers_of(profile: Profile, t: Array, texts: Sequence[str]) -> tuple[Marker, ...]:
    """The markers of stamps (s since the log's start, NaN where none is known) with what stands there. Of a column where it begins to say something,
    or something else; of a topic each message."""
    held = profile.markers is not None and profile.markers.column is not None
    named = [" ".join(text.split())[:LONGEST_NAME] for text in texts]
    begins = [bool(name) and not (held and before == name) for before, name in zip(["", *named], named, strict=False)]
    found = [Marker(float(s), name) for s, name, new in zip(t, named, begins, strict=True) if new and np.isfinite(s)]
    return tuple(sorted(found, key=lambda m: m.t_s))


def not_there(profile: Profile) -> Finding:
    """What is said where the log has not what the profile calls its markers."""
    m = profile.markers
    place = "" if m is None else m.column or f"{m.topic} {m.field}"
    return Finding("no_markers", place, "the log has none: --from and --to take seconds alone")
