"""Counts in sentences."""

from __future__ import annotations

import pytest

from rovval.core.counts import counted


@pytest.mark.parametrize(
    ("count", "one", "many", "said"),
    [(0, "row", "", "0 rows"), (1, "row", "", "1 row"), (2, "row", "", "2 rows"), (12000, "byte", "", "12,000 bytes"),
     (1, "log was", "logs were", "1 log was"), (3, "log was", "logs were", "3 logs were")],
)  # fmt: skip
def test_one_is_said_as_one(count: int, one: str, many: str, said: str):
    assert counted(count, one, many) == said
