"""Shared by the tests of the batch."""

import batch_case
import pytest


@pytest.fixture
def site(tmp_path):
    """Three logs and a pipeline that ingests them."""
    for number, name in enumerate(("a", "b", "c")):
        batch_case.write_log(tmp_path / "logs" / f"{name}.csv", seed=number)
    return tmp_path
