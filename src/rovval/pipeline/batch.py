"""A whole batch: lock, sweep, plan, execute, sum up. A kill at any point loses nothing that was finished."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from datetime import UTC, datetime
from itertools import chain
from pathlib import Path
from typing import Any

from rovval.core.errors import Unwritable, UsageProblem
from rovval.pipeline.execution import cluster
from rovval.pipeline.execution.processes import execute
from rovval.pipeline.execution.worker import Outcome, set_aside, work
from rovval.pipeline.keeping import catalogue, retention, summary
from rovval.pipeline.keeping.summary import STOPPED
from rovval.pipeline.keeping.trends import trends
from rovval.pipeline.planning import config
from rovval.pipeline.planning.config import Pipeline
from rovval.pipeline.planning.packed import Packed
from rovval.pipeline.planning.plan import Plan, Task, finished, plan
from rovval.pipeline.planning.records import brief
from rovval.report.batch.terminal import reasons
from rovval.storage import archive, lock
from rovval.storage.atomic import json_text, read_json, sweep, write_over
from rovval.storage.places import reached

SUMMARY, INDEX = "summary.json", "index.html"


def run(
    path: Path,
    workers: int | None = None,
    scheduler: str | None = None,
    retry: bool = False,
    progress: Callable[[str, float], None] = lambda step, share: None,
    verify: bool = False,
) -> dict[str, Any]:
    """Run the pipeline of a file; returns the summary, which also stands as summary.json among the reports, and as a page, index.html.

    ``retry`` and ``verify`` as in `plan`. Raises `UsageProblem` for a wrong file, where archive or reports cannot be written, and where
    workers cannot be had or run other code: what was done stays done, and the page says what stopped the rest.
    """
    if workers is not None and scheduler:
        raise UsageProblem("--workers and --scheduler are two ways to run", "give one of them")
    pipeline = config.load(path)
    began = time.monotonic()
    with reached(), lock.held(pipeline.reports) as still_ours:
        _tidy(pipeline)
        progress("plan", 0.0)
        todo = plan(pipeline, path.resolve().parent, retry, verify)
        why = todo.why  # before the work changes it
        progress(reasons(why) or "plan", 0.0)
        for settled in todo.settled:
            with suppress(OSError):
                settled.unlink()
        done = Packed()
        aside = list(todo.set_aside)
        stop: UsageProblem | None = None
        try:
            for number, (task, outcome) in enumerate(_spread(pipeline, todo.todo, workers, scheduler), 1):
                still_ours()
                if outcome["status"] == "stopped":
                    raise UsageProblem(outcome["record"]["reason"], f"{outcome['record']['next']}; the next run goes on from here")
                done.append(brief(outcome["record"], pipeline.tolerances)) if outcome["status"] == "done" else aside.append(outcome["record"])
                progress(f"{number} of {len(todo.todo)} logs, {task.log.name}", number / len(todo.todo))
        except UsageProblem as problem:
            stop = problem
        if todo.todo and not stop:  # else a worker may be at work still, whose scheduler was lost
            _tidy(pipeline)  # one that died may have left something, and another may have done its log since
        records = Packed(chain(done, todo.done, todo.kept, todo.postponed))
        damaged, unusual, unwritten = _entered(pipeline, records, done)
        before = read_json(pipeline.reports / SUMMARY)
        stop, seconds = stop or unwritten, time.monotonic() - began
        document = summary.summarise(
            pipeline.name, done, todo.done, aside, todo.waiting, pipeline.tolerances, seconds, why, todo.missing, stop, unusual, damaged
        )
        document["counts"]["postponed"] = len(todo.postponed)
        document["removed"] = [] if stop else retention.sweep(pipeline, todo.folders)
        document["night_before"] = summary.night_before(before)
        _publish(pipeline, document, records)
    if stop:
        raise stop
    return document


def _tidy(pipeline: Pipeline) -> None:
    """Remove what a kill left half-written; hold the lock of the reports."""
    sweep(pipeline.reports)
    archive.sweep(pipeline.archive)


def _spread(pipeline: Pipeline, tasks: Sequence[Task], workers: int | None, scheduler: str | None) -> Iterator[tuple[Task, Outcome]]:
    """Each task with its outcome as it ends, done by workers of this machine or of a cluster."""
    if scheduler:
        return cluster.execute(tasks, work, died, scheduler, pipeline.timeout_s)
    return execute(tasks, work, died, workers or pipeline.workers or os.cpu_count() or 1, pipeline.timeout_s)


def _entered(pipeline: Pipeline, records: Packed, done: Packed) -> tuple[list[str], list[dict[str, str]], UsageProblem | None]:
    """Put the records into the catalogue: what of it was damaged, which of the runs ``done`` are unusual among their vehicle's dives, and why it
    could not be written."""
    try:
        return catalogue.enter(pipeline, records, datetime.now(UTC)), catalogue.unusual(pipeline, done), None
    except UsageProblem as problem:
        return [], [], problem


def _publish(pipeline: Pipeline, summary: dict[str, Any], records: Packed) -> None:
    """The summary for programs and for people: both of this batch, or both of the one before. Where the disk is too full for them, what
    stopped the batch takes the place of the page of the night before, which would look like this night's."""
    from rovval.report.batch import html as batch_html
    from rovval.report.common.files import write_all

    reports = pipeline.reports
    try:
        write_all(reports, {SUMMARY: json_text(summary), INDEX: batch_html.pieces(summary, records, trends(pipeline))})
    except Unwritable as error:
        stopped = {**summary, "exit_code": STOPPED, "stopped_by": {"reason": error.message, "next": error.hint}}
        short = {key: [] if isinstance(value, list) else value for key, value in stopped.items()}
        for name, text in ((INDEX, batch_html.text(short, ())), (SUMMARY, json_text(short))):
            with suppress(OSError):
                write_over(reports / name, text)
        raise


def dry_run(path: Path, retry: bool = False, verify: bool = False) -> Plan:
    """What a run would do, without doing it."""
    pipeline = config.load(path)
    with reached():
        return plan(pipeline, path.resolve().parent, retry, verify)


def run_only(path: Path, identity: str, retry: bool = False) -> Outcome | None:
    """Do the one task of a pipeline's plan that has this id (see `dry_run`), beside others of the same pipeline: an outer scheduler spreads them.
    Records and quarantine are the batch's; catalogue, summary and page are made by the `run` that closes the night.

    Returns its outcome; None where nothing is to be done. Raises `UsageProblem` where a `run` of the pipeline is at work, or this task.
    """
    pipeline = config.load(path)
    with reached(), lock.held(pipeline.reports, shared=True):
        todo = plan(pipeline, path.resolve().parent, retry)
        task = next((task for task in todo.todo if task.id == identity), None)
        if task is None:
            return None
        with lock.held(pipeline.reports / ".locks" / identity):
            [(_, outcome)] = execute([task], work, died, 1, pipeline.timeout_s)
    return outcome


def died(task: Task, why: str) -> Outcome:
    """A task whose worker did not survive it: done, where the worker had come to its end and could not say so any more; else set aside."""
    if record := finished(task, digests=True):
        task.quarantine.unlink(missing_ok=True)
        return {"status": "done", "record": dict(record)}
    return set_aside(
        task, "crash", why, 70, hint="it is tried again by the next run; look at the log's size and the memory there is"
    )
