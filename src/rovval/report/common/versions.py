"""What made a report: the versions of what computed its numbers, and the command that asked for it."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache

from rovval.core.version import __version__

_COMMAND: ContextVar[str] = ContextVar("command", default="")


@contextmanager
def made_by(words: Sequence[str]) -> Iterator[None]:
    """Pages that are written meanwhile name this as the command that made them; those of a script name none."""
    before = _COMMAND.set(shlex.join(["rovval", *words]))
    try:
        yield
    finally:
        _COMMAND.reset(before)


def foot(*more: str) -> str:
    """The last line of a page: the command that made it, the versions, and what else is to be said there."""
    command = f"made by {_COMMAND.get()}" if _COMMAND.get() else ""
    return " · ".join(filter(None, [command, *(f"{name} {version}" for name, version in versions().items()), *more]))


@cache
def versions() -> Mapping[str, str]:
    """Versions of rovval, of Python and of the packages that the numbers depend on, by name."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    found = {"rovval": __version__, "python": platform.python_version()}
    for package in ("numpy", "scipy", "numba", "rerun-sdk"):
        try:
            found[package] = version(package)
        except PackageNotFoundError:
            continue
    return found
