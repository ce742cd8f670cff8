"""`rovval ingest`: logs into the archive."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from rovval.cli import complete, logs, options, output
from rovval.core.errors import RovvalError
from rovval.core.progress import Progress


def command(
    sources: Annotated[
        list[str],
        typer.Argument(
            metavar="SOURCE...", help="Log files, bag folders, or folders of logs.", autocompletion=complete.sources
        ),
    ],
    profile: options.ProfileOption = None,
    timezone: options.TimezoneOption = None,
    start: options.FromOption = None,
    end: options.ToOption = None,
    archive: options.ArchiveOption = Path("archive"),
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Read logs, bring them to 10 Hz, and keep them as runs in the archive; prints the runs' ids.

    A log that cannot be used is named with its reason, the others go on, and the exit code is then 3. With --from and --to the same stretch
    of each log is kept, as a run of its own; a stretch that lasts stands in the dive file (docs/formats.md).

    \b
    Example:
      rovval ingest dive.csv --profile merlin
      rovval ingest bags/ --archive /data/archive
      rovval ingest dive.toml --from 60 --to 660
    """
    from rovval.alignment.stretch import stretch_of
    from rovval.pipeline.planning.discover import logs_in
    from rovval.storage.archive import open_run, save_run

    show = output.progress(quiet)
    files = logs_in(sources)
    rows: list[dict[str, Any]] = []
    worst = 0
    for number, log in enumerate(files):
        begun = number / len(files)
        show(f"ingest {log.name}", begun)
        try:
            run = stretch_of(open_run(str(log), profile, archive, timezone, _of(show, log.name, begun, 1 / len(files))), start, end)
            save_run(run, archive)
        except RovvalError as error:
            worst = max(worst, error.exit_code)
            output.say(f"rovval: {error}")
            rows.append({"log": str(log), "run": None, "problem": error.message})
            continue
        findings = [str(f) for f in run.findings]
        rows.append(
            {
                "log": str(log),
                "run": run.id,
                "profile": run.profile,
                "vehicle": run.vehicle,
                "seconds": run.duration_s,
                "findings": findings,
            }
        )
        if not json_:
            output.result(run.id)
        logs.print_findings(run, quiet)
    show("ingest", 1.0)
    if json_:
        output.result_json({"schema": "rovval.ingest/1", "archive": str(archive), "logs": rows})
    if worst:
        raise typer.Exit(worst)


def _of(show: Progress, log: str, begun: float, part: float) -> Progress:
    """The progress of one log as a part of all."""
    return lambda step, share: show(f"ingest {log}, {step}", begun + part * share)
