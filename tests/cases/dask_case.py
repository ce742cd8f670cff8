"""A Dask cluster of processes of its own on loopback, any of which a test may kill."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).parent
SETTINGS = {"POLARS_MAX_THREADS": "1", "NUMBA_NUM_THREADS": "1", "DASK_DISTRIBUTED__WORKER__PROFILE__ENABLED": "False"}  # docs/night.md: workers of a cluster


@dataclass
class Cluster:
    """A scheduler and its workers (with their nannies), each the leader of its own group of processes."""

    port: int
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)
    scheduler: subprocess.Popen[bytes] | None = None

    @property
    def address(self) -> str:
        return f"tcp://127.0.0.1:{self.port}"

    def start_scheduler(self) -> None:
        self.scheduler = started("scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.1)
        raise TimeoutError(f"no scheduler at {self.address}")

    def start_worker(self, *options: str) -> None:
        self.workers.append(started("worker", self.address, "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1", *options))

    def stop(self) -> None:
        for process in [*self.workers, *([self.scheduler] if self.scheduler else [])]:
            kill(process)


def started(what: str, *args: str) -> subprocess.Popen[bytes]:
    env = {**os.environ, **SETTINGS, "PYTHONPATH": os.pathsep.join([str(HERE), *filter(None, [os.environ.get("PYTHONPATH")])])}
    command = [sys.executable, "-m", "distributed.cli.dask_" + what, *args]
    return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=env, start_new_session=True)


def kill(process: subprocess.Popen[bytes]) -> None:
    """Kill -9 a process and all that it has started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


@contextmanager
def cluster(workers: int = 2, *options: str) -> Iterator[Cluster]:
    """A scheduler with so many workers."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        made = Cluster(probe.getsockname()[1])
    try:
        made.start_scheduler()
        for _ in range(workers):
            made.start_worker(*options)
        yield made
    finally:
        made.stop()
