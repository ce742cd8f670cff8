"""Containers beside their own libraries: every message that rosbags gives, byte for byte, from every kind of file and compression."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bag_case import N, write
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Bag1
from rosbags.rosbag2 import CompressionFormat, CompressionMode

from rovval.ingest.bags.recording import recording


def mine(path: Path, scratch: Path) -> tuple[Counter[Any], list[str]]:
    """Every message as (topic, stamp, bytes), how often; and what was found."""
    opened: list[Any] = []
    bag = recording(path, scratch, opened)
    seen: Counter[Any] = Counter()
    for block in bag.blocks(frozenset(c.topic for c in bag.connections())):
        for ns, start, size in zip(block.record_ns, block.start, block.size, strict=True):
            seen[block.connection.topic, int(ns), block.data[start : start + size].tobytes()] += 1
    return seen, [f.code for f in (*opened, *bag.findings())]


def theirs(path: Path) -> Counter[Any]:
    with AnyReader([path]) as reader:
        return Counter((c.topic, ns, bytes(raw)) for c, ns, raw in reader.messages())


def packed1(kind):
    return lambda writer: writer.set_compression(kind)


def packed2(mode):
    return lambda writer: writer.set_compression(mode, CompressionFormat.ZSTD)


FILES: dict[str, tuple[str, Any]] = {
    "bag": ("bag", None),
    "bag in lz4": ("bag", packed1(Bag1.CompressionFormat.LZ4)),
    "bag in bz2": ("bag", packed1(Bag1.CompressionFormat.BZ2)),
    "db3": ("db3", None),
    "db3, file in zstd": ("db3", packed2(CompressionMode.FILE)),
    "db3, messages in zstd": ("db3", packed2(CompressionMode.MESSAGE)),
    "mcap": ("mcap", None),
    "mcap, chunks in zstd": ("mcap", packed2(CompressionMode.STORAGE)),
}


@pytest.mark.parametrize("name", FILES)
def test_every_message_that_rosbags_reads(name, tmp_path):
    kind, prepare = FILES[name]
    path = write(kind, tmp_path / f"one.{kind}", 20_000 if kind == "bag" else None, prepare)
    seen, found = mine(path, tmp_path)
    assert seen == theirs(path) and sum(seen.values()) == 3 * N and not found


@pytest.mark.parametrize("compression", list(CompressionType))
@pytest.mark.parametrize("chunked", [True, False])
def test_every_message_that_the_mcap_library_writes(compression, chunked, tmp_path):
    path = tmp_path / "one.mcap"
    rng = np.random.default_rng(0)
    sent: Counter[Any] = Counter()
    with path.open("wb") as file:
        writer = McapWriter(file, chunk_size=5000, compression=compression, use_chunking=chunked, enable_data_crcs=True)
        writer.start(profile="ros1")
        schema = writer.register_schema("std_msgs/String", "ros1msg", b"string data")
        channels = {topic: writer.register_channel(topic, "ros1", schema) for topic in ("/a", "/b")}
        for i in range(600):
            topic, raw = ("/a", "/b")[i % 2], rng.bytes(int(rng.integers(0, 60)))
            writer.add_message(channels[topic], i, raw, i)
            sent[topic, i, raw] += 1
        writer.finish()
    assert mine(path, tmp_path) == (sent, [])


def test_a_bag_folder_without_its_metadata_is_read_by_its_files(tmp_path):
    path = write("mcap", tmp_path / "three")
    whole, _ = mine(path, tmp_path)
    (path / "metadata.yaml").write_text("rosbag2_bagfile_information: [cut")
    assert mine(path, tmp_path) == (whole, ["damaged_file"])
