"""Where the numbers of a serialised message stand, so that a column of them is read out of many messages in one step.

A message of ROS (1, or 2 in CDR) is its fields one after the other; where a field begins depends on the lengths of the strings and
sequences before it and on nothing else. Messages with the same lengths thus share one layout: the first is walked by its type, the
others only compared in their lengths. ROS 1: wiki.ros.org/msg, without padding. CDR: OMG DDSI-RTPS 2.3, 10.2 and CORBA 3.3 part 2, 9.3:
four bytes of head, then every number aligned to its size.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from rovval.ingest.bags.block import Bytes, Index, numbers_at

SIZES = {
    "bool": "u1", "byte": "u1", "char": "u1", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "int64": "i8", "uint64": "u8", "float32": "f4", "float64": "f8",
}  # fmt: skip
NO_MEMBER = "structure_needs_at_least_one_member"  # what stands for an empty type, which takes a byte in ROS 2 and none in ROS 1
Types = Mapping[str, Any]  # name of a type -> (constants, fields), as `rosbags.typesys` has them


class Damaged(Exception):
    """The lengths in a message lead out of it, or do not fill it."""


@dataclass(frozen=True, slots=True)
class Layout:
    """``numbers``: address of a field (``pose.position.x``) -> where it begins, its NumPy dtype, and how many there are of it (0: it is no
    array). ``texts``: address -> where it begins and its bytes. ``places``, ``values``: of the four bytes that hold lengths, which messages
    of this layout share."""

    numbers: Mapping[str, tuple[int, str, int]]
    texts: Mapping[str, tuple[int, int]]
    places: Index
    values: Index

    def fits(self, data: Bytes, starts: Index) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
        """Which of the messages at ``starts`` (n,) have this layout (n,)."""
        if not len(self.places):
            return np.ones(len(starts), dtype=bool)
        return np.asarray((numbers_at(data, "<u4", starts[:, None] + self.places) == self.values).all(axis=1))

    def column(self, data: Bytes, starts: Index, address: str) -> np.ndarray[tuple[int], np.dtype[np.float64]] | None:
        """The field at ``address`` (``data[3]`` for one of an array) of each message (n,); None where it is no number of this layout."""
        place, dtype, many = self.numbers.get(address, (0, "", 1))
        if many and (found := re.fullmatch(r"(.*)\[(\d+)\]", address)):
            place, dtype, many = self.numbers.get(found[1], (0, "", 0))
            if int(found[2]) >= many:
                return None
            place, many = place + int(found[2]) * np.dtype(dtype).itemsize, 0
        return None if many else np.asarray(numbers_at(data, dtype, starts + place), dtype=np.float64)

    def text(self, data: Bytes, starts: Index, address: str) -> list[str]:
        """The text at ``address`` of each message (n,)."""
        place, size = self.texts[address]
        rows = data[starts[:, None] + np.arange(place, place + size)]
        return [row.tobytes().rstrip(b"\0").decode(errors="replace") for row in rows]


def layout(types: Types, kind: str, message: bytes, cdr: bool) -> Layout:
    """The layout of a message of type ``kind``. Raises `Damaged`, and `KeyError` for a type that is not defined."""
    walk = _Walk(types, message, cdr)
    try:
        walk.fields(kind, "")
    except struct.error:
        raise Damaged from None
    left = len(message) - walk.at
    if left < 0 or left > (3 if cdr else 0):  # CDR may be padded to a multiple of four bytes
        raise Damaged
    return Layout(walk.numbers, walk.texts, np.array([p for p, _ in walk.lengths], np.int64), np.array([v for _, v in walk.lengths], np.int64))


class _Walk:
    """The way through one message: ``at`` is the next byte."""

    def __init__(self, types: Types, message: bytes, cdr: bool) -> None:
        self.types, self.message, self.cdr = types, message, cdr
        self.at = self.base = 4 if cdr else 0
        self.order = ">" if cdr and len(message) > 1 and message[1] == 0 else "<"
        self.numbers: dict[str, tuple[int, str, int]] = {}
        self.texts: dict[str, tuple[int, int]] = {}
        self.lengths: list[tuple[int, int]] = []
        if cdr:
            if len(message) < 4 or message[0] != 0 or message[1] > 1:
                raise Damaged
            self._note(0)

    def fields(self, kind: str, path: str) -> None:
        for name, (node, what) in self.types[kind][1]:
            if name == NO_MEMBER and not self.cdr:
                continue
            address = f"{path}.{name}" if path else name
            if int(node) in (_ARRAY, _SEQUENCE):
                of, count = what
                self.many(of, count if int(node) == _ARRAY else self.length(), address)
            else:
                self.one(node, what, address)

    def one(self, node: Any, what: Any, address: str) -> None:
        if int(node) == _NAME:
            self.fields(what, address)
        elif what[0] in SIZES:
            self.skip(SIZES[what[0]], 1, address, 0)
        elif what[0] == "string":
            size = self.length()
            self.texts[address] = (self.at, size)
            self.at += size
        else:
            raise KeyError(what[0])
        if self.at > len(self.message):
            raise Damaged

    def many(self, of: Any, count: int, address: str) -> None:
        node, what = of
        if count > len(self.message):
            raise Damaged  # nothing that is sent is smaller than a byte
        if int(node) != _NAME and what[0] in SIZES:
            self.skip(SIZES[what[0]], count, address, count)
            return
        for i in range(count):
            self.one(node, what, f"{address}[{i}]")

    def skip(self, dtype: str, count: int, address: str, size: int) -> None:
        width = int(dtype[1:])
        if count:
            self.align(width)
            self.numbers[address] = (self.at, self.order + dtype, size)
            self.at += width * count
        if self.at > len(self.message):
            raise Damaged

    def length(self) -> int:
        self.align(4)
        (value,) = struct.unpack_from(self.order + "I", self.message, self.at)
        self._note(self.at)
        self.at += 4
        return int(value)

    def align(self, width: int) -> None:
        if self.cdr:
            self.at += -(self.at - self.base) % width

    def _note(self, at: int) -> None:
        self.lengths.append((at, struct.unpack_from("<I", self.message, at)[0]))


_NAME, _ARRAY, _SEQUENCE = 2, 3, 4  # rosbags.interfaces.Nodetype, which is not imported for its weight
