"""What a batch costs, as ratios in one run.   pytest -m benchmark -s tests/benchmarks/bench_batch.py

ROVVAL_BENCH_LOGS sets the number of logs (10 000; some 25 minutes of one core). Costs are CPU time, which others on the machine change little; speed-ups
are wall time and want a machine of their own.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import batch_case
import fault_case
import pytest

from rovval.pipeline import batch
from rovval.pipeline.execution.worker import Outcome
from rovval.pipeline.planning.plan import Task

pytestmark = pytest.mark.benchmark

FEW, MANY = 10, int(os.environ.get("ROVVAL_BENCH_LOGS", "10000"))
SIDE_BY_SIDE = 300  # logs of the comparisons of workers and Dask: the start of a worker, some 4 s, must not decide them
SECONDS = 10.0  # of a log: one window of a comparison
STEPS = '["ingest", "simulate", "compare"]'
WITHIN, AGAIN_S_PER_1000, TWO_WORKERS, DASK_WITHIN, MEMORY_MB_PER_1000 = 0.10, 1.0, 1.8, 0.15, 10.0  # what the batch is held to
PEAK = "import re, sys; from rovval.pipeline import batch; from pathlib import Path; batch.run(Path(sys.argv[1]), workers=1)\n"
PEAK += "print(re.search(r'VmHWM:\\s+(\\d+) kB', open('/proc/self/status').read())[1])"


@pytest.fixture
def in_this_process(monkeypatch):
    """Tasks are done in this process, whose CPU time is then that of parent and worker together."""

    def execute(tasks: Sequence[Task], work: Callable[[Task], Outcome], *_: Any) -> Iterator[tuple[Task, Outcome]]:
        return ((task, work(task)) for task in tasks)

    monkeypatch.setattr(batch, "execute", execute)


def site(folder: Path, logs: int, first: int = 0) -> Path:
    for seed in range(first, first + logs):
        batch_case.write_log(folder / "logs" / f"{seed:06}.csv", seconds=SECONDS, seed=seed)
    return batch_case.write_pipeline(folder, steps=STEPS)


def cost(path: Path, how: str, logs: int) -> float:
    """CPU seconds of a batch in which that many logs ended in one way."""
    began = time.process_time()
    assert batch_case.counts(batch.run(path)) == {how: logs}
    return time.process_time() - began


def test_cost_of_a_log_from_few_to_many(tmp_path, in_this_process):
    """And of a second run with nothing new, and the memory that the parent holds."""
    cost(site(tmp_path / "warm", FEW, 10**6), "done", FEW)  # imports, kernels
    few = [cost(site(tmp_path / f"few{k}", FEW, 10**6 + 100 * k), "done", FEW) / FEW for k in range(1, 6)]
    fixed = min(cost(tmp_path / f"few{k}" / "nightly.toml", "unchanged", FEW) for k in range(1, 6))  # of a batch with next to no logs
    path = site(tmp_path / "many", MANY)
    many, again = cost(path, "done", MANY) / MANY, cost(path, "unchanged", MANY)
    least = sorted(few)[len(few) // 2]
    print(f"\na comparison of {SECONDS:g} s costs {1e3 * least:.1f} ms of CPU among {FEW} logs, {1e3 * many:.1f} ms among {MANY}: {many / least:.3f} times")
    more = 1e3 * (again - fixed) / (MANY - FEW)
    print(f"a second run with nothing new: {1e3 * again / MANY:.3f} s per 1,000 logs (at most {AGAIN_S_PER_1000:g}), every further 1,000 {more:.3f} s")
    held = {logs: peak(folder) for logs, folder in ((FEW, tmp_path / "few1"), (MANY, tmp_path / "many"))}
    grown = (held[MANY] - held[FEW]) / (MANY - FEW) * 1000
    print(f"the parent's memory: {held[FEW]:.0f} MB at {FEW} logs, {held[MANY]:.0f} MB at {MANY}: {grown:.1f} MB per 1,000 logs")
    assert many < least * (1 + WITHIN) and again / MANY * 1000 < AGAIN_S_PER_1000 and grown < MEMORY_MB_PER_1000


def peak(folder: Path) -> float:
    """The most memory (MB) that the parent of a batch with nothing new holds."""
    done = subprocess.run([sys.executable, "-c", PEAK, str(folder / "nightly.toml")], check=True, capture_output=True, text=True)
    return int(done.stdout.split()[-1]) / 1e3


def test_two_workers_and_dask(tmp_path):
    """Wall times of the same work, twice each in an order that cancels a steady drift of the machine's speed, and the bytes that it leaves."""
    pytest.importorskip("distributed", reason="pip install 'rovval[cluster]'")
    import dask_case

    logs = site(tmp_path / "site", SIDE_BY_SIDE).parent / "logs"
    night = fault_case.Night(tmp_path / "night", logs, STEPS)
    took: dict[str, float] = {}
    left: dict[str, str] = {}
    def turn(way: str, how: dict[str, Any]) -> None:
        night.wipe()
        began = time.monotonic()
        assert batch_case.counts(batch.run(night.path, **how)) == {"done": SIDE_BY_SIDE}
        took[way] = took.get(way, 0.0) + time.monotonic() - began
        left[way] = hashlib.sha256(repr(sorted(night.kept().items())).encode()).hexdigest()

    turn("one worker", {"workers": 1})
    turn("two workers", {"workers": 2})
    with dask_case.cluster(2) as made:  # not beside the others: also an idle cluster takes of two cores
        batch.run(site(tmp_path / "warm", FEW, 10**6), scheduler=made.address)  # its workers are there every night, and have imported what they need
        for _ in range(2):
            turn("Dask, two workers", {"scheduler": made.address})
    turn("two workers", {"workers": 2})
    turn("one worker", {"workers": 1})
    print("\n" + ", ".join(f"{way} {seconds:.1f} s" for way, seconds in took.items()))
    print(f"two workers are {took['one worker'] / took['two workers']:.2f} times one (at least {TWO_WORKERS:g})")
    print(f"Dask takes {took['Dask, two workers'] / took['two workers']:.2f} times the pool (at most {1 + DASK_WITHIN:g})")
    assert len(set(left.values())) == 1, "not the same bytes"
    assert took["two workers"] * TWO_WORKERS < took["one worker"]
    assert took["Dask, two workers"] < took["two workers"] * (1 + DASK_WITHIN)
