"""Tasks over the workers of a Dask cluster (`rovval run --scheduler tcp://host:8786`): same tasks, same outcomes.

Every worker must see logs, archive and reports under the same paths, and have this version of rovval. No more than `AHEAD` tasks are with the scheduler
for each thread of a worker: one that it is at, and the next, so that no thread waits for the batch, and neither tasks nor results pile up there. Dask gives
up every task that was with too many workers that died, whichever killed them: such a task is done again by itself when all others have ended.
"""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass, field
from typing import Any

from rovval.core.errors import UsageProblem
from rovval.pipeline.execution.worker import Outcome
from rovval.pipeline.planning.plan import Task

PATIENCE_S = 60.0  # workers of a cluster are started beside the scheduler, some seconds after it
AHEAD = 2  # tasks with the scheduler for each thread: a second one takes away the wait for the batch between two logs, more take nothing
LOOK_S = 0.5  # how often the cluster is looked at while nothing ends: a fraction of what the shortest log takes


def execute(
    tasks: Sequence[Task], work: Callable[[Task], Outcome], died: Callable[[Task, str], Outcome], address: str, timeout_s: float | None = None
) -> Iterator[tuple[Task, Outcome]]:
    """Yield each task with its outcome as it ends. ``died`` makes the outcome of a task whose workers died or were too slow: the worker process of
    one that took longer than ``timeout_s`` is started anew, and what else it was at is done again.

    Raises:
        UsageProblem: Dask is not installed, no scheduler answers at ``address`` or it is lost, or it has no worker for `PATIENCE_S`.
    """
    try:
        from distributed import Client
    except ImportError:
        raise UsageProblem("--scheduler needs Dask, which is not installed", "pip install 'rovval[cluster]'") from None
    try:
        client = Client(address, timeout="10s", set_as_default=False)  # type: ignore[no-untyped-call,unused-ignore]
    except (OSError, ValueError) as error:
        raise UsageProblem(
            f"no Dask scheduler answers at {address}: {error}", "start one with `dask scheduler`, workers with `dask worker`"
        ) from None
    with client:
        team = _Team(client, address)
        team.listen()
        waiting = list(reversed(tasks))
        while waiting or team.running or team.doubtful:
            for _ in range(team.wanted()):
                if waiting:
                    team.submit(work, waiting.pop())
            if team.doubtful and not (waiting or team.running):
                team.submit(work, team.doubtful.pop(), alone=True)
            team.bell.wait(LOOK_S)
            team.bell.clear()
            yield from team.ended(died)
            yield from team.late(died, timeout_s)


@dataclass(slots=True)
class _Team:
    """The workers of a cluster and what they are at."""

    client: Any
    address: str
    running: dict[Any, Task] = field(default_factory=dict)  # by future
    since: dict[str, float] = field(default_factory=dict)  # by the future's key: when a worker last began it
    doubtful: list[Task] = field(default_factory=list)  # they were with workers that died, and wait to be done alone
    alone: set[str] = field(default_factory=set)  # ids of those that were
    threads: int = 0  # of all workers, when last looked
    looked: float = -LOOK_S
    alone_since: float | None = None
    bell: threading.Event = field(default_factory=threading.Event)  # rung when a task ends

    @property
    def topic(self) -> str:
        """Under which workers tell of tasks of this batch that they begin."""
        return f"rovval began, for {self.client.id}"

    def listen(self) -> None:
        """Hear from now on which tasks the workers begin."""
        self._asked(lambda: self.client.subscribe_topic(self.topic, self.began))

    def began(self, event: tuple[float, str]) -> None:
        """A worker has begun the task of a key; again, where the worker before died."""
        self.since[event[1]] = time.monotonic()

    def wanted(self) -> int:
        """Tasks that the workers' threads still lack. Raises `UsageProblem` where the scheduler is lost, or has had no worker for too long: the batch
        would wait for ever without a word."""
        now = time.monotonic()
        if now - self.looked >= LOOK_S:
            self.threads, self.looked = sum(self._asked(self.client.nthreads).values()), now
        if self.threads:
            self.alone_since = None
            return max(0, AHEAD * self.threads - len(self.running))
        self.alone_since = self.alone_since or now
        if now - self.alone_since > PATIENCE_S:
            why = f"the Dask scheduler at {self.address} has had no worker for {PATIENCE_S:g} s"
            raise UsageProblem(why, f"start one with `dask worker {self.address}`")
        return 0

    def submit(self, work: Callable[[Task], Outcome], task: Task, alone: bool = False) -> None:
        """Hand a task to the scheduler; ``alone`` if there is no other."""
        if alone:
            self.alone.add(task.id)
        future = self._asked(lambda: self.client.submit(_told, work, task, self.topic, pure=False))
        self.running[future] = task
        future.add_done_callback(lambda _: self.bell.set())

    def ended(self, died: Callable[[Task, str], Outcome]) -> Iterator[tuple[Task, Outcome]]:
        """The tasks that have ended since, each with its outcome; those whose workers died are `doubtful` first."""
        from distributed import KilledWorker

        for future in [future for future in self.running if future.done()]:
            task = self._taken(future)
            try:
                yield task, future.result()
            except KilledWorker as error:
                if task.id in self.alone:
                    yield task, died(task, f"worker process died: {error}")
                else:
                    self.doubtful.append(task)
            except CancelledError:
                raise self._lost() from None

    def late(self, died: Callable[[Task, str], Outcome], timeout_s: float | None) -> Iterator[tuple[Task, Outcome]]:
        """The tasks that took longer than ``timeout_s``, taken from their workers."""
        now = time.monotonic()
        over = [future for future in self.running if timeout_s is not None and now - self.since.get(future.key, now) > timeout_s]
        for future in over:
            task = self._taken(future)
            at_it = [worker for worker, keys in self._asked(self.client.processing).items() if future.key in keys]
            self._asked(future.cancel)
            self._start_anew(at_it)
            yield task, died(task, f"took longer than timeout_s = {timeout_s:g} s")

    def _taken(self, future: Any) -> Task:
        """The task of a future, which is forgotten."""
        self.since.pop(future.key, None)
        return self.running.pop(future)

    def _start_anew(self, workers: list[str]) -> None:
        """End the process of each worker, as its thread cannot be ended; its nanny, or whoever started it without one, starts it again."""
        try:
            self.client.restart_workers(workers)
        except ValueError:  # without a nanny
            self.client.run(os._exit, 1, workers=workers, on_error="ignore")

    def _asked(self, question: Callable[[], Any]) -> Any:
        """The cluster's answer. Raises `UsageProblem` where the scheduler is lost."""
        from distributed.client import ClosedClientError

        if self.client.status != "running":
            raise self._lost()
        try:
            return question()
        except (OSError, ClosedClientError, CancelledError):  # the latter two where it was lost this moment
            raise self._lost() from None

    def _lost(self) -> UsageProblem:
        return UsageProblem(f"the Dask scheduler at {self.address} was lost", "start it again with its workers; the next run goes on from here")


def _told(work: Callable[[Task], Outcome], task: Task, topic: str) -> Outcome:
    """Do a task on a worker, which tells the batch that it begins: what waits behind another log is not slow."""
    from distributed import get_worker

    worker = get_worker()  # type: ignore[no-untyped-call,unused-ignore]
    worker.log_event(topic, worker.get_current_task())
    return work(task)
