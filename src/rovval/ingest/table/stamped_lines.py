"""Logs of text lines that a device sent and a logger wrote down, perhaps each behind the logger's own stamp."""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path

from rovval.core.errors import Finding
from rovval.core.progress import Progress, silent
from rovval.ingest.files.compression import lost_of, opened, share_read

TOLD_EVERY = 5_000  # lines between two words on how far it is
LEAST_EPOCH_S, MOST_EPOCH_S = 1e9, 1e11  # numbers between are seconds since 1970 (2001 to the year 5138); milliseconds are beyond


def lines_of(path: Path, begin: str, findings: list[Finding], progress: Progress = silent) -> Iterator[tuple[float, str]]:
    """Lines that hold what begins with one of the characters ``begin``: the logger's stamp before it (s since 1970, UTC where it says no
    zone; NaN without one), and the rest. A compressed file is unpacked; what is lost of it is a finding."""
    with opened(path) as file:
        for number, raw in enumerate(file):
            if number % TOLD_EVERY == 0:
                progress("reading lines", share_read(file, path))
            line, cut = raw.decode("utf-8", errors="replace").strip(), not raw.endswith(b"\n")
            at = next((i for i, sign in enumerate(line) if sign in begin), None)
            if at is not None:
                yield stamp_of(line[:at]), line[at:]
            elif cut and line:
                findings.append(Finding("cut_line", path.name, "the last line is cut; left out"))
        findings += lost_of(file, path)


def stamp_of(text: str) -> float:
    """A stamp written as ISO 8601 or as seconds since 1970, in s; NaN of any other text."""
    plain = text.strip(" \t,;:|[]()\"'")
    if re.fullmatch(r"\d+(\.\d+)?", plain):
        return float(plain) if LEAST_EPOCH_S < float(plain) < MOST_EPOCH_S else float("nan")
    try:
        found = datetime.fromisoformat(plain.replace(",", "."))
    except ValueError:
        return float("nan")
    return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()
