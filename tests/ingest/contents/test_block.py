"""What a reader of messages gets for nothing: fields by address, and blocks in which every column is as long as the block."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rovval.ingest.contents.block import BLOCK_ROWS, MOST_MEMBERS, Collector
from rovval.ingest.contents.flatten import flat


@dataclass
class Pose:
    x: float
    names: list[str]
    LOCKED: int = 3


def test_nested_messages_become_addresses():
    fields, left_out = flat({"pose": Pose(1.5, ["a", "b"]), "pwm": np.array([1500, 1600]), "ok": True, "image": b"123", "cloud": [0.0] * (MOST_MEMBERS + 1)})
    assert fields == {"pose.x": 1.5, "pose.names[0]": "a", "pose.names[1]": "b", "pwm[0]": 1500.0, "pwm[1]": 1600.0, "ok": 1.0}
    assert left_out == {"image": "3 bytes", "cloud": f"{MOST_MEMBERS + 1} elements"}


def test_a_field_that_comes_and_goes_is_missing_in_between():
    collector = Collector()
    messages: list[dict[str, float | str]] = [{"a": 1.0}, {"a": 2.0, "mode": "hold"}, {}, {"b": 4.0}]
    assert all(collector.add("/t", "kind", {"record": float(i)}, m) is None for i, m in enumerate(messages))
    [block] = collector.rest()
    assert block.rows == 4
    assert np.array_equal(block.numbers["a"], [1, 2, np.nan, np.nan], equal_nan=True)
    assert np.array_equal(block.numbers["b"], [np.nan, np.nan, np.nan, 4], equal_nan=True)
    assert block.texts == {"mode": ["", "hold", "", ""]}


def test_a_long_topic_comes_in_blocks_of_bounded_size():
    collector = Collector()
    full = [b for i in range(2 * BLOCK_ROWS + 5) if (b := collector.add("/t", "", {"record": float(i)}, {"a": float(i)}))]
    sizes = [b.rows for b in (*full, *collector.rest())]
    assert sizes == [BLOCK_ROWS, BLOCK_ROWS, 5]
