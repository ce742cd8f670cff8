"""Cut and spoiled bags: everything before, between and after is read, is what the whole file has, and the loss is said."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from bag_case import N, write
from mcap.reader import make_reader
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Bag1

from rovval.core.errors import BadInput
from rovval.ingest import read

KINDS = ("bag", "lz4", "bz2", "db3", "mcap")
PREPARE: dict[str, Callable[..., None]] = {
    "lz4": lambda writer: writer.set_compression(Bag1.CompressionFormat.LZ4), "bz2": lambda writer: writer.set_compression(Bag1.CompressionFormat.BZ2),
}  # fmt: skip


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bags")
    out = {}
    for kind in KINDS:
        ros1 = kind not in ("db3", "mcap")
        path = write("bag" if ros1 else kind, folder / f"{kind}.bag" if ros1 else folder / kind, 20_000 if ros1 else None, PREPARE.get(kind))
        out[kind] = path if ros1 else next(path.glob(f"*.{kind}"))
    return out


def spoiled(path, tmp_path, content):
    copy = tmp_path / f"spoiled{path.suffix}"
    copy.write_bytes(content)
    return copy


def saved(raw, whole):
    """How many samples a channel has, each of which the whole file has as well."""
    for name, series in raw.channels.items():
        at = np.searchsorted(whole.channels[name].t, series.t - 1e-6)
        assert np.array_equal(series.values, whole.channels[name].values[at]), name
    return len(raw.channels["u"].t)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("keep", [0.95, 0.7, 0.5, 0.35])
def test_of_a_cut_bag_everything_before_the_cut_is_saved_and_the_loss_is_said(files, kind, keep, tmp_path):
    content = files[kind].read_bytes()
    raw = read(spoiled(files[kind], tmp_path, content[: int(keep * len(content))]))
    assert saved(raw, read(files[kind])) > 0.75 * (keep - 0.15) * N
    (finding,) = (f for f in raw.findings if f.code == "cut_file")
    assert "the file ends" in finding.detail and " UTC; " in finding.detail
    messages = int(finding.detail.split()[0].replace(",", ""))
    assert messages == int(raw.properties["messages"])


def test_a_cut_is_told_with_the_messages_saved_and_the_time_of_the_last(files, tmp_path):
    content = files["bag"].read_bytes()
    raw = read(spoiled(files["bag"], tmp_path, content[: len(content) // 2]))
    n = len(raw.channels["u"].t)
    (finding,) = raw.findings
    last = 1_700_000_000 + (n - 1) * 0.1 + 0.03
    said = f"22:13:{int(last - 1_700_000_000 + 20):02d} UTC"  # 1 700 000 000 s since 1970 is 22:13:20
    assert finding.detail == f"{raw.properties['messages']} messages, to {said}; the file ends in the middle of a chunk"


@pytest.mark.parametrize("kind", KINDS)
def test_bags_that_end_before_their_first_message_are_one_refusal(files, kind, tmp_path):
    content = files[kind].read_bytes()
    path = spoiled(files[kind], tmp_path, content[: {"db3": 3000, "mcap": 60}.get(kind, 4100)])
    with pytest.raises(BadInput) as refused:
        read(path, "ros_odometry")
    assert refused.value.hint and path.name in refused.value.message


@pytest.mark.parametrize("kind", ["bag", "lz4", "bz2"])
def test_a_bag_that_was_never_closed_is_read_without_its_index(files, kind, tmp_path):
    content = bytearray(files[kind].read_bytes())
    at = content.index(b"index_pos=") + 10
    end = int.from_bytes(content[at : at + 8], "little")
    content[at : at + 8] = bytes(8)
    raw = read(spoiled(files[kind], tmp_path, bytes(content[:end])))
    assert saved(raw, read(files[kind])) == N and "did not close" in raw.findings[0].detail


@pytest.mark.parametrize("kind", ["bag", "lz4", "bz2"])
def test_a_spoiled_chunk_costs_no_more_than_itself(files, kind, tmp_path):
    content = bytearray(files[kind].read_bytes())
    chunks = [k for k in range(len(content)) if content.startswith(b"op=\x05", k)]
    at = chunks[len(chunks) // 2] + 200
    content[at : at + 40] = bytes(b ^ 0x55 for b in content[at : at + 40])
    raw = read(spoiled(files[kind], tmp_path, bytes(content)))
    assert len(raw.channels["u"].t) >= N - 30
    assert {f.code for f in raw.findings} <= {"damaged_file", "damaged_message"} and raw.findings


@pytest.mark.parametrize("chunked", [True, False])
def test_a_flipped_bit_of_an_mcap_is_caught_by_its_crc(files, chunked, tmp_path):
    """Of a chunk, which is left out; without chunks the CRC is the whole file's, which only says that some byte is wrong."""
    path = tmp_path / "crc.mcap"
    with path.open("wb") as file, files["mcap"].open("rb") as source:
        writer = McapWriter(file, chunk_size=20_000, use_chunking=chunked, enable_data_crcs=True, compression=CompressionType.NONE)
        writer.start(profile="ros2")
        channels: dict[int, int] = {}
        for schema, channel, message in make_reader(source).iter_messages():
            if channel.id not in channels and schema is not None:
                about = (schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(channel.topic, "cdr", writer.register_schema(*about))
            writer.add_message(channels[channel.id], message.log_time, message.data, message.publish_time)
        writer.finish()
    whole = read(path)
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    raw = read(spoiled(path, tmp_path, bytes(content)))
    (finding,) = (f for f in raw.findings if f.code == "damaged_file")
    assert "CRC" in finding.detail and not whole.findings
    assert (N - 30 < saved(raw, whole) < N) if chunked else len(raw.channels["u"].t) >= N - 1


def test_a_spoiled_page_costs_its_rows(files, tmp_path):
    content = bytearray(files["db3"].read_bytes())
    leaves = [k for k in range(0, len(content), 4096) if content[k] == 13 and b"base_link" in content[k : k + 4096]]
    at = leaves[len(leaves) // 2]
    content[at : at + 4096] = b"\xa5" * 4096
    raw = read(spoiled(files["db3"], tmp_path, bytes(content)))
    assert N - 20 < saved(raw, read(files["db3"])) < N and any("cannot be read" in f.detail for f in raw.findings)
