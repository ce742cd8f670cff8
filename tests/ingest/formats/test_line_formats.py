"""Lines that devices send: a Doppler log's JSON and NMEA sentences, as published by Water Linked and as pynmeagps writes them."""

from __future__ import annotations

import gzip
import json
import sys
from datetime import UTC, datetime, time, timedelta

import numpy as np
import pytest
from pynmeagps import NMEAMessage

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.ingest.formats import json_lines, nmea

N, START_US = 100, 1_638_191_471_563_017


def velocity(i: int) -> str:
    """The example of the published protocol (velocity report, json_v3), with its own time and speed."""
    beams = [{"id": b, "velocity": 0.1, "distance": 0.6, "rssi": -30.0, "nsd": -90.0, "beam_valid": True} for b in range(4)]
    valid = i % 10 != 7
    report = {
        "time": 106.4, "vx": 0.01 * i if valid else 0, "vy": -0.02, "vz": 0.005, "fom": 0.002, "covariance": [[1e-6, 0, 0], [0, 1e-6, 0], [0, 0, 1e-6]],
        "altitude": 0.5 if valid else -1, "transducers": beams, "velocity_valid": valid, "status": 0, "format": "json_v3", "type": "velocity",
        "time_of_validity": START_US + 100_000 * i, "time_of_transmission": START_US + 100_000 * i + 60_000,
    }  # fmt: skip
    return json.dumps(report)


def position(i: int) -> str:
    at = (START_US + 200_000 * i) * 1e-6
    pose = {"x": 0.1 * i, "y": 0.0, "z": 2.0, "std": 0.01, "roll": 1.0, "pitch": 0.0, "yaw": 90.0}
    return json.dumps({"ts": at, **pose, "type": "position_local", "status": 0, "format": "json_v3"})


@pytest.fixture
def dvl(tmp_path):
    lines = [line for i in range(N) for line in ([velocity(i), position(i // 2)] if i % 2 == 0 else [velocity(i)])]
    path = tmp_path / "dvl.jsonl"
    path.write_text("\n".join([*lines, velocity(N)[:50]]))
    return path


def test_a_doppler_log_by_its_own_stamps(dvl):
    """A ping without bottom lock has no velocity, whatever number stands there; the last line is cut."""
    log = read(dvl)
    valid = np.array([i for i in range(N) if i % 10 != 7])
    assert log.profile == "dvl_a50" and log.t0_ns == pytest.approx(START_US * 1000, abs=1000)
    assert log.channels["u"].values == pytest.approx(0.01 * valid) and log.channels["u"].t == pytest.approx(0.1 * valid, abs=1e-6)
    assert set(log.channels["altitude"].values) == {0.5} and log.channels["psi"].values == pytest.approx(np.pi / 2)
    assert log.channels["x"].t == pytest.approx(0.2 * np.arange(N // 2), abs=1e-6)
    assert {f.code: f.detail.split()[0] for f in log.findings} == {"bad_line": "1", "no_bottom_lock": "10"}


def test_compressed_and_behind_a_logger_s_stamps(dvl):
    stamped = "\n".join(f"2021-11-29T13:11:{11 + i // 10:02d}.{i % 10}Z {velocity(i)}" for i in range(N - 50))
    packed = dvl.with_name("dvl.log.gz")
    packed.write_bytes(gzip.compress(stamped.encode()))
    block = next(b for b in json_lines.contents(packed) if b.topic == "velocity")
    assert block.clocks["record"][:2] == pytest.approx(datetime(2021, 11, 29, 13, 11, 11, tzinfo=UTC).timestamp() + np.array([0.0, 0.1]))
    assert read(packed).profile == "dvl_a50"


NMEA_PROFILE = """
name = "heading_and_depth"
description = "of the tests"
format = "nmea"
frame = "fsd"
world = "ned"
[time]
kind = "{kind}"
[channels]
psi = {{ topic = "HDT", field = "headingT", unit = "deg" }}
z = {{ topic = "DPT", field = "depth", unit = "m" }}
altitude = {{ topic = "DBT", field = "depthm", unit = "m", optional = true }}
"""


def sentence(kind: str, talker: str = "GP", **fields: object) -> str:
    return str(NMEAMessage(talker, kind, 0, **fields).serialize().decode().strip())


def sentences(prefix: bool) -> str:
    """Heading at 5 Hz and depth at 1 Hz behind a logger's stamps, or each second a moment, heading and depth."""
    start, lines = datetime(2026, 11, 23, 10, tzinfo=UTC), []
    for i in range(50):
        at = start + timedelta(seconds=0.2 * i if prefix else i)
        stamp = f"{at.timestamp():.3f} " if prefix else ""
        if not prefix:
            moment = time(at.hour, at.minute, at.second)
            lines.append(sentence("ZDA", time=moment, day=23, month=11, year=2026, ltzh="00", ltzn="00"))
        lines.append(stamp + sentence("HDT", "HE", headingT=350.0 + 0.2 * i, headingTu="T"))
        if i % 5 == 0 or not prefix:
            lines.append(stamp + sentence("DPT", "SD", depth=5.0 + 0.1 * i, offset=0.0, rangescale=100.0))
    heading = next(line for line in lines if "HDT" in line)
    lines.insert(9, heading.replace("$HEHDT,35", "$HEHDT,25"))  # a digit turned on the line
    return "\n".join(["# logger 1.2", *lines, "$HEHDT,35"])


@pytest.mark.parametrize("kind", ["record", "header"])
def test_heading_and_depth_of_sentences(tmp_path, kind):
    (tmp_path / "nmea.log").write_text(sentences(kind == "record"))
    (tmp_path / "own.toml").write_text(NMEA_PROFILE.format(kind=kind))
    log = read(tmp_path / "nmea.log", str(tmp_path / "own.toml"))
    step = 0.2 if kind == "record" else 1.0
    assert np.degrees(log.channels["psi"].values) % 360 == pytest.approx((350.0 + 0.2 * np.arange(50)) % 360)
    assert log.channels["psi"].t == pytest.approx(step * np.arange(50), abs=1e-6)
    assert log.channels["z"].values[0] == 5.0 and np.diff(log.channels["z"].t) == pytest.approx(1.0, abs=1e-6)
    assert log.t0_ns == datetime(2026, 11, 23, 10, tzinfo=UTC).timestamp() * 1e9
    assert [f.code for f in log.findings] == ["bad_checksum"] and log.findings[0].detail.startswith("2 sentences")


def test_two_talkers_of_one_kind_are_two_topics(tmp_path):
    (tmp_path / "a.nmea").write_text(sentences(True) + "\n" + "1795341600.000 " + sentence("HDT", "GP", headingT=1.0, headingTu="T"))
    assert {b.topic for b in nmea.contents(tmp_path / "a.nmea") if b.topic} == {"HEHDT", "GPHDT", "DPT"}


def test_a_last_line_that_is_cut_before_its_sentence_is_said(tmp_path):
    (tmp_path / "own.toml").write_text(NMEA_PROFILE.format(kind="record"))
    (tmp_path / "a.nmea").write_text(sentences(True).rpartition("\n")[0] + "\n179534")
    log = read(tmp_path / "a.nmea", str(tmp_path / "own.toml"))
    assert {f.code for f in log.findings} == {"bad_checksum", "cut_line"}


def test_stamps_that_are_too_coarse_and_none_at_all(tmp_path):
    (tmp_path / "own.toml").write_text(NMEA_PROFILE.format(kind="header"))
    (tmp_path / "a.nmea").write_text("\n".join(line.partition(" ")[2] for line in sentences(True).splitlines()))
    with pytest.raises(BadInput, match="takes stamps from header"):
        read(tmp_path / "a.nmea", str(tmp_path / "own.toml"))


def test_without_pynmeagps(tmp_path, monkeypatch):
    (tmp_path / "own.toml").write_text(NMEA_PROFILE.format(kind="record"))
    (tmp_path / "a.nmea").write_text(sentences(True))
    monkeypatch.setitem(sys.modules, "pynmeagps", None)
    with pytest.raises(UsageProblem, match="pynmeagps") as refusal:
        read(tmp_path / "a.nmea", str(tmp_path / "own.toml"))
    assert "rovval[nmea]" in refusal.value.hint
