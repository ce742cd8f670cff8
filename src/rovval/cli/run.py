"""`rovval run`: a batch over many logs."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rovval.cli import options, output


def command(
    pipeline: Annotated[
        Path, typer.Argument(metavar="PIPELINE.toml", help="Which logs, vehicle, profile, steps and tolerances.")
    ],
    workers: Annotated[
        int | None, typer.Option("--workers", metavar="N", min=1, help="Processes on this machine. Default: one a core.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option("--scheduler", metavar="ADDRESS", help="A Dask scheduler instead, such as tcp://host:8786.")
    ] = None,
    retry: Annotated[bool, typer.Option("--retry", help="Try quarantined logs again although they have not changed.")] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Only say what would be done.")] = False,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Take many logs through their steps: what is new or changed is done, the rest is skipped, a bad log is set aside.

    Exit codes: 0 all done, 1 a tolerance of the file is exceeded, 3 a log stands in quarantine (this one first), 2 the file is
    wrong or another run of it is at work.

    \b
    Example:
      rovval run pipelines/nightly.toml
      rovval run pipelines/nightly.toml --workers 8 --json
    """
    from rovval.pipeline import batch, config, summary

    if dry_run:
        planned = batch.dry_run(pipeline, retry)
        rows = (
            [("do", t.log) for t in planned.todo]
            + [("unchanged", r["log"]) for r in planned.done]
            + [("quarantined", r["log"]) for r in planned.set_aside]
        )
        rows += [("waiting", f"{log}: {why}") for log, why in planned.waiting]
        if json_:
            output.result_json({"schema": "rovval.plan/1", "logs": [{"state": state, "log": str(log)} for state, log in rows]})
        else:
            output.result("\n".join(f"{state:<12} {log}" for state, log in rows))
        return
    document = batch.run(pipeline, workers, scheduler, retry, output.progress(quiet))
    output.result_json(document) if json_ else output.result(summary.text(document))
    output.say(f"every run of it on one page: {config.load(pipeline).reports / batch.INDEX}", quiet)
    raise typer.Exit(document["exit_code"])
