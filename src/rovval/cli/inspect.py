"""`rovval inspect`: what is in a log, and which profiles would read it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rovval.cli import complete, options, output

if TYPE_CHECKING:
    from rovval.ingest.inspection.inspect import Inspection

LogFile = Annotated[Path, typer.Argument(metavar="FILE", help="A log file, or a bag's folder.", autocompletion=complete.sources)]


def command(
    file: LogFile,
    fields: Annotated[bool, typer.Option("--fields/--topics", help="Every field with its range, or the topics alone.")] = True,
    json_: options.JsonFlag = False,
) -> None:
    """Show what a log holds, before any profile: topics or columns, types, rates, spans, gaps, ranges, clocks; and which channels each built-in
    profile of its format would find.

    \b
    Example:
      rovval inspect dive.bag --topics
      rovval inspect dive.csv --json
    """
    from rovval.report import inspection

    found = looked_at(file)
    output.result_json(inspection.document(found)) if json_ else output.result(inspection.page(found, fields))


def looked_at(file: Path) -> Inspection:
    """What is in a log, with a bar while it is read."""
    from rovval.ingest.inspection.inspect import inspect

    show = output.progress()
    try:
        return inspect(file, show)
    finally:
        show("", 1.0)
