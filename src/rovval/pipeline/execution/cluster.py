"""Tasks over the workers of a Dask cluster (`rovval run --scheduler tcp://host:8786`): same tasks, same outcomes.

Every worker must see logs, archive and reports under the same paths, and have this version of rovval.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from rovval.core.errors import UsageProblem
from rovval.pipeline.execution.worker import Outcome
from rovval.pipeline.planning.plan import Task

PATIENCE_S = 60.0  # workers of a cluster are started beside the scheduler, some seconds after it


def execute(
    tasks: Sequence[Task], work: Callable[[Task], Outcome], died: Callable[[Task, str], Outcome], address: str
) -> Iterator[tuple[Task, Outcome]]:
    """Yield each task with its outcome as it ends.

    Raises:
        UsageProblem: Dask is not installed, or no scheduler answers at ``address``, or no worker joins it.
    """
    try:
        from distributed import Client, KilledWorker, as_completed
    except ImportError:
        raise UsageProblem("--scheduler needs Dask, which is not installed", "pip install 'rovval[cluster]'") from None
    try:
        client = Client(address, timeout="10s", set_as_default=False)
    except (OSError, ValueError) as error:
        raise UsageProblem(
            f"no Dask scheduler answers at {address}: {error}", "start one with `dask scheduler`, workers with `dask worker`"
        ) from None
    with client:
        if tasks:
            _await_a_worker(client, address)
        futures = {client.submit(work, task, pure=False): task for task in tasks}
        for future in as_completed(futures, loop=client.loop):
            task = futures[future]
            try:
                yield task, future.result()
            except KilledWorker as error:
                yield task, died(task, f"worker process died: {error}")


def _await_a_worker(client: Any, address: str) -> None:
    """Raises `UsageProblem` where no worker joins within `PATIENCE_S`: the batch would wait for ever without a word."""
    try:
        client.wait_for_workers(1, timeout=PATIENCE_S)
    except TimeoutError:
        raise UsageProblem(
            f"the Dask scheduler at {address} has had no worker for {PATIENCE_S:g} s", f"start one with `dask worker {address}`"
        ) from None
