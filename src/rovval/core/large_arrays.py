"""Large arrays in a temporary file instead of memory: the system keeps as much of them at hand as there is room for.

A file is mapped, so that an array is an array wherever it lies. It has no name and goes with the array. Its room on the disk is taken when it is made: a
disk that is full is told then, and not in the middle of a calculation.
"""

from __future__ import annotations

import mmap
import os
import tempfile

import numpy as np

from rovval.core.data import Array
from rovval.core.long_columns import no_room

LARGE = 1 << 26  # bytes, 64 MB: the sensitivities of four minutes of log to every effect of the library; below, a file costs more than it saves (measured)


def zeros(*shape: int) -> Array:
    """An array of zeros: in memory, or a large one in a file. Raises `BadInput` where there is no room for it."""
    size = int(np.prod(shape)) * np.dtype(float).itemsize
    if size < LARGE:
        return np.zeros(shape)
    try:
        with tempfile.TemporaryFile(prefix="rovval-") as file:
            if hasattr(os, "posix_fallocate"):
                os.posix_fallocate(file.fileno(), 0, size)
            else:  # not every system promises room
                file.truncate(size)
            return np.frombuffer(mmap.mmap(file.fileno(), size), dtype=float).reshape(shape)
    except OSError as error:
        raise no_room(f"an array of {size / 1e9:.1f} GB", error) from None


def taken(array: Array, which: np.ndarray) -> Array:
    """The rows ``which`` (m,) of an array, flags or numbers."""
    rows = np.arange(len(array))[which]
    found = zeros(len(rows), *array.shape[1:])
    for to, row in enumerate(rows):
        found[to] = array[row]
    return found


def joined(*parts: Array) -> Array:
    """Arrays one behind the other, by rows."""
    found, at = zeros(sum(len(p) for p in parts), *parts[0].shape[1:]), 0
    for part in parts:
        found[at : at + len(part)] = part
        at += len(part)
    return found


def columns_first(m: int, *shape: int, columns: int) -> Array:
    """Zeros (m, ..., columns) in which each column of a row is contiguous, since columns are written and read one by one."""
    return np.moveaxis(zeros(m, columns, *shape), 1, -1)


def side_by_side(a: Array, b: Array) -> Array:
    """The columns of two arrays (m, ..., columns), those of ``b`` behind those of ``a``."""
    both = columns_first(*a.shape[:-1], columns=a.shape[-1] + b.shape[-1])
    both[..., : a.shape[-1]], both[..., a.shape[-1] :] = a, b
    return both
