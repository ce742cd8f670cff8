"""A run, and a simulation of it beside it, as the files that other tools read. A format is one file of this folder, named as ``--to`` has it.

A format has ``SUFFIX`` and ``write(content, path) -> tuple[Path, ...]`` (the files written). Poses and velocities are in the axes of the
robotics world (REP-103: forward-left-up in the world east-north-up) where ROS messages or trajectories are written, in ours
(forward-starboard-down in north-east-down) in tables, which say so.
"""

from __future__ import annotations

import importlib
import pkgutil
from pathlib import Path
from typing import Protocol, cast

from rovval.core.data import Run, SimResult
from rovval.core.errors import BadInput, UsageProblem
from rovval.export.content import Content

__all__ = ["Format", "formats", "suffix", "write"]
SHARED = ("content", "messages")  # files of this folder that are no format


class Format(Protocol):
    """What a format's module offers."""

    SUFFIX: str

    def write(self, content: Content, path: Path) -> tuple[Path, ...]:
        """Write the files, whole or not at all; returns them."""
        ...


def formats() -> tuple[str, ...]:
    """Names of the formats, by looking at file names only."""
    return tuple(sorted(m.name for m in pkgutil.iter_modules(__path__) if m.name not in SHARED))


def suffix(name: str) -> str:
    """What a format's files end in; refuses a format that does not exist (`UsageProblem`)."""
    return _format(name).SUFFIX


def write(run: Run, name: str, path: Path, sim: SimResult | None = None) -> tuple[Path, ...]:
    """Write ``run``, and ``sim`` beside it, in the format ``name``; returns the files written, ``path`` first.

    Raises `UsageProblem` for an unknown format or a place that cannot be written, `BadInput` for a simulation of another run and for a
    run that holds nothing which the format could hold.
    """
    if sim is not None and (sim.run_id != run.id or len(sim.free.ok) != len(run)):
        raise BadInput(
            f"a simulation of run {sim.run_id} ({len(sim.free.ok)} samples), not of {run.id} ({len(run)})",
            "make one with `rovval simulate` of the same log, profile and stretch",
        )
    return _format(name).write(Content(run, sim), path)


def _format(name: str) -> Format:
    if name not in formats():
        raise UsageProblem(f"unknown format {name!r}", f"use one of: {', '.join(formats())}")
    return cast(Format, importlib.import_module(f"{__name__}.{name}"))
