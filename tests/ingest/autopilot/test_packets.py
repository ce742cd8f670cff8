"""Cut and damaged autopilot logs: every whole packet is read, none under a wrong stamp, and what is lost is counted."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from real_data import real

from rovval.ingest import read
from rovval.ingest.autopilot.packets import packets

START_S, N = 1_700_000_000, 400


def telemetry():
    """Packets of a .tlog, each behind its stamp."""
    from pymavlink.dialects.v20 import ardupilotmega as m

    link = m.MAVLink(None, srcSystem=1, srcComponent=1)
    out = []
    for i in range(N):
        stamp = struct.pack(">Q", int((START_S + 0.1 * i) * 1e6))
        out += [stamp + m.MAVLink_attitude_message(5000 + 100 * i, 0.001 * i, 0.0, 0.0, 0.0, 0.0, 0.0).pack(link)]
    return out


PROFILE = """
name = "roll"
description = "of the tests"
format = "autopilot"
frame = "fsd"
world = "ned"
[time]
kind = "record"
[channels]
phi = { topic = "ATTITUDE", field = "roll", unit = "rad" }
"""


@pytest.fixture
def profile(tmp_path):
    (tmp_path / "roll.toml").write_text(PROFILE)
    return str(tmp_path / "roll.toml")


def sample(log):
    """The numbers of the packets that were read, by their values, and by their stamps."""
    phi = log.channels["phi"]
    return np.rint(phi.values * 1000).astype(int), np.rint(phi.t / 0.1 + (log.t0_ns * 1e-9 - START_S) / 0.1).astype(int)


@pytest.mark.parametrize("seed", range(3))
def test_what_is_whole_is_read_and_the_rest_counted(tmp_path, profile, seed):
    """Bytes flipped, bytes lost, a block of zeros, an end in the middle of a packet: against which packets were touched."""
    rng, sent = np.random.default_rng(seed), telemetry()
    spoiled = set(rng.choice(np.arange(2, N - 3), 12, replace=False).tolist())
    content = []
    for k, packet in enumerate(sent):
        if k in spoiled:
            at = int(rng.integers(9, len(packet)))
            packet = [packet[:at] + bytes([packet[at] ^ 0x55]) + packet[at + 1 :], packet[:at], bytes(len(packet)), b"\xfd" + packet][k % 4]
        content.append(packet)
    whole = b"".join(content)
    (tmp_path / "a.tlog").write_bytes(whole[:-11])
    log = read(tmp_path / "a.tlog", profile)
    values, stamps = sample(log)
    assert np.array_equal(values, stamps), "none is read under another's stamp"
    untouched = {k for k in range(N - 1) if k not in spoiled and k + 1 not in spoiled}
    assert untouched <= set(values.tolist()) <= set(range(N)) - spoiled | {k for k in spoiled if k % 4 == 3}
    said = {f.code: f.detail for f in log.findings}
    assert "the file ends in the middle of one" in said["cut_file"] and "UTC" in said["cut_file"] and "no whole packet" in said["damaged_file"]


def test_a_first_stamp_that_is_wrong_costs_its_packet_alone(tmp_path, profile):
    sent = telemetry()
    (tmp_path / "a.tlog").write_bytes(b"\x7f" + b"".join(sent)[1:])
    assert sample(read(tmp_path / "a.tlog", profile))[0].tolist() == list(range(1, N))


def test_a_whole_log_says_nothing(tmp_path, profile):
    (tmp_path / "a.tlog").write_bytes(b"".join(telemetry()))
    assert read(tmp_path / "a.tlog", profile).findings == () and packets((tmp_path / "a.tlog").read_bytes()).count == N


def test_dataflash_is_read_past_damage_and_to_where_it_is_cut(tmp_path):
    """pymavlink ends at the first type that it does not know."""
    whole = real("ardusub/small.BIN").read_bytes()
    expected = len(read(real("ardusub/small.BIN"), "ardusub_vectored").channels["phi"].t)
    (tmp_path / "a.BIN").write_bytes(whole[:100_000] + b"\xa3\x95\x01" + bytes(300) + whole[100_000:-7])
    log = read(tmp_path / "a.BIN", "ardusub_vectored")
    said = {f.code: f.detail for f in log.findings}
    assert said["cut_file"].startswith("7,5") and "s after the start" in said["cut_file"] and "bytes in 1 place " in said["damaged_file"]
    assert expected - 3 <= len(log.channels["phi"].t) <= expected
    assert packets(whole).findings("x") == [] and packets(whole + bytes(200)).findings("x") == [], "a last page is filled up"


def test_a_damaged_format_costs_the_messages_of_its_type_alone(tmp_path):
    """pymavlink gave the whole log up: list index out of range."""
    whole = bytearray(real("ardusub/small.BIN").read_bytes())
    at = next(k for k in range(len(whole)) if whole[k : k + 3] == b"\xa3\x95\x80" and whole[k + 5 : k + 8] == b"MAG")
    whole[at + 9] = ord("?")  # a letter of its format
    (tmp_path / "a.BIN").write_bytes(whole)
    log, expected = read(tmp_path / "a.BIN", "ardusub_vectored"), read(real("ardusub/small.BIN"), "ardusub_vectored")
    assert "no whole packet" in next(f.detail for f in log.findings if f.code == "damaged_file")
    assert len(log.channels["phi"].t) > 0.5 * len(expected.channels["phi"].t) and set(log.channels) == set(expected.channels)
