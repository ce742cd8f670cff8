"""What a reader yields of a log without a profile: blocks of samples as they were logged, topic by topic.

This is all that a new format owes to `rovval inspect` and `rovval profile propose`: rates, spans, gaps, ranges, matching profiles and the
proposal are made of these blocks, for every format alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from rovval.core.data import Array
from rovval.core.errors import Finding

MOST_MEMBERS = 18  # elements of an array that become fields of their own: the channels of an RC override; a covariance has 36
BLOCK_ROWS = 10_000  # messages of a topic that a reader collects before it yields them: some MB

_T = TypeVar("_T", float, str)


@dataclass(frozen=True, slots=True)
class Block:
    """A stretch of n messages of one topic, or of n rows of a table, in the order of the file. Nothing in it is converted or turned.

    - ``topic``: as a profile's ``topic`` addresses it (``/odom``, ``XKF1``, ``XKF1[1]``); "" for a table, whose fields are columns.
    - ``kind``: the message's type as the format names it, "" where it has none.
    - ``clocks``: (n,) stamps in s, since 1970 UTC or since any start, under the names that `[time] kind` has for them: ``record`` (the recorder
      wrote) and ``header`` (the sensor measured), NaN where a message has none. A table leaves this empty: its stamps are columns.
    - ``numbers``: address of a field, as a profile's ``field`` or ``column`` has it (``pose.pose.position.x``, ``data[3]``), -> (n,) values as
      logged, NaN where missing. Of arrays the first `MOST_MEMBERS` elements; a longer array is ``left_out``.
    - ``texts``: the same of fields that are no numbers (stamps written as text, names of modes), "" where missing.
    - ``units``: address -> unit as the log itself states it (an attribute, a definition), as written; brackets in a column's name are read by others.
    - ``left_out``: address -> what it is and why it is not among the fields (``uint8[921600]``).
    - ``facts``: what the file says of itself once (separator, encoding, name of the writer); ``findings``: damage met on the way.
    """

    topic: str
    kind: str = ""
    clocks: Mapping[str, Array] = field(default_factory=dict)
    numbers: Mapping[str, Array] = field(default_factory=dict)
    texts: Mapping[str, Sequence[str]] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    left_out: Mapping[str, str] = field(default_factory=dict)
    facts: Mapping[str, str] = field(default_factory=dict)
    findings: tuple[Finding, ...] = ()

    @property
    def rows(self) -> int:
        """n, the number of messages or rows."""
        return max((len(v) for part in (self.clocks, self.numbers, self.texts) for v in part.values()), default=0)


class Collector:
    """Messages one at a time -> blocks: what a reader of messages needs between its decoder and `Block`.

    `add` each message with its fields as a flat mapping; it returns a block whenever `BLOCK_ROWS` of a topic are together. `rest` yields
    what is left. Fields may come and go between messages; where a message has not a field that others have, it is missing.
    """

    def __init__(self) -> None:
        self._held: dict[tuple[str, str], _Held] = {}

    def add(
        self, topic: str, kind: str, clocks: Mapping[str, float], fields: Mapping[str, float | str], left_out: Mapping[str, str] | None = None
    ) -> Block | None:
        """Take one message; returns a full block or None."""
        held = self._held.setdefault((topic, kind), _Held())
        for name, stamp in clocks.items():
            _put(held.clocks, name, stamp, held.rows, np.nan)
        for name, value in fields.items():
            _put(held.texts, name, value, held.rows, "") if isinstance(value, str) else _put(held.numbers, name, value, held.rows, np.nan)
        held.left_out |= left_out or {}
        held.rows += 1
        if held.rows < BLOCK_ROWS:
            return None
        del self._held[topic, kind]
        return held.block(topic, kind)

    def rest(self) -> Iterator[Block]:
        """What is left, one block a topic."""
        for (topic, kind), held in self._held.items():
            yield held.block(topic, kind)


@dataclass(slots=True)
class _Held:
    rows: int = 0
    clocks: dict[str, list[float]] = field(default_factory=dict)
    numbers: dict[str, list[float]] = field(default_factory=dict)
    texts: dict[str, list[str]] = field(default_factory=dict)
    left_out: dict[str, str] = field(default_factory=dict)

    def block(self, topic: str, kind: str) -> Block:
        def full(columns: dict[str, list[float]]) -> dict[str, Array]:
            return {n: np.array([*c, *[np.nan] * (self.rows - len(c))], dtype=np.float64) for n, c in columns.items()}

        texts = {n: [*c, *[""] * (self.rows - len(c))] for n, c in self.texts.items()}
        return Block(topic, kind, full(self.clocks), full(self.numbers), texts, left_out=self.left_out)


def _put(columns: dict[str, list[_T]], name: str, value: _T, row: int, missing: _T) -> None:
    column = columns.setdefault(name, [])
    if len(column) < row:
        column.extend([missing] * (row - len(column)))
    column.append(value)
