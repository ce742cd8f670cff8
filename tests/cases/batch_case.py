"""Small Merlin logs, pipeline files, and work that misbehaves, for the tests of the batch."""

import os
import signal
import time
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from rovval.core.errors import Unwritable
from rovval.demo import make
from rovval.pipeline.execution.worker import Outcome, work
from rovval.pipeline.planning import config
from rovval.pipeline.planning.plan import Task, plan


def write_log(path: Path, seconds: float = 5.0, seed: int = 0, rpm: float = 40.0) -> Path:
    """A Merlin log of a vehicle that hardly moves; different seeds have different content."""
    n, k = round(seconds * 10), len(make.THRUSTERS)
    speeds = np.full((n, k), rpm)
    columns = make.noisy_rows(np.zeros((n, 6)), np.zeros((n, 6)) + 5.0, speeds, speeds, np.random.default_rng(seed))
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(make.as_csv(columns))
    return path


def write_pipeline(folder: Path, *lines: str, steps: str = '["ingest"]') -> Path:
    """A pipeline over folder/logs/*.csv."""
    path = folder / "nightly.toml"
    head = ['name = "nightly"', f"steps = {steps}", 'archive = "archive"', 'reports = "reports"', *lines]
    path.write_text(
        "\n".join([*head, "[[source]]", 'logs = ["logs/*.csv"]', 'profile = "merlin"', 'vehicle = "merlin"']) + "\n"
    )
    return path


def counts(document: dict[str, Any]) -> dict[str, int]:
    """How many logs ended in which way, without the ways that none ended in."""
    return {how: many for how, many in document["counts"].items() if many}


def tasks_of(pipeline: Path) -> tuple[Task, ...]:
    """What a pipeline file still asks for."""
    return plan(config.load(pipeline), pipeline.parent).todo


def deadly(task: Task) -> Outcome:
    """Work that kills its own process on the log named killer, as the kernel does when memory runs out, and leaves it on leaver."""
    if task.log.stem == "killer":
        os.kill(os.getpid(), signal.SIGKILL)
    if task.log.stem == "leaver":
        os._exit(9)
    return work(task)


def deadly_after_a_while(task: Task) -> Outcome:
    """As `deadly`, when others wait behind it by then."""
    if task.log.stem == "killer":
        time.sleep(2.0)
    return deadly(task)


def deadly_at_its_end(task: Task) -> Outcome:
    """Work that is killed when all of it is done and nobody knows it yet."""
    work(task)
    os.kill(os.getpid(), signal.SIGKILL)
    raise AssertionError


def slow(task: Task) -> Outcome:
    """Work that never ends on the log named hanger."""
    if task.log.stem == "hanger":
        time.sleep(60)
    return work(task)


def telling(task: Task) -> Outcome:
    """Work that never ends and says which process is at it, in a file beside the log."""
    task.log.with_suffix(".pid").write_text(str(os.getpid()))
    return slow(task)


def no_space(folder: object, *_rest: object) -> NoReturn:
    """A disk that is full, for whatever writes."""
    raise Unwritable(f"{folder}: cannot be written: No space left on device", "free space on its disk, or write elsewhere")


def paused(task: Task) -> Outcome:
    """Work that takes its time, so that a test can kill the batch in the middle."""
    time.sleep(0.5)
    return work(task)


def counting_threads(_task: Task) -> Outcome:
    """Work that says how many threads its process has after a product of matrices."""
    square = np.ones((500, 500))
    return {"status": "done", "record": {"threads": len(list(Path("/proc/self/task").iterdir())), "sum": float((square @ square).sum())}}
