"""Counts in sentences: 1 row, 2 rows."""

from __future__ import annotations


def counted(count: int, one: str, many: str = "") -> str:
    """A count with what is counted: ``one`` or ``many`` (``one`` with an s where none is given), verbs of these as they are said of so many."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"
