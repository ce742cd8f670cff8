"""Results on stdout, messages and progress on stderr."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import typer

from rovval.core.progress import Progress, silent

BAR = 24  # characters of a bar of progress
TELLING_S = 2.0  # work that has gone on for less does not tell how long it takes (chosen)
PAUSE_S = 10.0  # between two lines of progress in a log file: an hour's batch is a few hundred lines at most (chosen)


def result(text: str) -> None:
    """What the user asked for, on stdout."""
    typer.echo(text)


def result_in_sections(text: str) -> None:
    """The same, with the lines bold that indented ones follow."""
    lines = text.split("\n")
    followed = [*(line.startswith("  ") for line in lines[1:]), False]
    bold = (styled(line, bold=True) if line and line[0] != " " and below else line for line, below in zip(lines, followed, strict=True))
    typer.echo("\n".join(bold))


def result_json(document: object) -> None:
    """The machine-readable result, alone on stdout."""
    typer.echo(json.dumps(document, indent=2, allow_nan=False))


def say(text: str, quiet: bool = False) -> None:
    """A message, on stderr."""
    if not quiet:
        typer.echo(text, err=True)


def progress(quiet: bool = False) -> Progress:
    """Shows a step and its share done (0 to 1) as a bar on one line of stderr, with the time that is left, if that is a terminal; gone when it is done."""
    if quiet or not sys.stderr.isatty():
        return silent
    widest, began = 0, time.monotonic()

    def show(step: str, share: float) -> None:
        nonlocal widest
        done = round(BAR * min(max(share, 0.0), 1.0))
        line = f"{step}: [{'#' * done}{'.' * (BAR - done)}] {100 * share:.0f} %{_left(time.monotonic() - began, share)}"
        widest = max(widest, len(line))
        sys.stderr.write("\r" + (line.ljust(widest) if share < 1 else " " * widest + "\r"))
        sys.stderr.flush()

    return show


def progress_of_many(quiet: bool = False) -> Progress:
    """The same for a long batch, which also goes on where nobody looks: then lines with the time of day, the first, the last and one every `PAUSE_S`."""
    if quiet or sys.stderr.isatty():
        return progress(quiet)
    last = -PAUSE_S

    def show(step: str, share: float) -> None:
        nonlocal last
        now = time.monotonic()
        if share >= 1 or now - last >= PAUSE_S:
            last = now
            typer.echo(f"{time.strftime('%H:%M:%S')}  {step}", err=True)

    return show


def _left(passed: float, share: float) -> str:
    """How long it will take at the pace so far; nothing before that can be told."""
    if passed < TELLING_S or not 0.0 < share < 1.0:
        return ""
    seconds = passed * (1.0 - share) / share
    return f", {seconds:.0f} s left" if seconds < 100 else f", {seconds / 60:.0f} min left"


def styled(text: str, err: bool = False, **style: Any) -> str:
    """Text in a colour or bold (as `typer.style` takes them) where a terminal shows it, and plain elsewhere or with NO_COLOR (no-color.org)."""
    stream = sys.stderr if err else sys.stdout
    plain = os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb" or not stream.isatty()
    return text if plain else typer.style(text, **style)


def places(files: Mapping[str, Path]) -> str:
    """Where the report lies and how to open it, one line a file."""
    how = {
        ".html": "open it in a browser",
        ".rrd": "open it with `rerun FILE` (comes with rovval)",
        ".md": "text",
        ".json": "for programs",
    }
    width = max((len(str(path)) for path in files.values()), default=0)
    return "\n".join(f"  {path!s:<{width}}  {how.get(path.suffix, '')}".rstrip() for path in files.values())
