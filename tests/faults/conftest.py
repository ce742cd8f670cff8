"""Shared by the tests of faults."""

from __future__ import annotations

import fault_case
import pytest


@pytest.fixture(scope="session")
def logs(tmp_path_factory):
    return fault_case.logs_in(tmp_path_factory.mktemp("logs"))


@pytest.fixture(scope="session")
def undisturbed(logs, tmp_path_factory):
    """What an undisturbed night leaves, by the steps of its pipeline; made once."""
    known: dict[str, dict[str, str]] = {}

    def of(steps: str) -> dict[str, str]:
        if steps not in known:
            night = fault_case.Night(tmp_path_factory.mktemp("undisturbed"), logs, steps)
            assert night.whole() == 0
            known[steps] = night.kept()
            assert sum(name.endswith("/manifest.json") for name in known[steps]) == fault_case.LOGS
            fault_case.check_all(night, known[steps])
        return known[steps]

    return of
