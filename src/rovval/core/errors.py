"""Every way in which rovval refuses, with the exit code that the command line gives for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


class RovvalError(Exception):
    """Base of all refusals: what is wrong, and what to do next. ``exit_code`` is the command's."""

    exit_code = 70

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.message}\n  next: {self.hint}" if self.hint else self.message

    def __reduce__(self) -> tuple[type[RovvalError], tuple[str, str]]:
        """Crosses process boundaries whole (the batch runs logs in worker processes)."""
        return (type(self), (self.message, self.hint))


class UsageProblem(RovvalError):
    """The command or a configuration file asks for something that does not exist (exit 2)."""

    exit_code = 2


class Unwritable(UsageProblem):
    """A disk that is full or closed to us: not the fault of any log, so that a batch stops (exit 2)."""


class BadVehicle(UsageProblem):
    """A vehicle file whose numbers cannot be a vehicle (exit 2)."""


class BadInput(RovvalError):
    """A log that cannot be used (exit 3)."""

    exit_code = 3


class SimulationStopped(RovvalError):
    """The simulated state left sane limits before anything could be compared (exit 4)."""

    exit_code = 4


@dataclass(frozen=True, slots=True)
class Finding:
    """One fact about a log that a reader of the result should know; nothing is raised for it.

    ``code`` is one word for machines (``gap``, ``repeated_row``), ``where`` the channel, file or row.
    """

    code: str
    where: str
    detail: str

    def __str__(self) -> str:
        return f"{self.code}: {self.where}: {self.detail}"


def merged(found: Sequence[Finding]) -> list[Finding]:
    """What is true of several channels or columns in the same words as one finding, where the first of them stood."""
    where: dict[tuple[str, str], list[str]] = {}
    for finding in found:
        where.setdefault((finding.code, finding.detail), []).append(finding.where)
    return [Finding(code, ", ".join(dict.fromkeys(names)), detail) for (code, detail), names in where.items()]


def all_at_once(problems: Sequence[str], what: str) -> str:
    """Join every problem of one kind into one message, so that they are mended in one go."""
    if len(problems) == 1:
        return f"{what}: {problems[0]}"
    return f"{what}: {len(problems)} problems\n" + "\n".join(f"  - {p}" for p in problems)
