"""What a container gives: its connections, and messages of one connection by the block."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from rovval.core.errors import Finding

Index = NDArray[np.int64]
Bytes = NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Connection:
    """Messages of one type on one topic. ``kind`` is the type by its ROS 2 name (``nav_msgs/msg/Odometry``), ``definition`` its text in
    ``language`` ("" where the file has none), ``digest`` what the file says the definition's digest is, ``encoding`` how messages are serialised."""

    topic: str
    kind: str
    definition: str
    language: Literal["msg", "idl", ""]
    digest: str
    encoding: Literal["ros1", "cdr"]


@dataclass(frozen=True, slots=True)
class Block:
    """Messages of one connection in the order of the file: message i is ``data[start[i] : start[i] + size[i]]``, written at
    ``record_ns[i]`` (ns since 1970)."""

    connection: Connection
    record_ns: Index
    data: Bytes
    start: Index
    size: Index


class Container(Protocol):
    """A file that holds messages. ``blocks`` gives those of the topics asked for; what is damaged is in ``findings`` once they are through.
    ``foreign``: topics whose messages are not serialised as ROS does, and how they are. ``share`` of ``blocks`` that is through."""

    findings: list[Finding]
    foreign: dict[str, str]
    share: float

    def connections(self) -> list[Connection]:
        """Every connection of the file, without reading its messages where the file is whole."""
        ...

    def blocks(self, topics: frozenset[str]) -> Iterator[Block]:
        """The messages on ``topics``."""
        ...


def numbers_at(data: Bytes, dtype: str, places: Index) -> NDArray[np.generic]:
    """The numbers of ``dtype`` that begin at ``places`` (n,), aligned or not."""
    kind = np.dtype(dtype)
    every = np.ndarray((max(len(data) - kind.itemsize + 1, 0),), dtype=kind, buffer=data, strides=(1,))
    return every[places]
