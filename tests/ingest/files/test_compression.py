"""Compressed tables of text, packed by other hands than those that unpack them here, and UTF-16 in each order."""

from __future__ import annotations

import bz2
import gzip
import lzma
import sqlite3
from collections.abc import Callable

import merlin_case
import numpy as np
import pytest
import zstandard
from bag_case import write
from real_data import real

from rovval.core.errors import BadInput
from rovval.ingest import read
from rovval.ingest.files import sha256
from rovval.ingest.inspection.inspect import inspect
from rovval.pipeline.planning.discover import logs_in

PACKERS: dict[str, Callable[[bytes], bytes]] = {
    ".gz": gzip.compress,
    ".bz2": lambda plain: bz2.compress(plain, 1),  # in blocks of 100 kB, so that a cut one has a whole one
    ".xz": lambda plain: lzma.compress(plain, preset=0),
    ".zst": zstandard.compress,
}


@pytest.fixture(scope="module")
def plain():
    return merlin_case.text(merlin_case.columns()).encode()


@pytest.mark.parametrize("suffix", PACKERS)
def test_packed_is_read_as_plain(tmp_path, plain, suffix):
    """The profile is found as for the plain file, and a folder is searched for it."""
    path = tmp_path / f"dive.csv{suffix}"
    path.write_bytes(PACKERS[suffix](plain))
    (tmp_path / "plain").mkdir()
    (tmp_path / "plain" / "dive.csv").write_bytes(plain)
    packed, log = read(logs_in([str(tmp_path)])[0]), read(tmp_path / "plain" / "dive.csv")
    assert packed.profile == "merlin" and packed.findings == () and packed.source == str(path)
    assert all(np.array_equal(packed.channels[n].values, log.channels[n].values) for n in log.channels)


@pytest.mark.parametrize("suffix", PACKERS)
def test_a_cut_one_is_read_to_where_it_ends(tmp_path, plain, suffix):
    path = tmp_path / f"dive.csv{suffix}"
    rows = np.random.default_rng(0).permutation(60_000)  # noise behind the log, so that the cut is inside of the stream for every packer
    whole = PACKERS[suffix](plain + b"".join(b"# %d\n" % r for r in rows))
    path.write_bytes(whole[: int(0.7 * len(whole))])
    log = read(path)
    assert [f.code for f in log.findings] == ["cut_file"] and "ends in the middle" in log.findings[0].detail
    assert len(log.channels["u"].values) == 300


def test_several_streams_in_one_file_are_one(tmp_path, plain):
    path = tmp_path / "dive.csv.gz"
    path.write_bytes(gzip.compress(plain[:5000]) + gzip.compress(plain[5000:]) + bytes(4096))
    assert len(read(path).channels["u"].values) == 300 and read(path).findings == ()


def test_damage_in_the_stream_is_said(tmp_path, plain):
    packed = bytearray(gzip.compress(plain))
    packed[-6] ^= 0xFF  # in the checksum
    (tmp_path / "dive.csv.gz").write_bytes(packed)
    log = read(tmp_path / "dive.csv.gz", "merlin")
    assert log.findings[0].code == "damaged_file" and "(gzip) is damaged" in log.findings[0].detail
    assert len(log.channels["u"].values) > 290, "nearly all rows stand before it"


def test_what_stands_before_damage_is_saved(tmp_path, plain):
    """A block of 64 kB was lost with it: of most logs all of it."""
    packed = bytearray(gzip.compress(plain))
    packed[int(0.8 * len(packed))] ^= 0xFF
    (tmp_path / "dive.csv.gz").write_bytes(packed)
    log = read(tmp_path / "dive.csv.gz", "merlin")
    assert "damaged_file" in {f.code for f in log.findings} and len(log.channels["u"].values) > 200


@pytest.mark.parametrize("order", ["utf-16-le", "utf-16-be", "utf-16"])
def test_utf_16_with_and_without_a_mark(tmp_path, plain, order):
    path = tmp_path / "dive.csv"
    path.write_bytes(plain.decode().encode(order))
    log = read(path)
    assert len(log.channels["u"].values) == 300 and log.findings == ()


@pytest.mark.parametrize(("name", "content"), [("dive.csv", bytes(range(256)) * 100), ("dive.csv.gz", gzip.compress(bytes(4000)))], ids=["csv", "gz"])
def test_binary_content_is_refused(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(BadInput, match="is binary"):
        read(tmp_path / name, "merlin")


@pytest.mark.parametrize(("kind", "suffix"), [("bag", ".gz"), ("bag", ".bz2"), ("mcap", ".zst"), ("db3", ".zst")])
def test_other_logs_are_unpacked_while_they_are_read(tmp_path, kind, suffix):
    """Also where the compressed file is cut: to where it ends."""
    made = write(kind, tmp_path / f"made.{kind}")
    plain = made if made.is_file() else next(made.glob(f"*.{kind}"))
    path = tmp_path / f"dive.{kind}{suffix}"
    path.write_bytes(PACKERS[suffix](plain.read_bytes()))
    packed, log = read(path), read(plain)
    assert packed.profile == "ros_odometry" and packed.findings == () and packed.source == str(path) and packed.sha256 == sha256(path)
    assert all(np.array_equal(packed.channels[n].values, log.channels[n].values) for n in log.channels)
    assert inspect(path).path == path and inspect(path).fits == ("ros_odometry",)
    assert path in logs_in([str(tmp_path)])


def test_a_cut_compressed_bag_is_read_to_where_it_ends(tmp_path):
    whole = bz2.compress(write("bag", tmp_path / "a.bag", 20_000).read_bytes() + np.random.default_rng(0).bytes(300_000), 1)
    (tmp_path / "dive.bag.bz2").write_bytes(whole[: int(0.8 * len(whole))])
    log = read(tmp_path / "dive.bag.bz2")
    assert log.findings[0].code == "cut_file" and log.findings[0].where == "dive.bag.bz2" and len(log.channels["u"].t) > 100


def test_a_bag_whose_messages_are_compressed_one_by_one(tmp_path):
    """As `ros2 bag record --compression-mode message` writes them, without the metadata.yaml that says so."""
    made = next(write("db3", tmp_path / "b").glob("*.db3"))
    expected = read(made)
    with sqlite3.connect(made) as base:
        for number, data in base.execute("SELECT id, data FROM messages").fetchall():
            base.execute("UPDATE messages SET data = ? WHERE id = ?", (zstandard.compress(data), number))
    base.close()
    log = read(made)
    assert all(np.array_equal(log.channels[n].values, s.values) for n, s in expected.channels.items())


def test_a_refusal_names_the_compressed_file(tmp_path):
    (tmp_path / "dive.bag.gz").write_bytes(gzip.compress(b"#ROSBAG V2.0\n"))
    with pytest.raises(BadInput, match=r"dive\.bag\.gz") as refusal:
        read(tmp_path / "dive.bag.gz")
    assert "rovval-" not in refusal.value.message


def test_logs_of_an_outside_plant_as_published():
    log = read(real("outside_plant/c00d2a81.csv.gz"))
    assert log.profile == "merlin" and len(log.channels["u"].values) == 6001
