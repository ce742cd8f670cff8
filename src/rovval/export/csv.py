"""The run as a table of text: a row a sample, an empty cell where missing, the unit in the header; in the axes and units of `parquet`."""

from __future__ import annotations

from pathlib import Path

from rovval.export.content import Content
from rovval.export.parquet import table
from rovval.storage.atomic import drafts

SUFFIX = ".csv"


def write(content: Content, path: Path) -> tuple[Path, ...]:
    """One file, its stamps with all their digits. Raises as `drafts` does."""
    text = table(content).write_csv(datetime_format="%Y-%m-%dT%H:%M:%S%.9fZ")
    with drafts(path) as [draft]:
        draft.write_text(text, encoding="utf-8", newline="\n")
    return (path,)
