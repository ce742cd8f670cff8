"""The files of a report: all of them or none."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

from rovval.storage.atomic import drafts
from rovval.storage.places import place

Writer = Callable[[Path], None]


def write_all(folder: Path, files: Mapping[str, str | Iterable[str] | Writer]) -> Mapping[str, Path]:
    """Write ``files`` (name -> text, whole or in pieces, or a function that writes to the path it is given) into ``folder``; name -> path."""
    places = {name: place(folder) / name for name in files}
    with drafts(*places.values()) as beside:
        for draft, content in zip(beside, files.values(), strict=True):
            if callable(content):
                content(draft)
            else:
                with draft.open("w", encoding="utf-8", newline="\n") as file:
                    file.writelines([content] if isinstance(content, str) else content)
    return MappingProxyType(places)
