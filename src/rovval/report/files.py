"""Whole files or none: everything is written beside its place first and renamed into it when all of it is there."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType

Writer = Callable[[Path], None]


def write_all(folder: Path, files: Mapping[str, str | Writer]) -> Mapping[str, Path]:
    """Write ``files`` (name -> text, or a function that writes to the path it is given) into ``folder``; name -> path."""
    folder.mkdir(parents=True, exist_ok=True)
    beside = {name: folder / f".{name}.{os.getpid()}.part" for name in files}
    try:
        for name, content in files.items():
            if isinstance(content, str):
                beside[name].write_text(content, encoding="utf-8", newline="\n")
            else:
                content(beside[name])
        for name, path in beside.items():
            path.replace(folder / name)
    finally:
        for path in beside.values():
            path.unlink(missing_ok=True)
    return MappingProxyType({name: folder / name for name in files})
