"""Tasks over worker processes of this machine. A worker that dies takes only its own task with it, and is replaced.

Workers come from a fork server: forking a process in which polars has threads deadlocks.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any

from rovval.core.environment import environment
from rovval.pipeline.execution.worker import Outcome
from rovval.pipeline.planning.plan import Task

Work = Callable[[Task], Outcome]
# Of a worker each is 1 unless the user says otherwise. It has to find them when it starts: later numpy has a thread for every core of the machine.
THREADS = ("POLARS_MAX_THREADS", "NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@dataclass(slots=True)
class _Worker:
    process: BaseProcess
    pipe: Connection
    task: Task | None = None
    since: float = field(default_factory=time.monotonic)


def execute(
    tasks: Sequence[Task], work: Work, died: Callable[[Task, str], Outcome], workers: int, timeout_s: float | None = None
) -> Iterator[tuple[Task, Outcome]]:
    """Yield each task with its outcome as it ends. ``died`` makes the outcome of a task whose worker died or was too slow."""
    context = multiprocessing.get_context("forkserver")
    waiting = list(reversed(tasks))
    team = [_hire(context, work) for _ in range(min(workers, len(tasks)))]
    try:
        while True:
            for worker in team:
                if worker.task is None and waiting:
                    _give(worker, waiting.pop())
            if not (busy := [w for w in team if w.task is not None]):
                return
            wait([w.pipe for w in busy] + [w.process.sentinel for w in busy], timeout=_patience(busy, timeout_s))
            for worker in busy:
                task = worker.task
                assert task is not None
                if (outcome := _heard(worker)) is None:
                    if (why := _ended(worker, timeout_s)) is None:
                        continue
                    team[team.index(worker)] = _hire(context, work)
                    outcome = died(task, why)
                worker.task = None
                yield task, outcome
    finally:
        for worker in team:
            worker.pipe.close()
            worker.process.terminate()
        for worker in team:
            worker.process.join()


def _hire(context: Any, work: Work) -> _Worker:
    mine, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, work), daemon=True)
    with environment({name: "1" for name in THREADS if name not in os.environ}):
        process.start()
    theirs.close()
    return _Worker(process, mine)


def _serve(pipe: Connection, work: Work) -> None:
    """The worker's life: a task in, its outcome out, until the other end is closed or gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_leave_with_parent, daemon=True).start()
    while True:
        try:
            task = pipe.recv()
        except EOFError:
            return
        pipe.send(work(task))


def _leave_with_parent() -> None:
    """End this worker when the batch that hired it is gone, also in the middle of a log: the next batch may be at work on it already."""
    if parent := multiprocessing.parent_process():
        wait([parent.sentinel])
        os._exit(1)


def _give(worker: _Worker, task: Task) -> None:
    worker.task, worker.since = task, time.monotonic()
    try:
        worker.pipe.send(task)
    except BrokenPipeError:
        worker.process.join()  # it died idle: the sentinel tells, and the task is reported with it


def _heard(worker: _Worker) -> Outcome | None:
    try:
        if worker.pipe.poll():
            outcome: Outcome = worker.pipe.recv()
            return outcome
    except (EOFError, OSError):
        worker.process.join()
    return None


def _ended(worker: _Worker, timeout_s: float | None) -> str | None:
    """Why the worker will not answer, or None if it still may."""
    if not worker.process.is_alive():
        code = worker.process.exitcode or 0
        return f"worker process died ({signal.Signals(-code).name})" if code < 0 else f"worker process left with code {code}"
    if timeout_s is not None and time.monotonic() - worker.since > timeout_s:
        worker.process.kill()
        worker.process.join()
        return f"took longer than timeout_s = {timeout_s:g} s"
    return None


def _patience(busy: Sequence[_Worker], timeout_s: float | None) -> float | None:
    if timeout_s is None:
        return None
    return max(0.0, min(w.since for w in busy) + timeout_s - time.monotonic() + 0.01)
