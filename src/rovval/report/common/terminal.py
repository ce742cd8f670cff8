"""Text for a terminal: no line is longer than the narrowest one that people use."""

from __future__ import annotations

import re
from textwrap import wrap

WIDTH = 80  # columns
LAST_COLUMN = 0.6  # of the width: a last column that begins further right leaves no room for words (chosen)
_COLUMN = re.compile(r"\s{2,}(?=\S)")


def fitted(text: str) -> str:
    """The text with its longer lines broken between words; what is broken goes on below the last column of its line, or below its first word."""
    return "\n".join(part for line in text.split("\n") for part in (_broken(line) if len(line) > WIDTH else [line]))


def _broken(line: str) -> list[str]:
    columns = [found.end() for found in _COLUMN.finditer(line) if found.end() <= LAST_COLUMN * WIDTH]
    indent = columns[-1] if columns else len(line) - len(line.lstrip())
    return wrap(line, WIDTH, subsequent_indent=" " * indent, break_long_words=False, break_on_hyphens=False)
