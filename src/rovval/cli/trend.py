"""`rovval trend`: how gaps and causes change over dives."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import complete, options, output


def command(
    archive: options.ArchiveOption = Path("archive"),
    vehicle: Annotated[
        str | None, typer.Option("--vehicle", metavar="V", autocompletion=complete.vehicles, help="Only this vehicle. Default: all.")
    ] = None,
    since: Annotated[datetime | None, typer.Option("--since", help="Only the dives since then (UTC).")] = None,
    json_: options.JsonFlag = False,
) -> None:
    """How the gap of each vehicle and the size of each cause change over the dives that `rovval run` has judged: when, by how much, how surely.

    A rise of the gap with drag is fouling, a thruster's gain that falls is wear. Of a hundred fleets in which nothing changes, one shows a change.

    \b
    Example:
      rovval trend
      rovval trend --archive /data/archive --vehicle merlin --since 2026-01-01
    """
    from rovval.report.common import trend as words
    from rovval.storage import catalogue
    from rovval.trend import trends

    found = trends(row for row in catalogue.find(archive, since=since) if vehicle in (None, row["vehicle"]))
    if json_:
        output.result_json(words.document(found))
    elif found:
        output.result(words.text(found))
    else:
        output.say(f"no such dive in the catalogue of {archive}, which `rovval run` keeps")
