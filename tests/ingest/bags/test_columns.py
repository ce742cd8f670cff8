"""Columns beside rosbags' own deserialisation: any type, any lengths, both serialisations, to the last bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from rovval.ingest.bags.block import Block, Connection
from rovval.ingest.bags.columns import Columns, types_of

PLAIN = {"bool": "bool", "int8": "int8", "uint8": "uint8", "int16": "int16", "uint32": "uint32", "int64": "int64", "float32": "float32", "float64": "float64"}
FIELD = st.sampled_from(["string", *PLAIN, *(f"{kind}[]" for kind in PLAIN), *(f"{kind}[3]" for kind in PLAIN), "string[]", "Inner", "Inner[]", "Inner[2]"])


def value(data: Any, kind: str, store: Any) -> Any:
    """Something that a field of ``kind`` can hold."""
    base, _, many = kind.partition("[")
    if many:
        count = int(many[:-1]) if many[:-1] else data.draw(st.integers(0, 3))
        one = [value(data, base, store) for _ in range(count)]
        return np.array(one, dtype=PLAIN[base]) if base in PLAIN else one
    if base == "string":
        return data.draw(st.text("abc", max_size=5))
    if base == "Inner":
        return store.types["x/msg/Inner"](name=value(data, "string", store), size=value(data, "int16", store), way=value(data, "float64", store))
    return data.draw(st.integers(0, 100 if base != "bool" else 1)) * (0.5 if base.startswith("float") else 1)


def address_in(name: str, kind: str) -> str:
    """The address of a number in a field of ``kind`` that every message has; "" where none has to be there."""
    if "string" in kind or kind.endswith("[]"):
        return ""
    return name + {"Inner[2]": "[1].way", "Inner": ".size"}.get(kind, "[2]" if "[" in kind else "")


def flat(message: Any, address: str) -> float:
    return float(eval(f"message.{address}", {"message": message}))


@settings(max_examples=60, deadline=None)
@given(st.lists(FIELD, min_size=1, max_size=6), st.sampled_from(["ros1", "cdr"]), st.data())
def test_any_message_as_rosbags_has_it(fields, encoding, data):
    text = "\n".join(f"{kind} f{i}" for i, kind in enumerate(fields)) + f"\nfloat64 last\n{'=' * 80}\nMSG: x/Inner\nstring name\nint16 size\nfloat64 way\n"
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(text, "x/msg/Outer"))
    count = data.draw(st.integers(1, 6))
    sent = [store.types["x/msg/Outer"](**{f"f{i}": value(data, kind, store) for i, kind in enumerate(fields)}, last=0.25 * k) for k in range(count)]
    serialize = store.serialize_ros1 if encoding == "ros1" else store.serialize_cdr
    raw = [bytes(serialize(message, "x/msg/Outer")) for message in sent]
    connection = Connection("/t", "x/msg/Outer", text, "msg", "", encoding)
    size = np.array([len(r) for r in raw], dtype=np.int64)
    block = Block(connection, np.arange(len(raw)), np.frombuffer(b"".join(raw), np.uint8), np.cumsum(size) - size, size)
    addresses = ["last", *(a for i, kind in enumerate(fields) if (a := address_in(f"f{i}", kind)))]
    columns = Columns(connection, types_of([connection], {}), addresses)
    columns.take(block)
    record, header, found = columns.arrays()
    assert columns.damaged == 0 and not columns.absent and record.tolist() == list(range(len(raw))) and not header.any()
    for address in addresses:
        assert found[address].tolist() == [flat(message, address) for message in sent]


@pytest.mark.parametrize("encoding", ["ros1", "cdr"])
def test_a_message_whose_lengths_lead_out_of_it_is_left_out_and_counted(encoding):
    text = "string name\nfloat64[] data\n"
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(text, "x/msg/T"))
    message = store.types["x/msg/T"](name="abc", data=np.arange(4.0))
    good = bytes(store.serialize_ros1(message, "x/msg/T") if encoding == "ros1" else store.serialize_cdr(message, "x/msg/T"))
    count = good.rindex(b"\x04\0\0\0", 0, len(good) - 32)  # of the numbers, which take the last 32 bytes
    raw = [good, good[:-3], good + b"12345", b"", good[:count] + b"\xff" * 4 + good[count + 4 :], good]
    connection = Connection("/t", "x/msg/T", text, "msg", "", encoding)
    size = np.array([len(r) for r in raw], dtype=np.int64)
    columns = Columns(connection, types_of([connection], {}), ["data[3]", "data[4]"])
    columns.take(Block(connection, np.arange(6), np.frombuffer(b"".join(raw), np.uint8), np.cumsum(size) - size, size))
    record, _, found = columns.arrays()
    assert columns.damaged == 4 and record.tolist() == [0, 5] and found["data[3]"].tolist() == [3.0, 3.0] and columns.absent == {"data[4]"}
