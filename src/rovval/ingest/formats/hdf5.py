"""Logs as HDF5: each group is a topic, its arrays are the fields; the arrays of the file's root are one table of columns."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from rovval.core.data import RawLog
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block
from rovval.ingest.profile import Profile

SUFFIXES = (".h5", ".hdf5", ".hdf", ".he5")
ALSO: tuple[str, ...] = ("csv_log",)
MAGIC = b"\x89HDF\r\n\x1a\n"  # HDF5 file format specification, II.A


def sniff(path: Path) -> bool:
    """Whether the file begins as HDF5 does."""
    with path.open("rb") as file:
        return file.read(8) == MAGIC


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns or groups of ``profile`` that the file has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in

    return missing_in({b.topic: (*b.numbers, *b.texts) for b in contents(path)}, profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming everything that is missing, `UsageProblem` without h5py."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, contents(path, progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """A block for each group, and for each length of arrays in it. Raises `BadInput` for a damaged file, `UsageProblem` without h5py."""
    from rovval.ingest.contents.hdf5_arrays import nested, opened
    from rovval.ingest.contents.nested_arrays import blocks_of

    with opened(path) as file:
        arrays, units = nested(file, progress=progress)
    yield from blocks_of(arrays, units, "/")
