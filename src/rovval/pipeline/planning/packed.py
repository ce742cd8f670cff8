"""Records of many logs, packed until they are asked for: a batch holds one of every log at once, and its memory is not to grow with them."""

from __future__ import annotations

import marshal
import zlib
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any, cast, overload

Record = Mapping[str, Any]
TOGETHER = 100  # records that are compressed as one: they say nearly the same, and take a tenth of their room


class Packed(Sequence[Record]):
    """Records, plain JSON each, in the order in which they were added. They are made anew whenever they are asked for; as dicts they take forty times
    the memory, and Python's search for garbage goes through them again and again."""

    __slots__ = ("_last", "_packed")

    def __init__(self, records: Iterable[Record] = ()) -> None:
        self._packed: list[bytes] = []  # `TOGETHER` records each
        self._last: list[bytes] = []  # the rest, one each
        for record in records:
            self.append(record)

    def append(self, record: Record) -> None:
        """One more, as it is now."""
        self._last.append(marshal.dumps(cast(Any, record)))
        if len(self._last) == TOGETHER:
            self._packed.append(zlib.compress(marshal.dumps(self._last), 1))
            self._last = []

    def __len__(self) -> int:
        return len(self._packed) * TOGETHER + len(self._last)

    @overload
    def __getitem__(self, number: int) -> Record: ...
    @overload
    def __getitem__(self, number: slice) -> Sequence[Record]: ...
    def __getitem__(self, number: int | slice) -> Record | Sequence[Record]:
        if isinstance(number, slice):
            return [self[n] for n in range(len(self))[number]]
        part, place = divmod(range(len(self))[number], TOGETHER)
        record: Record = marshal.loads((_apart(self._packed[part]) if part < len(self._packed) else self._last)[place])
        return record


@lru_cache(maxsize=8)  # who reads several of them side by side, or two in turns, has each at hand
def _apart(packed: bytes) -> list[bytes]:
    records: list[bytes] = marshal.loads(zlib.decompress(packed))
    return records
