"""The code that a batch's results are made by: it counts in every key of a plan, and every worker must have the same."""

from __future__ import annotations

from functools import cache

from rovval.core import code_version as engine

NO_RESULT = ("blind", "cli", "demo", "scenarios")  # rooms that no step of a batch goes through


def code() -> str:
    """Hash of the sources as they stand on disk (milliseconds). Vehicles and profiles count by their own content."""
    return engine.digest(NO_RESULT, (".py",))


@cache
def mine() -> str:
    """That of this process, once: a worker goes on with the code that it began with."""
    return code()
