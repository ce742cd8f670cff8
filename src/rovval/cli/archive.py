"""`rovval archive`: whether what is kept is whole and true, and what to do about what is not."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import options, output
from rovval.storage.places import place


class Action(StrEnum):
    """What to do with an archive."""

    check = "check"
    repair = "repair"


def command(
    action: Annotated[Action, typer.Argument(help="check: read every byte against its digest. repair: and mend what is damaged.")],
    archive: options.ArchiveOption = Path("archive"),
    reports: Annotated[Path | None, typer.Option("--reports", metavar="DIR", parser=place, help="Reports of a batch, to be looked at as well.")] = None,
    json_: options.JsonFlag = False,
) -> None:
    """Look at every run, the catalogue and, with --reports, every result of a batch: is it there, and as it was written.

    repair makes a damaged run anew where its log is still the same; everything else is moved to .damaged, and the next `rovval run` makes it anew.
    Exit codes: 0 everything is whole (or was mended), 3 something is not, 2 a folder cannot be read or written.

    \b
    Example:
      rovval archive check --archive /data/archive --reports /data/reports/nightly
      rovval archive repair --archive /data/archive
    """
    from rovval.core.errors import UsageProblem
    from rovval.pipeline.keeping import integrity

    if missing := [str(folder) for folder in (archive, reports) if folder and not folder.is_dir()]:
        raise UsageProblem(f"{' and '.join(missing)}: no such folder", "name the archive with --archive, the reports with --reports")
    faults = integrity.check(archive, reports)
    repairs = integrity.repair(faults) if action is Action.repair else []
    rows = [{"place": str(f.place), "fault": f.what} for f in faults]
    for row, done in zip(rows, repairs, strict=False):
        row["repair"] = done.done
    if json_:
        output.result_json({"schema": "rovval.integrity/1", "faults": rows})
    else:
        output.result("\n".join(": ".join(row.values()) for row in rows) or "everything is whole")
    raise typer.Exit(3 if len(faults) > sum(r.mended for r in repairs) else 0)
