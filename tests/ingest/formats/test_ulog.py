"""PX4's .ulg: written by pyulog out of a file that is spelled out here by the published format."""

from __future__ import annotations

import random
import sys

import numpy as np
import pytest
from log_files import N, ulog

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.ingest.formats.ulog import contents

PROFILE = """
name = "px4"
description = "of the tests"
format = "ulog"
frame = "fsd"
world = "ned"
[time]
kind = "header"
[channels]
attitude = { topic = "vehicle_attitude", field = "q", unit = "quaternion" }
u = { topic = "vehicle_local_position", field = "vx", unit = "m/s", frame = "world" }
v = { topic = "vehicle_local_position", field = "vy", unit = "m/s", frame = "world" }
w = { topic = "vehicle_local_position", field = "vz", unit = "m/s", frame = "world" }
"n:T1" = { topic = "esc_status[1]", field = "rpm[0]", unit = "rpm" }
"""


@pytest.fixture
def profile(tmp_path) -> str:
    (tmp_path / "px4.toml").write_text(PROFILE)
    return str(tmp_path / "px4.toml")


def test_messages_instances_and_axes(tmp_path, profile):
    log = read(ulog(tmp_path / "dive.ulg"), profile)
    assert log.channels["psi"].values == pytest.approx(np.pi / 2, abs=1e-6) and log.channels["psi"].t == pytest.approx(np.arange(N) / 10)
    assert log.channels["v"].values == pytest.approx(-0.5, abs=1e-6) and log.channels["w"].values == pytest.approx(0.1)
    assert log.channels["n:T1"].values == pytest.approx(np.arange(N)) and log.t0_ns is None and log.findings == ()


def test_all_that_it_holds(tmp_path):
    blocks = {b.topic: b for b in contents(ulog(tmp_path / "dive.ulg")) if b.topic}
    assert set(blocks) == {"vehicle_attitude", "vehicle_local_position", "esc_status", "esc_status[1]"}
    assert list(blocks["vehicle_attitude"].numbers) == ["q[0]", "q[1]", "q[2]", "q[3]"] and blocks["esc_status"].clocks["header"][0] == 5.0


def test_what_is_missing_is_named(tmp_path):
    (tmp_path / "px4.toml").write_text(PROFILE.replace("esc_status[1]", "esc_report").replace('"vx"', '"v_x"'))
    with pytest.raises(BadInput, match=r"(?s)'v_x'; it has: vx, vy, vz.*esc_report"):
        read(ulog(tmp_path / "dive.ulg"), str(tmp_path / "px4.toml"))


def test_a_cut_log_is_read_to_where_it_ends(tmp_path, profile):
    """It was read without a word."""
    path = ulog(tmp_path / "dive.ulg")
    path.write_bytes(path.read_bytes()[:-1000])
    log = read(path, profile)
    assert [f.code for f in log.findings] == ["cut_file"] and "ends in the middle of a message" in log.findings[0].detail
    assert 0.7 * N < len(log.channels["v"].t) < N


def test_messages_whose_definition_lost_its_stamp_are_left_out_and_said(tmp_path, profile):
    """A damaged definition ended in a KeyError."""
    path = ulog(tmp_path / "dive.ulg")
    whole = path.read_bytes()
    defined = whole.index(b"timestamp", whole.index(b"esc_status:"))
    path.write_bytes(whole[:defined] + b"timestomp" + whole[defined + 9 :])
    (finding,) = {f for b in contents(path) for f in b.findings if f.where.startswith("esc_status")}
    assert finding.code == "damaged" and "no timestamp" in finding.detail
    with pytest.raises(BadInput, match=r"esc_status"):
        read(path, profile)


def test_damage_gives_a_log_or_a_refusal(tmp_path, profile):
    path = ulog(tmp_path / "dive.ulg")
    whole, rng, read_some = path.read_bytes(), random.Random(0), 0
    for trial in range(40):
        content = bytearray(whole[: rng.randrange(len(whole))] if trial % 2 else whole)
        for _ in range(rng.randrange(5) if content else 0):
            content[rng.randrange(len(content))] = rng.randrange(256)
        path.write_bytes(content)
        try:
            read_some += bool(read(path, profile).channels)
        except BadInput as refusal:
            assert "dive.ulg" in str(refusal)
    assert read_some > 20


def test_without_pyulog(tmp_path, profile, monkeypatch):
    path = ulog(tmp_path / "dive.ulg")
    monkeypatch.setitem(sys.modules, "pyulog", None)
    with pytest.raises(UsageProblem, match="pyulog") as refusal:
        read(path, profile)
    assert "rovval[autopilot]" in refusal.value.hint
