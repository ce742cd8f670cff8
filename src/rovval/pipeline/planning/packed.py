"""Records of many logs, each packed into a few hundred bytes until it is asked for: a batch holds one of every log at once."""

from __future__ import annotations

import marshal
from collections.abc import Collection, Iterable, Iterator, Mapping
from typing import Any, cast

Record = Mapping[str, Any]


class Packed(Collection[Record]):
    """A collection of records, plain JSON each, in the order in which they were added. Every iteration makes them anew, one at a time; as dicts they
    take four times the memory, and Python's search for garbage goes through them again and again."""

    __slots__ = ("_packed",)

    def __init__(self, records: Iterable[Record] = ()) -> None:
        self._packed: list[bytes] = []
        for record in records:
            self.append(record)

    def append(self, record: Record) -> None:
        """One more, as it is now."""
        self._packed.append(marshal.dumps(cast(Any, record)))

    def __iter__(self) -> Iterator[Record]:
        return map(marshal.loads, self._packed)

    def __len__(self) -> int:
        return len(self._packed)

    def __contains__(self, record: object) -> bool:
        return any(one == record for one in self)

    def __add__(self, other: Packed) -> Packed:
        """Both, without unpacking them."""
        both = Packed()
        both._packed = self._packed + other._packed
        return both
