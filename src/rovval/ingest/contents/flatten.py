"""A decoded message -> its fields by address: ``{"pose.position.x": 1.0, "data[0]": 1500.0}``."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rovval.ingest.contents.block import MOST_MEMBERS

LONGEST_TEXT = 64  # characters: a stamp, a mode, a name; more is no field to read a value from


def flat(message: Any) -> tuple[dict[str, float | str], dict[str, str]]:
    """Numbers and short texts of a message by address, as a profile's ``field`` has them, and what was left out (address -> what it is).

    ``message`` is a mapping, a dataclass, or any object with ``__slots__`` or attributes of its own, nested as it likes; arrays of up to
    `MOST_MEMBERS` elements become ``name[0]``, ``name[1]``, ...
    """
    fields: dict[str, float | str] = {}
    left_out: dict[str, str] = {}
    for name, value in _members(message):
        _walk(name, value, fields, left_out)
    return fields, left_out


def _walk(address: str, value: Any, fields: dict[str, float | str], left_out: dict[str, str]) -> None:
    if isinstance(value, str):
        if len(value) <= LONGEST_TEXT:
            fields[address] = value
        else:
            left_out[address] = f"text of {len(value)} characters"
    elif isinstance(value, (bytes, bytearray, memoryview)):
        left_out[address] = f"{len(value)} bytes"
    elif isinstance(value, (bool, int, float, np.number, np.bool_)):
        fields[address] = float(value)
    elif isinstance(value, (Sequence, np.ndarray)):
        if len(value) > MOST_MEMBERS:
            left_out[address] = f"{len(value)} elements"
            return
        for i, member in enumerate(value):
            _walk(f"{address}[{i}]", member, fields, left_out)
    elif value is not None:
        for name, member in _members(value):
            _walk(f"{address}.{name}", member, fields, left_out)


def _members(value: Any) -> list[tuple[str, Any]]:
    if isinstance(value, Mapping):
        return [(str(name), member) for name, member in value.items()]
    if dataclasses.is_dataclass(value):
        constant = dataclasses.MISSING  # a field with a default is a constant of the message type
        return [(f.name, getattr(value, f.name)) for f in dataclasses.fields(value) if f.default is constant and not f.name.startswith("_")]
    names = getattr(value, "__slots__", None) or getattr(value, "__dict__", {})
    return [(name, getattr(value, name)) for name in names if not name.startswith("_") and hasattr(value, name)]
