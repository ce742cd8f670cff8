"""The files of a report: all of them or none."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

from rovval.storage.atomic import drafts
from rovval.storage.places import place

Writer = Callable[[Path], None]


def write_all(folder: Path, files: Mapping[str, str | Writer]) -> Mapping[str, Path]:
    """Write ``files`` (name -> text, or a function that writes to the path it is given) into ``folder``; name -> path."""
    places = {name: place(folder) / name for name in files}
    with drafts(*places.values()) as beside:
        for draft, content in zip(beside, files.values(), strict=True):
            if isinstance(content, str):
                draft.write_text(content, encoding="utf-8", newline="\n")
            else:
                content(draft)
    return MappingProxyType(places)
