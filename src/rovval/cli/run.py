"""`rovval run`: a batch over many logs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rovval.cli import options, output

if TYPE_CHECKING:
    from rovval.pipeline.planning.plan import Plan


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
    verify: Annotated[
        bool, typer.Option("--verify", help="Read every log and every result anew: trust no size and no time of change.")
    ] = False,
    dry_run: Annotated[bool, typer.Option("--dry-run", "--list", help="Only say what would be done; with the id of each task.")] = False,
    only: Annotated[
        str | None, typer.Option("--only", metavar="ID", help="Do this one task of --list, for a scheduler of your own; a run without it closes.")
    ] = None,
    json_: options.JsonFlag = False,
    quiet: options.QuietOption = False,
) -> None:
    """Take many logs through their steps: what is new or changed is done, the rest is skipped, a bad log is set aside.

    Exit codes: 0 all done, 1 a tolerance of the file is exceeded, 4 a simulation left sane limits, 3 a log stands in quarantine or a source
    has no log at all (of several, the last of these), 2 the file is wrong, the disk is full, or another run of it is at work.

    --list and --only are for schedulers that start each log themselves (Airflow, Prefect, Snakemake): every task of --list --json by --only, any
    number at once, and then one run as ever, which finds them done and writes catalogue, summary and page.

    \b
    Example:
      rovval run pipelines/nightly.toml
      rovval run pipelines/nightly.toml --workers 8 --json
    """
    from rovval.pipeline import batch
    from rovval.pipeline.planning import config
    from rovval.report.batch.terminal import text

    if only is not None:
        raise typer.Exit(_do_one(pipeline, only, retry, json_, quiet))
    if dry_run:
        _say_plan(batch.dry_run(pipeline, retry, verify), json_)
        return
    document = batch.run(pipeline, workers, scheduler, retry, output.progress_of_many(quiet), verify)
    output.result_json(document) if json_ else output.result(text(document))
    output.say(f"every run of it on one page: {config.load(pipeline).reports / batch.INDEX}", quiet)
    raise typer.Exit(document["exit_code"])


def _say_plan(planned: Plan, as_json: bool) -> None:
    """What a run would do with each log, and why."""
    from rovval.pipeline.planning.plan import why

    ids = {str(t.log): t.id for t in planned.todo}
    rows = [("do", str(t.log), why(t)) for t in planned.todo]
    rows += [("unchanged", r["log"], "") for r in planned.done]
    rows += [("later", r["log"], "judged by other code of rovval, after the newest (most_redone)") for r in planned.postponed]
    rows += [("quarantined", r["log"], r["reason"].removeprefix(f"{r['log']}: ")) for r in planned.set_aside]
    rows += [("no log", logs, reason) for logs, reason in planned.missing]
    rows += [("waiting", str(log), reason) for log, reason in planned.waiting]
    if as_json:
        output.result_json({"schema": "rovval.plan/1", "logs": [_planned(row, ids) for row in rows]})
    else:
        output.result("\n".join(f"{state:<12} {log}{reason and ': '}{reason}" for state, log, reason in rows))


def _planned(row: tuple[str, str, str], ids: Mapping[str, str]) -> dict[str, str]:
    """One log of the plan; one that is to be done has an id for --only."""
    named = dict(zip(("state", "log", "why"), row, strict=True))
    return named | ({"id": ids[row[1]]} if row[0] == "do" else {})


def _do_one(pipeline: Path, identity: str, retry: bool, as_json: bool, quiet: bool) -> int:
    """Do one task; its exit code: 0 done or nothing to do, else that of what set it aside."""
    from rovval.pipeline import batch

    outcome = batch.run_only(pipeline, identity, retry)
    if outcome is None:
        output.say(f"{identity}: nothing to do; `rovval run {pipeline} --list` has what there is", quiet)
        return 0
    record = outcome["record"]
    if as_json:
        output.result_json({"schema": "rovval.task/1", "id": identity, "status": outcome["status"], "record": record})
    elif outcome["status"] == "done":
        output.result(f"done  {record['log']}  {record['run']}")
    else:
        output.say(f"rovval: {record['reason']}\n  next: {record['next']}")
    return 0 if outcome["status"] == "done" else int(record.get("exit_code", 2))
