"""Tasks over the workers of a Dask cluster (`rovval run --scheduler tcp://host:8786`): same tasks, same outcomes.

Every worker must see logs, archive and reports under the same paths, and have this version of rovval. No more tasks are with the scheduler than
there are threads of workers, so that a task begins when it is submitted, and neither tasks nor results pile up there.
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
        waiting = list(reversed(tasks))
        while waiting or team.running:
            for _ in range(team.idle()):
                if waiting:
                    team.submit(work, waiting.pop())
            team.bell.wait(LOOK_S)
            team.bell.clear()
            yield from team.ended(died)
            yield from team.late(died, timeout_s)


@dataclass(slots=True)
class _Team:
    """The workers of a cluster and what they are at."""

    client: Any
    address: str
    running: dict[Any, tuple[Task, float]] = field(default_factory=dict)  # by future: the task, and when it was submitted
    alone_since: float | None = None
    bell: threading.Event = field(default_factory=threading.Event)  # rung when a task ends

    def idle(self) -> int:
        """Threads of workers that have nothing to do. Raises `UsageProblem` where the scheduler is lost, or has had no worker for too long: the batch
        would wait for ever without a word."""
        threads: int = sum(self._asked(self.client.nthreads).values())
        if threads:
            self.alone_since = None
            return max(0, threads - len(self.running))
        self.alone_since = self.alone_since or time.monotonic()
        if time.monotonic() - self.alone_since > PATIENCE_S:
            why = f"the Dask scheduler at {self.address} has had no worker for {PATIENCE_S:g} s"
            raise UsageProblem(why, f"start one with `dask worker {self.address}`")
        return 0

    def submit(self, work: Callable[[Task], Outcome], task: Task) -> None:
        """Hand a task to the scheduler."""
        future = self._asked(lambda: self.client.submit(work, task, pure=False))
        self.running[future] = (task, time.monotonic())
        future.add_done_callback(lambda _: self.bell.set())

    def ended(self, died: Callable[[Task, str], Outcome]) -> Iterator[tuple[Task, Outcome]]:
        """The tasks that have ended since, each with its outcome."""
        from distributed import KilledWorker

        for future in [future for future in self.running if future.done()]:
            task, _ = self.running.pop(future)
            try:
                yield task, future.result()
            except KilledWorker as error:
                yield task, died(task, f"worker process died: {error}")
            except CancelledError:
                raise self._lost() from None

    def late(self, died: Callable[[Task, str], Outcome], timeout_s: float | None) -> Iterator[tuple[Task, Outcome]]:
        """The tasks that took longer than ``timeout_s``, taken from their workers."""
        over = [future for future, (_, since) in self.running.items() if timeout_s is not None and time.monotonic() - since > timeout_s]
        for future in over:
            task, _ = self.running.pop(future)
            at_it = [worker for worker, keys in self._asked(self.client.processing).items() if future.key in keys]
            self._asked(future.cancel)
            self._start_anew(at_it)
            yield task, died(task, f"took longer than timeout_s = {timeout_s:g} s")

    def _start_anew(self, workers: list[str]) -> None:
        """End the process of each worker, as its thread cannot be ended; its nanny, or whoever started it without one, starts it again."""
        try:
            self.client.restart_workers(workers)
        except ValueError:  # without a nanny
            self.client.run(os._exit, 1, workers=workers, on_error="ignore")

    def _asked(self, question: Callable[[], Any]) -> Any:
        """The cluster's answer. Raises `UsageProblem` where the scheduler is lost."""
        if self.client.status != "running":
            raise self._lost()
        try:
            return question()
        except OSError:
            raise self._lost() from None

    def _lost(self) -> UsageProblem:
        return UsageProblem(f"the Dask scheduler at {self.address} was lost", "start it again with its workers; the next run goes on from here")
