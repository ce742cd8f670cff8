"""Results on stdout, messages and progress on stderr."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from pathlib import Path

import typer

from rovval.core.progress import Progress, silent

BAR = 24  # characters of a bar of progress


def result(text: str) -> None:
    """What the user asked for, on stdout."""
    typer.echo(text)


def result_json(document: object) -> None:
    """The machine-readable result, alone on stdout."""
    typer.echo(json.dumps(document, indent=2, allow_nan=False))


def say(text: str, quiet: bool = False) -> None:
    """A message, on stderr."""
    if not quiet:
        typer.echo(text, err=True)


def progress(quiet: bool = False) -> Progress:
    """Shows a step and its share done (0 to 1) as a bar on one line of stderr, if that is a terminal; gone when it is done."""
    if quiet or not sys.stderr.isatty():
        return silent
    widest = 0

    def show(step: str, share: float) -> None:
        nonlocal widest
        done = round(BAR * min(max(share, 0.0), 1.0))
        line = f"{step}: [{'#' * done}{'.' * (BAR - done)}] {100 * share:.0f} %"
        widest = max(widest, len(line))
        sys.stderr.write("\r" + (line.ljust(widest) if share < 1 else " " * widest + "\r"))
        sys.stderr.flush()

    return show


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
