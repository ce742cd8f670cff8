"""Kill -9 of a Dask worker and of the Dask scheduler at random moments: every result is there once, and equal to an undisturbed night's on one machine."""

from __future__ import annotations

import random
import subprocess
from collections.abc import Callable

import fault_case
import pytest

pytest.importorskip("distributed", reason="pip install 'rovval[cluster]'")

import dask_case

pytestmark = pytest.mark.slow

STEPS = '["ingest"]'
MOMENTS = 10
PARTS = range(5)


def worker_of(made: dask_case.Cluster) -> fault_case.Strike:
    """Kill -9 of a worker's process; its nanny starts another."""

    def strike(_night: subprocess.Popen[bytes], chance: random.Random) -> bool:
        found = [process for nanny in made.workers for process in fault_case.children(nanny.pid) if "spawn_main" in fault_case.command_line(process)]
        return bool(found) and fault_case.killed(chance.choice(found))

    return strike


def scheduler_of(made: dask_case.Cluster) -> fault_case.Strike:
    """Kill -9 of the scheduler, and of its workers, which cannot go on without it; then all of them are there anew, as a cluster's manager does it."""

    def strike(night: subprocess.Popen[bytes], _chance: random.Random) -> bool:
        assert made.scheduler
        dask_case.kill(made.scheduler)
        code = night.wait(fault_case.PATIENCE_S)
        assert code in (0, 2), f"{code}, not that the scheduler was lost, or all results: {night.stderr and night.stderr.read().decode()}"
        workers, made.workers[:] = list(made.workers), []
        for worker in workers:
            dask_case.kill(worker)
        made.start_scheduler()
        for _ in workers:
            made.start_worker()
        return True

    return strike


@pytest.mark.parametrize("kind", [worker_of, scheduler_of], ids=lambda kind: kind.__name__)
@pytest.mark.parametrize("seed", PARTS)
def test_killed_at_random_moments(tmp_path, logs, undisturbed, kind: Callable[[dask_case.Cluster], fault_case.Strike], seed):
    night = fault_case.Night(tmp_path / "night", logs, STEPS)
    with dask_case.cluster(2) as made:
        tally = fault_case.disturb(night, undisturbed(STEPS), kind(made), MOMENTS, seed, "--scheduler", made.address)
    print(f"\n{kind.__name__}: {tally.struck} kills, {tally.ended} nights came to their end, all equal")
    assert tally.struck == MOMENTS and tally.ended >= 1
