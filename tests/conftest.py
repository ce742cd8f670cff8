"""Shared by all tests."""

import os
import resource
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest

for threads in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):  # read once, when numpy is first imported: its matrices are
    os.environ.setdefault(threads, "1")  # small here, and threads that wait for one another cost three times the work itself

ROOT = Path(__file__).parent.parent


@pytest.fixture(autouse=True, scope="session")
def _plain_terminal() -> None:
    """Help texts have one width and no colour, whatever terminal runs the tests."""
    os.environ.update({"COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb"})
    os.environ.pop("ROVVAL_DEBUG", None)


@pytest.fixture
def no_more_than() -> Callable[[int], AbstractContextManager[None]]:
    """While the block lasts no file can grow beyond so many bytes: the system refuses as it does on a disk that is full."""

    @contextmanager
    def limited(size: int) -> Iterator[None]:
        before = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, before)

    return limited
