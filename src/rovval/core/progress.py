"""How far a piece of work is, for whoever shows it: what is being done, and the share of it that is done, 0 to 1."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[str, float], None]


def silent(step: str, share: float) -> None:
    """Nobody looks."""


def part_of(progress: Progress, number: int, parts: int) -> Progress:
    """The progress of one of several equal parts as that of the whole; ``number`` from 0."""
    return lambda step, share: progress(step, (number + share) / parts)
