"""A table of text as it comes out of real exports: its encoding, its header and its separator."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

from rovval.core.errors import BadInput, Finding
from rovval.ingest.files.compression import lost_of, opened

SEPARATORS = (",", ";", "\t", "|")
HEADER_WITHIN = 200  # lines of banner above the header that are looked through
ELEMENT = re.compile(r"\S\[\d+\]$")  # of an array; "throttle [1]" is a unit
HEAD = 65536  # bytes by which the encoding of text is told
BEGINNING = 4096  # bytes in which text has no NUL


def decode(path: Path, most: int = -1) -> tuple[str, tuple[Finding, ...]]:
    """The file (or the whole lines of its first ``most`` bytes), unpacked, as text, and what is lost of it: UTF-8 or UTF-16 with or
    without a mark, else latin-1.

    Raises `BadInput` for binary content.
    """
    with opened(path) as file:
        content = file.read(most)
        lost = lost_of(file, path)
    if lost and not content:
        raise BadInput(f"{path}: {lost[0].detail}", "is the file whole? fetch or export it again")
    if 0 <= most == len(content):
        content = content[: content.rfind(b"\n") + 1] or content
    if (order := byte_order(content[:HEAD])) is not None:
        return content.decode(order, errors="replace").removeprefix("\ufeff"), lost
    if b"\0" in content[:BEGINNING]:  # further on it is what a crash left of a text: rows with it are no rows
        raise BadInput(f"{path}: is binary, not a table of text", "give --profile for its format")
    try:
        return content.decode("utf-8-sig"), lost
    except UnicodeDecodeError:
        return content.decode("latin-1"), lost


def byte_order(head: bytes) -> str | None:
    """``utf-16-le`` or ``utf-16-be`` of text that is UTF-16, by its mark, else by the order in which it has lines; None of other content."""
    for mark, order in ((b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be")):
        if head.startswith(mark):
            return order
    if b"\0" not in head:
        return None
    lines = [order for order in ("utf-16-le", "utf-16-be") if _has_lines(head[: len(head) // 2 * 2], order)]
    return lines[0] if len(lines) == 1 else None


def _has_lines(head: bytes, order: str) -> bool:
    """Whether bytes are text with lines in one order: no character of it is NUL, as in binary content, nor a half of a pair."""
    try:
        text = head.decode(order)
    except UnicodeDecodeError as error:
        text = head[: error.start].decode(order) if len(head) - error.start <= 2 else ""  # a pair that the end of the head cuts
    return "\0" not in text and ("\n" in text or "\r" in text)


def plain_name(name: str) -> str:
    """A header cell without unit and decoration: ``"Lin Vel X [m/s]"`` -> ``linvelx``."""
    return re.sub(r"[^a-z0-9]", "", re.sub(r"\(.*?\)|\[.*?\]", "", name).casefold())


def stated_unit(name: str) -> str | None:
    """What a header cell says in brackets: ``"Roll (deg)"`` -> ``deg``."""
    found = None if ELEMENT.search(name) else re.search(r"[\[(]\s*(.*?)\s*[\])]", name)
    return found.group(1) if found else None


def member(pattern: str, name: str) -> str | None:
    """What the ``*`` of ``pattern`` stands for in a header cell: ``*_PV`` and ``"HFP_PV [rpm]"`` -> ``HFP``."""
    plain = re.sub(r"\s+", "_", re.sub(r"\(.*?\)|\[.*?\]", "", name).strip().strip('"').strip())
    found = re.fullmatch(re.escape(pattern).replace(r"\*", "(.+)"), plain, re.IGNORECASE)
    return found.group(1) if found else None


def fits(pattern: str, name: str) -> bool:
    """Whether a header cell is the column that a profile means; an element of an array (``q[3]``) is meant to the letter."""
    if ELEMENT.search(pattern) and "*" not in pattern:
        return pattern == name
    return member(pattern, name) is not None if "*" in pattern else plain_name(pattern) == plain_name(name)


def cells(line: str, separator: str) -> list[str]:
    """The cells of one line."""
    if '"' in line:
        try:
            return [c.strip() for c in next(csv.reader([line], delimiter=separator))]
        except csv.Error:
            pass
    return [c.strip() for c in line.split(separator)]


def header_place(text: str, wanted: Sequence[str]) -> tuple[tuple[str, ...], int, str] | None:
    """Cells of the line that fits most of the ``wanted`` column patterns, its number from 0, and the separator; None where no line fits any."""
    lines = re.split(r"\r\n|\n|\r", text)
    place = _header(lines[:HEADER_WITHIN], wanted)
    return None if place is None else (tuple(cells(lines[place[0]], place[1])), *place)


def _header(lines: Sequence[str], wanted: Sequence[str]) -> tuple[int, str] | None:
    best, place = 0, None
    plain = {plain_name(w) for w in wanted if "*" not in w}
    patterns = [w for w in wanted if "*" in w]
    for at, line in enumerate(lines):
        for separator in SEPARATORS:
            if separator not in line and len(wanted) > 1:
                continue
            names = cells(line, separator)
            score = len(plain & {plain_name(n) for n in names if n.lower() != n.upper()})
            if score or not plain:
                score += sum(any(fits(w, n) for n in names) for w in patterns)
            if score > best:
                best, place = score, (at, separator)
    return place


def first_few(numbers: Sequence[int], what: str = "line", more: int = 0) -> str:
    """The first few of many line numbers: ``lines 7, 9, 12, ...``; of ``more`` lines where ``numbers`` are only the first of them."""
    count = max(more, len(numbers))
    return f"{what}{'s' if count > 1 else ''} {', '.join(str(n) for n in numbers[:5])}{', ...' if count > 5 else ''}"
