"""A whole batch: lock, sweep, plan, execute, sum up. A kill at any point loses nothing that was finished."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from rovval.core.errors import UsageProblem
from rovval.pipeline import cluster, config, lock, summary
from rovval.pipeline.plan import Plan, Task, plan
from rovval.pipeline.processes import execute
from rovval.pipeline.worker import Outcome, set_aside, work
from rovval.report.batch.terminal import reasons
from rovval.storage.atomic import json_text, sweep

SUMMARY, INDEX = "summary.json", "index.html"


def run(
    path: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    retry: bool = False,
    progress: Callable[[str, float], None] = lambda step, share: None,
) -> dict[str, Any]:
    """Run the pipeline of a file; returns the summary, which also stands as summary.json among the reports, and as a page, index.html.

    Raises `UsageProblem` for a wrong file, where archive or reports cannot be written, and where a worker runs other code: what was
    done stays done.
    """
    if workers is not None and scheduler:
        raise UsageProblem("--workers and --scheduler are two ways to run", "give one of them")
    pipeline = config.load(path)
    began = time.monotonic()
    with lock.held(pipeline.reports):
        sweep(pipeline.reports)
        progress("plan", 0.0)
        todo = plan(pipeline, path.resolve().parent, retry)
        why = todo.why  # before the work changes it
        progress(reasons(why) or "plan", 0.0)
        finished: list[Mapping[str, Any]] = []
        aside = list(todo.set_aside)
        count = len(todo.todo)
        spread = (
            cluster.execute(todo.todo, work, died, scheduler)
            if scheduler
            else execute(todo.todo, work, died, workers or pipeline.workers or os.cpu_count() or 1, pipeline.timeout_s)
        )
        for number, (task, outcome) in enumerate(spread, 1):
            if outcome["status"] == "stopped":
                raise UsageProblem(outcome["record"]["reason"], f"{outcome['record']['next']}; the next run goes on from here")
            (finished if outcome["status"] == "done" else aside).append(outcome["record"])
            progress(f"{number} of {count} logs, {task.log.name}", number / count)
        document = summary.summarise(
            pipeline.name, finished, todo.done, aside, todo.waiting, pipeline.tolerances, time.monotonic() - began, why
        )
        _publish(pipeline.reports, document, [*finished, *todo.done])
    return document


def _publish(reports: Path, summary: dict[str, Any], records: list[Mapping[str, Any]]) -> None:
    """The summary for programs and for people: both of this batch, or both of the one before."""
    from rovval.report.batch import html as batch_html
    from rovval.report.common.files import write_all

    write_all(reports, {SUMMARY: json_text(summary), INDEX: batch_html.text(summary, records)})


def dry_run(path: Path, retry: bool = False) -> Plan:
    """What a run would do, without doing it."""
    pipeline = config.load(path)
    return plan(pipeline, path.resolve().parent, retry)


def died(task: Task, why: str) -> Outcome:
    """A task whose worker did not survive it."""
    return set_aside(
        task, "crash", why, 70, hint="it is tried again by the next run; look at the log's size and the memory there is"
    )
