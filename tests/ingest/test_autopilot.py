"""ArduSub logs: a written .tlog comes back, the published fixtures read, damage and a missing package are one refusal each."""

from __future__ import annotations

import struct
import sys

import numpy as np
import pytest
from real_data import real

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.storage.archive import open_run

START_S = 1_700_000_000


def tlog(path, n=200, velocity=(0.0, 0.5, 0.1), damage=0):
    """Heading east at 0.5 m/s: all of it is surge; the ground station stamps 40 ms after the autopilot, jittered."""
    from pymavlink.dialects.v20 import ardupilotmega as m

    link = m.MAVLink(None, srcSystem=1, srcComponent=1)
    rng = np.random.default_rng(0)
    with path.open("wb") as file:
        for i in range(n):
            boot = 5000 + i * 100
            out = [
                m.MAVLink_attitude_message(boot, 0.0, 0.0, np.pi / 2, 0.01, 0.02, 0.0),
                m.MAVLink_local_position_ned_message(boot, 0.0, 0.05 * i, 3.0, *velocity),
                m.MAVLink_global_position_int_message(boot, 0, 0, 0, -3000, 0, 50, 10, 0),
                m.MAVLink_servo_output_raw_message(boot * 1000, 0, 1500, 1600, 1400, 1500, 1500, 1500, 1900, 0),
            ]
            stamp = int((START_S + i * 0.1 + 0.04 + rng.uniform(-0.005, 0.005)) * 1e6)
            for message in out:
                file.write(struct.pack(">Q", stamp) + message.pack(link))
            if i < damage:
                file.write(struct.pack(">Q", stamp) + b"\xfd\x00garbage")
    return path


def test_telemetry_is_read_on_the_autopilots_clock(tmp_path):
    run = open_run(tlog(tmp_path / "a.tlog"))
    assert run.profile == "ardusub_tlog" and run.vehicle == "bluerov2_heavy" and len(run) == 200
    assert run.clock.stamp == "header" and run.clock.matched == run.clock.samples
    assert run.t0_ns is not None and abs(run.t0_ns / 1e9 - (START_S + 0.04)) < 0.005
    assert np.allclose(run.values["u"], 0.5) and np.allclose(run.values["v"], 0.0, atol=1e-6) and np.allclose(run.values["w"], 0.1)
    assert np.allclose(run.values["z"], 3.0) and np.allclose(run.values["p"], 0.01)
    assert (run.values["pwm:T2"] == 1600).all() and "pwm:T8" not in run.values


def test_damaged_packets_are_left_out_and_said(tmp_path):
    raw = read(tlog(tmp_path / "a.tlog", damage=5))
    assert len(raw.channels["u"].t) > 150 and raw.findings


@pytest.mark.parametrize(("name", "profile"), [("small.BIN", "ardusub"), ("small.tlog", "ardusub_tlog"), ("2023-04-18_11-03-34.tlog", "ardusub_tlog")])
def test_published_logs_read(name, profile):
    run = open_run(real(f"ardusub/{name}"))
    assert run.profile == profile and run.ok("phi").mean() > 0.98
    assert abs(np.nanmean(run.values["phi"])) < 0.1 and 1400 < np.nanmean(run.values["pwm:T1"]) < 1600
    assert (run.t0_ns is None) == (name == "small.BIN")
    assert any(f.code == "bad_packet" for f in run.findings) == name.endswith("tlog")


@pytest.mark.parametrize("name", ["small.BIN", "small.tlog"])
def test_cut_and_flipped_logs_never_give_a_traceback(name, tmp_path, capsys):
    whole = real(f"ardusub/{name}").read_bytes()[:300_000]
    rng = np.random.default_rng(4)
    spoiled = np.frombuffer(whole, dtype=np.uint8).copy()
    spoiled[rng.integers(200, len(whole), 60)] ^= 0xFF
    for i, content in enumerate((whole[: len(whole) // 2], whole[:50], spoiled.tobytes())):
        path = tmp_path / f"{i}{name[-5:].lower() if name.endswith('tlog') else '.bin'}"
        path.write_bytes(content)
        try:
            read(path)
        except BadInput as refused:
            assert refused.hint and str(path) in refused.message
    assert capsys.readouterr().out == ""


def test_without_pymavlink_it_says_how_to_get_it(tmp_path, monkeypatch):
    path = tlog(tmp_path / "a.tlog", n=3)
    monkeypatch.setitem(sys.modules, "pymavlink", None)
    with pytest.raises(UsageProblem, match=r"needs pymavlink") as refused:
        read(path)
    assert "rovval[autopilot]" in refused.value.hint


def test_missing_messages_are_named(tmp_path):
    with pytest.raises(BadInput, match="ATT") as refused:
        read(tlog(tmp_path / "a.tlog", n=5), "ardusub")
    assert all(kind in refused.value.message for kind in ("XKF1", "ATT", "RCOU"))
