"""MCAP of other profiles than ROS 2's, written by the format's own library: each encoding of messages gives the same log."""

from __future__ import annotations

import json
import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from mcap_protobuf.writer import Writer as ProtobufWriter
from rosbags.typesys import Stores, get_typestore

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.ingest.formats.mcap import contents

N, START_NS, LATE_NS = 300, 1_700_000_000_000_000_000, 5_000_000
PROFILE = """
name = "own"
description = "of the tests"
format = "{format}"
frame = "fsd"
world = "ned"
[time]
kind = "{kind}"
[channels]
u = {{ topic = "/nav", field = "{field}", unit = "m/s" }}
"""


def samples() -> Iterator[tuple[int, float]]:
    """Stamps in ns and speeds."""
    for i in range(N):
        yield START_NS + i * 100_000_000, 0.01 * i


def write_json(path: Path) -> None:
    with path.open("wb") as file:
        writer = Writer(file, chunk_size=4096, compression=CompressionType.NONE)
        writer.start(profile="", library="tests")
        channel = writer.register_channel("/nav", "json", writer.register_schema("Nav", "jsonschema", b"{}"))
        image = writer.register_channel("/image", "flatbuffer", writer.register_schema("Image", "flatbuffer", b""))
        for ns, u in samples():
            message = {"timestamp": {"sec": ns // 10**9, "nsec": ns % 10**9}, "velocity": {"u": u}, "mode": "manual", "ranges": [0.0] * 100}
            writer.add_message(channel, ns + LATE_NS, json.dumps(message).encode(), ns)
            writer.add_message(image, ns, b"\0", ns)
        writer.finish()


def write_ros(path: Path, ros1: bool) -> None:
    """ROS 1, and ROS 2 without the name of the profile."""
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    kind, types = "geometry_msgs/msg/TwistStamped", store.types
    text, _ = store.generate_msgdef(kind, ros_version=1 if ros1 else 2)
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start(profile="ros1" if ros1 else "", library="tests")
        schema = writer.register_schema(kind.replace("/msg", "") if ros1 else kind, "ros1msg" if ros1 else "ros2msg", text.encode())
        channel = writer.register_channel("/nav", "ros1" if ros1 else "cdr", schema)
        for ns, u in samples():
            stamp = types["builtin_interfaces/msg/Time"](sec=ns // 10**9, nanosec=ns % 10**9)
            header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="body", **({"seq": 0} if ros1 else {}))
            vector = types["geometry_msgs/msg/Vector3"]
            message = types[kind](header=header, twist=types["geometry_msgs/msg/Twist"](linear=vector(u, 0.0, 0.0), angular=vector(0.0, 0.0, 0.0)))
            raw = store.serialize_ros1(message, kind) if ros1 else store.serialize_cdr(message, kind)
            writer.add_message(channel, ns + LATE_NS, bytes(raw), ns)
        writer.finish()


def write_protobuf(path: Path) -> None:
    name = "rovval_tests.proto"
    file = descriptor_pb2.FileDescriptorProto(name=name, package="rovval_tests", syntax="proto3", dependency=["google/protobuf/timestamp.proto"])
    nav = file.message_type.add(name="Nav")
    nav.field.add(name="u", number=1, type=1, label=1)
    nav.field.add(name="timestamp", number=2, type=11, type_name=".google.protobuf.Timestamp", label=1)
    nav.field.add(name="rpm", number=3, type=1, label=3)
    pool = descriptor_pool.DescriptorPool()
    pool.AddSerializedFile(timestamp_pb2.DESCRIPTOR.serialized_pb)
    pool.Add(file)
    kind: Any = message_factory.GetMessageClass(pool.FindMessageTypeByName("rovval_tests.Nav"))
    with path.open("wb") as out:
        writer = ProtobufWriter(out)
        for ns, u in samples():
            message = kind(u=u, rpm=[1.0, 2.0])
            message.timestamp.seconds, message.timestamp.nanos = ns // 10**9, ns % 10**9
            writer.write_message("/nav", message, ns + LATE_NS, ns)
        writer.finish()


WRITERS = {
    "json": (write_json, "velocity.u"),
    "ros1": (lambda path: write_ros(path, True), "twist.linear.x"),
    "ros2": (lambda path: write_ros(path, False), "twist.linear.x"),
    "protobuf": (write_protobuf, "u"),
}


def profile(folder: Path, field: str, kind: str = "header", form: str = "mcap") -> str:
    path = folder / "own.toml"
    path.write_text(PROFILE.format(field=field, kind=kind, format=form))
    return str(path)


@pytest.mark.parametrize("encoding", WRITERS)
@pytest.mark.parametrize("kind", ["header", "record"])
def test_every_encoding_gives_the_same_log(tmp_path, encoding, kind):
    """By a profile of the format, and by one of bags, since a recorder may be set to write either."""
    write, field = WRITERS[encoding]
    write(tmp_path / "dive.mcap")
    for form in ("mcap", "ros_bag"):
        log = read(tmp_path / "dive.mcap", profile(tmp_path, field, kind, form))
        u = log.channels["u"]
        assert u.values == pytest.approx(0.01 * np.arange(N)) and u.t == pytest.approx(0.1 * np.arange(N), abs=1e-6) and u.stamp == kind
        assert log.t0_ns == pytest.approx(START_NS + (LATE_NS if kind == "record" else 0), abs=1000)


def test_what_is_not_decoded_is_said_and_arrays_have_addresses(tmp_path):
    write_json(tmp_path / "dive.mcap")
    blocks = list(contents(tmp_path / "dive.mcap"))
    nav = next(b for b in blocks if b.topic == "/nav")
    assert set(nav.numbers) == {"velocity.u", "timestamp.sec", "timestamp.nsec"} and nav.texts["mode"][0] == "manual" and "ranges" in nav.left_out
    said = [f for b in blocks for f in b.findings]
    assert [(f.code, f.where) for f in said] == [("undecoded", "/image")] and "flatbuffer" in said[0].detail
    write_protobuf(tmp_path / "p.mcap")
    assert {"u", "rpm[0]", "rpm[1]"} < set(next(b for b in contents(tmp_path / "p.mcap") if b.topic == "/nav").numbers)


def test_a_cut_file_is_read_to_its_last_whole_chunk(tmp_path):
    write_json(tmp_path / "dive.mcap")
    own, whole = profile(tmp_path, "velocity.u"), (tmp_path / "dive.mcap").read_bytes()
    kept = []
    for share in (0.2, 0.5, 0.8):
        (tmp_path / "dive.mcap").write_bytes(whole[: int(share * len(whole))])
        log = read(tmp_path / "dive.mcap", own)
        finding = next(f for f in log.findings if f.code == "cut_file")
        assert "messages are read, to 22:13:" in finding.detail and np.array_equal(log.channels["u"].values, 0.01 * np.arange(len(log.channels["u"].t)))
        kept.append(len(log.channels["u"].t))
    assert kept == sorted(kept) and 0.4 * N < kept[1] < kept[2] < N


def test_a_flipped_bit_is_found_by_the_checksum(tmp_path):
    write_json(tmp_path / "dive.mcap")
    own, raw = profile(tmp_path, "velocity.u"), bytearray((tmp_path / "dive.mcap").read_bytes())
    raw[raw.index(b"velocity", len(raw) // 2)] ^= 0x10
    (tmp_path / "dive.mcap").write_bytes(raw)
    log = read(tmp_path / "dive.mcap", own)
    assert [f.code for f in log.findings] == ["damaged_file"] and "left out" in log.findings[0].detail
    assert 0.9 * N < len(log.channels["u"].t) < N, "its chunk alone is lost"


def test_an_index_that_points_beyond_the_file_is_passed_over(tmp_path):
    """A chunk is damaged, and where the next one begins is damaged, too: the one after it is found."""
    write_json(tmp_path / "dive.mcap")
    with (tmp_path / "dive.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    chunks = sorted(chunk.chunk_start_offset for chunk in summary.chunk_indexes)
    own, raw = profile(tmp_path, "velocity.u"), bytearray((tmp_path / "dive.mcap").read_bytes())
    raw[chunks[3] + 200] ^= 0x10
    at = raw.rindex(struct.pack("<Q", chunks[4]))
    raw[at : at + 8] = b"\xff" * 8
    (tmp_path / "dive.mcap").write_bytes(raw)
    log = read(tmp_path / "dive.mcap", own)
    assert [f.code for f in log.findings] == ["damaged_file"] and "left out" in log.findings[0].detail
    assert N * (1 - 3 / len(chunks)) < len(log.channels["u"].t) < N, "two chunks are lost"


def test_a_spoiled_stream_of_a_chunk_is_a_refusal_or_a_finding(tmp_path):
    """Also where it is zstandard, not a checksum, that meets the damage."""
    write_protobuf(tmp_path / "dive.mcap")
    own, whole = profile(tmp_path, "u"), (tmp_path / "dive.mcap").read_bytes()
    refused = 0
    for at in range(100, len(whole) // 2, len(whole) // 20):
        (tmp_path / "dive.mcap").write_bytes(whole[:at] + bytes([whole[at] ^ 0x55]) + whole[at + 1 :])
        try:
            read(tmp_path / "dive.mcap", own)
        except BadInput as refusal:
            refused += "dive.mcap" in str(refusal)
    assert refused > 3


def test_a_topic_that_is_not_there_and_a_field_that_is_not(tmp_path):
    write_json(tmp_path / "dive.mcap")
    with pytest.raises(BadInput, match=r"/nav has no number 'velocity.x'; it has: timestamp.sec"):
        read(tmp_path / "dive.mcap", profile(tmp_path, "velocity.x"))
    with pytest.raises(BadInput, match="/navigation"):
        own = Path(profile(tmp_path, "velocity.u"))
        own.write_text(own.read_text().replace('"/nav"', '"/navigation"'))
        read(tmp_path / "dive.mcap", str(own))


def test_without_the_decoder_of_protocol_buffers(tmp_path, monkeypatch):
    write_protobuf(tmp_path / "dive.mcap")
    monkeypatch.setitem(sys.modules, "mcap_protobuf.decoder", None)
    with pytest.raises(UsageProblem, match="mcap-protobuf-support") as refusal:
        read(tmp_path / "dive.mcap", profile(tmp_path, "u"))
    assert "rovval[protobuf]" in refusal.value.hint
