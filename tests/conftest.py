"""Shared by all tests."""

import os
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
