"""Logs as Parquet: one table, its columns as a profile for CSV or Parquet names them."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rovval.core.data import RawLog
from rovval.core.errors import BadInput
from rovval.core.progress import Progress, silent
from rovval.ingest.contents.block import Block
from rovval.ingest.profile import Profile

SUFFIXES = (".parquet", ".pq")
ALSO: tuple[str, ...] = ("csv_log",)
MAGIC = b"PAR1"  # Apache Parquet, file format: a file begins and ends so


def sniff(path: Path) -> bool:
    """Whether the file begins as Parquet does."""
    with path.open("rb") as file:
        return file.read(4) == MAGIC


def missing(path: Path, profile: Profile) -> tuple[str, ...]:
    """Required columns of ``profile`` that the file has not, and `absent` ones that it has."""
    from rovval.ingest.assembly.topics import missing_in

    block = next(_blocks(path, rows=0))
    return missing_in({"": (*block.numbers, *block.texts)}, profile)


def read(path: Path, profile: Profile, progress: Progress = silent) -> RawLog:
    """The log of ``path``. Raises `BadInput` naming every missing column, or what makes the file useless."""
    from rovval.ingest.assembly.topics import read_blocks

    return read_blocks(path, profile, contents(path, progress))


def contents(path: Path, progress: Progress = silent) -> Iterator[Block]:
    """The table's columns; nested ones by address. Raises `BadInput` for a damaged file."""
    return _blocks(path, progress)


def _blocks(path: Path, progress: Progress = silent, rows: int | None = None) -> Iterator[Block]:
    import polars as pl

    from rovval.ingest.contents.frame_block import block_of

    try:
        with _panics_unprinted():
            count, columns = len(pl.read_parquet_schema(path)), list[pl.Series]()
            for number in range(count):  # one after the other, as they lie in the file, to tell how far it is
                progress("reading columns", number / count)
                columns += pl.read_parquet(path, columns=[number], n_rows=rows, use_pyarrow=False, glob=False).get_columns()
            frame = pl.DataFrame(columns)
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError) as error:  # its decoder panics at some damage
        raise BadInput(f"{path}: damaged: {str(error).splitlines()[0]}", "Parquet keeps its index at the end: is the file whole?") from None
    yield block_of("", frame)


@contextmanager
def _panics_unprinted() -> Iterator[None]:
    """What polars' decoder prints of its panics, some forty lines on stderr before it raises, is not printed: the refusal says it. What is printed
    and nothing is raised, is passed on."""
    try:
        stderr = os.dup(2)
    except OSError:  # a process without stderr
        yield
        return
    with tempfile.TemporaryFile() as said:
        os.dup2(said.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(stderr, 2)
            os.close(stderr)
        said.seek(0)
        if words := said.read():
            os.write(2, words)
