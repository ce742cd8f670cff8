"""Tasks over the workers of a Dask cluster (`rovval run --scheduler tcp://host:8786`): same tasks, same outcomes.

Every worker must see logs, archive and reports under the same paths, and have this version of rovval.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from rovval.core.errors import UsageProblem
from rovval.pipeline.plan import Task
from rovval.pipeline.worker import Outcome


def execute(
    tasks: Sequence[Task], work: Callable[[Task], Outcome], died: Callable[[Task, str], Outcome], address: str
) -> Iterator[tuple[Task, Outcome]]:
    """Yield each task with its outcome as it ends.

    Raises:
        UsageProblem: Dask is not installed, or no scheduler answers at ``address``.
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
        futures = {client.submit(work, task, pure=False): task for task in tasks}
        for future in as_completed(futures, loop=client.loop):
            task = futures[future]
            try:
                yield task, future.result()
            except KilledWorker as error:
                yield task, died(task, f"worker process died: {error}")
