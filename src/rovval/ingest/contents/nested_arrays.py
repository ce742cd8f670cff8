"""Arrays nested by name, as Matlab and HDF5 files hold them -> blocks: a group (structure) is a topic, its arrays of one length are a table.

Where arrays of a group have several lengths, as logs at several rates in one workspace do, each length is a table of its own: the most
frequent under the group's name, the others named by their rows too. A matrix is its columns, ``nu[0]``, ``nu[1]``, ...
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from rovval.core.data import Array
from rovval.ingest.contents.block import MOST_MEMBERS, Block

LEAST_ROWS = 2  # of which a log consists: single values are facts


def blocks_of(groups: Mapping[str, Any], units: Mapping[str, str], separator: str) -> Iterator[Block]:
    """Blocks of nested mappings of arrays. ``units``: path of an array (names joined by ``separator``) -> unit that the file states."""
    waiting: list[tuple[str, Mapping[str, Any]]] = [("", groups)]
    while waiting:
        path, group = waiting.pop(0)
        inside = {f"{path}{path and separator}{name}": part for name, part in group.items() if isinstance(part, Mapping)}
        yield from _tables(path, {n: v for n, v in group.items() if not isinstance(v, Mapping)}, units, separator)
        waiting += inside.items()


def _tables(path: str, members: Mapping[str, Any], units: Mapping[str, str], separator: str) -> Iterator[Block]:
    arrays = {name: value for name, value in members.items() if isinstance(value, np.ndarray) and value.ndim in (1, 2)}
    counts = Counter(a.shape[0] for a in arrays.values() if a.ndim == 1 and a.shape[0] >= LEAST_ROWS)
    counts = counts or Counter(max(a.shape) for a in arrays.values() if a.ndim == 2)
    lengths = [n for n, _ in sorted(counts.items(), key=lambda item: (-item[1], -item[0]))]
    left_out = {name: _what(value) for name, value in members.items() if name not in arrays}
    for at, rows in enumerate(lengths):
        numbers: dict[str, Array] = {}
        texts: dict[str, list[str]] = {}
        stated: dict[str, str] = {}
        for name, value in arrays.items():
            columns = _columns(name, value, rows)
            unit = units.get(f"{path}{path and separator}{name}", "")
            stated |= dict.fromkeys(columns, unit) if unit else {}
            for column, cells in columns.items():
                if cells.dtype.kind in "biuf":
                    numbers[column] = cells.astype(np.float64)
                else:
                    texts[column] = [str(cell) for cell in cells.tolist()]
            if not columns and not any(_columns(name, value, other) for other in lengths):
                left_out[name] = f"{' x '.join(map(str, value.shape))} {value.dtype}"
        yield Block(path if at == 0 else f"{path}({rows} rows)", numbers=numbers, texts=texts, units=stated, left_out={} if at else left_out)
    if not lengths and left_out:
        yield Block(path, left_out=left_out)


def _columns(name: str, value: np.ndarray[Any, Any], rows: int) -> dict[str, np.ndarray[Any, Any]]:
    """The columns that an array is in a table of ``rows`` rows; {} where it has none, or is no number and no text."""
    if value.dtype.kind not in "biufUS":
        return {}
    if value.ndim == 1:
        return {name: value} if value.shape[0] == rows else {}
    matrix = value if value.shape[0] == rows else value.T
    if matrix.shape[0] != rows or not 0 < matrix.shape[1] <= MOST_MEMBERS:
        return {}
    return {name: matrix[:, 0]} if matrix.shape[1] == 1 else {f"{name}[{i}]": matrix[:, i] for i in range(matrix.shape[1])}


def _what(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return f"{' x '.join(map(str, value.shape))} {value.dtype}"
    return str(value) if isinstance(value, (str, int, float, bool, np.number)) else type(value).__name__
