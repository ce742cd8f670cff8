"""Columns of long logs in a temporary file instead of memory: the system keeps as much of them at hand as there is room for.

What is written is mapped for reading, so that an array is an array wherever it lies, and a log of any length needs the memory of a few of its
columns. The file has no name and goes with the array.
"""

from __future__ import annotations

import mmap
import tempfile
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import BadInput

LONG = 1 << 18  # values, 2 MB: a column of an hour at 73 Hz; below, it is not worth a file


def at_rest(values: NDArray[Any]) -> NDArray[Any]:
    """A column as it is, or of a long one what was written of it, read-only. Raises `BadInput` where there is no room for it."""
    if values.ndim != 1 or len(values) < LONG or is_at_rest(values):
        return values
    column = LongColumn(values.dtype)
    column.append(values)
    return column.array()


def no_room(what: str, error: OSError) -> BadInput:
    """The refusal where the folder of temporary files takes no more."""
    folder = tempfile.gettempdir()
    hint = f"what of a long log is large is kept in {folder} meanwhile: make room there, set TMPDIR, or cut the log by --from and --to"
    return BadInput(f"{what} cannot be kept in {folder}: {error.strerror}", hint)


def is_at_rest(values: NDArray[Any]) -> bool:
    """Whether a column lies in a file of this module."""
    base = values.base
    return isinstance(base, mmap.mmap) or (isinstance(base, memoryview) and isinstance(base.obj, mmap.mmap))


class LongColumn:
    """A column that grows: in memory until it is long, then in a file."""

    def __init__(self, dtype: Any = np.float64) -> None:
        self._held: NDArray[Any] = np.zeros(0, dtype)
        self._file: IO[bytes] | None = None
        self._written = 0

    def __len__(self) -> int:
        return len(self._held) + self._written

    def append(self, more: NDArray[Any]) -> None:
        """Add values at the end. Raises `BadInput` where there is no room for them."""
        size = len(self._held)
        if self._file is None and size + len(more) < LONG:
            self._held.resize(size + len(more), refcheck=False)  # in its place: parts put together at the end would be there twice
            self._held[size:] = more
            return
        try:
            if self._file is None:
                self._file = tempfile.TemporaryFile(prefix="rovval-")  # noqa: SIM115 - `array` closes it
                self._file.write(self._held.tobytes())
                self._written, self._held = size, self._held[:0].copy()
            self._file.write(more.astype(self._held.dtype).tobytes())
            self._written += len(more)
        except OSError as error:
            raise no_room("a column of a long log", error) from None

    def array(self) -> NDArray[Any]:
        """The values (n,); of a long column read-only, and nothing is added any more."""
        if self._file is None:
            return self._held
        self._file.flush()
        with self._file:
            return np.frombuffer(mmap.mmap(self._file.fileno(), 0, access=mmap.ACCESS_READ), dtype=self._held.dtype)
