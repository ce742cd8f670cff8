"""A table of text as it comes out of real exports: find its encoding, its header and its separator; keep the whole rows."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rovval.core.errors import BadInput, Finding
from rovval.ingest.compression import lost_of, opened

SEPARATORS = (",", ";", "\t", "|")
HEADER_WITHIN = 200  # lines of banner above the header that are looked through
ELEMENT = re.compile(r"\S\[\d+\]$")  # of an array; "throttle [1]" is a unit
HEAD = 65536  # bytes by which text is told from binary content


@dataclass(frozen=True, slots=True)
class Table:
    """``header`` as written, ``rows`` the data lines that hold as many cells as it, ``lines`` their numbers in the file from 1."""

    header: tuple[str, ...]
    separator: str
    rows: list[str]
    lines: list[int]
    findings: tuple[Finding, ...]


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
    if b"\0" in content[:HEAD]:
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


def split(text: str, wanted: Sequence[str]) -> Table | None:
    """The table below the line that fits most of the ``wanted`` column patterns; None where no line fits any."""
    lines = re.split(r"\r\n|\n|\r", text)
    place = _header(lines[:HEADER_WITHIN], wanted)
    if place is None:
        return None
    at, separator = place
    header = tuple(cells(lines[at], separator))
    width = len(header)
    rows: list[str] = []
    numbers: list[int] = []
    short: list[int] = []
    long: list[int] = []
    again: list[int] = []
    seen: set[str] = set()
    for number, line in enumerate(lines[at + 1 :], at + 2):
        if not line.strip() or line.startswith("#") or line == lines[at]:
            continue
        count = line.count(separator) + 1 if '"' not in line else len(cells(line, separator))
        if count > width and line.endswith(separator):
            line, count = line[: -(count - width)] if line.endswith(separator * (count - width)) else line, width
        if line in seen:
            again.append(number)
        elif count == width:
            seen.add(line)
            rows.append(line)
            numbers.append(number)
        else:
            (short if count < width else long).append(number)
    cut = [n for n in short if numbers and n > numbers[-1] and n == len(lines)]
    whole = [n for n in short if n not in cut] + long
    findings = [Finding("cut_line", f"line {cut[0]}", "the last line is cut; dropped")] if cut else []
    if again:
        detail = f"{len(again)} rows repeat an earlier one to the letter, stamp included; dropped"
        findings.append(Finding("repeated_row", first_few(again), detail))
    if whole:
        findings.append(Finding("ragged_row", first_few(whole), f"{len(whole)} rows have not the header's {width} cells; dropped"))
    return Table(header, separator, rows, numbers, tuple(findings))


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


def first_few(numbers: Sequence[int], what: str = "line") -> str:
    """The first few of many line numbers: ``lines 7, 9, 12, ...``."""
    shown = ", ".join(str(n) for n in numbers[:5])
    return f"{what}{'s' if len(numbers) > 1 else ''} {shown}{', ...' if len(numbers) > 5 else ''}"
