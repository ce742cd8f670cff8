"""Compressed tables of text, packed by other hands than those that unpack them here, and UTF-16 in each order."""

from __future__ import annotations

import bz2
import gzip
import lzma
from collections.abc import Callable

import merlin_case
import numpy as np
import pytest
import zstandard
from real_data import real

from rovval.core.errors import BadInput
from rovval.ingest import read
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
    with pytest.raises(BadInput, match=r"gzip.* is damaged"):
        read(tmp_path / "dive.csv.gz", "merlin")


@pytest.mark.parametrize("order", ["utf-16-le", "utf-16-be", "utf-16"])
def test_utf_16_with_and_without_a_mark(tmp_path, plain, order):
    path = tmp_path / "dive.csv"
    path.write_bytes(plain.decode().encode(order))
    log = read(path)
    assert len(log.channels["u"].values) == 300 and log.findings == ()


@pytest.mark.parametrize(("name", "content"), [("dive.csv", bytes(range(256)) * 100), ("dive.csv.gz", gzip.compress(bytes(4000)))])
def test_binary_content_is_refused(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(BadInput, match="is binary"):
        read(tmp_path / name, "merlin")


def test_another_compressed_log_is_refused_with_what_to_do(tmp_path):
    (tmp_path / "dive.bag.gz").write_bytes(gzip.compress(b"#ROSBAG V2.0\n"))
    with pytest.raises(BadInput, match="only logs of text") as refusal:
        read(tmp_path / "dive.bag.gz")
    assert "unpack" in refusal.value.hint


def test_logs_of_an_outside_plant_as_published():
    log = read(real("outside_plant/c00d2a81.csv.gz"))
    assert log.profile == "merlin" and len(log.channels["u"].values) == 6001
