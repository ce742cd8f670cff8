"""ArduSub logs: a written .tlog comes back, the published fixtures read, damage and a missing package are one refusal each."""

from __future__ import annotations

import gc
import struct
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from real_data import real

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.storage.archive import open_run

START_S = 1_700_000_000


HEAVY = {"FRAME_CONFIG": 2.0, **{f"MOT_{i}_DIRECTION": 1.0 for i in range(1, 9)}}


def tlog(path, n=200, velocity=(0.0, 0.5, 0.1), damage=0, parameters=HEAVY):
    """Heading east at 0.5 m/s: all of it is surge; the ground station stamps 40 ms after the autopilot, jittered."""
    from pymavlink.dialects.v20 import ardupilotmega as m

    link = m.MAVLink(None, srcSystem=1, srcComponent=1)
    rng = np.random.default_rng(0)
    with path.open("wb") as file:
        for k, (name, value) in enumerate(parameters.items()):
            message = m.MAVLink_param_value_message(name.encode(), value, 9, len(parameters), k)
            file.write(struct.pack(">Q", int(START_S * 1e6)) + message.pack(link))
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


@pytest.mark.parametrize(("name", "profile"), [("small.BIN", "ardusub_vectored"), ("small.tlog", "ardusub_tlog"), ("2023-04-18_11-03-34.tlog", "ardusub_tlog")])
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


def test_a_log_that_fails_while_it_is_opened_is_refused_and_closed(tmp_path):
    """The units of a message's fields name more fields than it has: pymavlink fails while it still looks at the map of the file."""
    formats = [(128, 89, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns"), (201, 44, b"FMTU", b"QBNN", b"TimeUS,FmtType,UnitIds,MultIds")]
    packets = [b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", *one) for one in formats]
    path = tmp_path / "a.bin"
    path.write_bytes(b"".join(packets) + b"\xa3\x95\xc9" + struct.pack("<QB16s16s", 0, 128, b"-" * 15 + b"#", b""))
    with pytest.raises(BadInput, match=r"a\.bin: damaged or foreign"), warnings.catch_warnings():
        warnings.simplefilter("error")
        read(path, "ardusub")
    gc.collect()
    assert not [name for name in Path("/proc/self/fd").iterdir() if str(name.resolve()).endswith("a.bin")]


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


def test_motors_that_turn_against_the_frame_are_turned_back(tmp_path):
    """MOT_n_DIRECTION was not read: of a vehicle's four upright motors two pushed against the others, to the microsecond."""
    turned = HEAVY | {"MOT_2_DIRECTION": -1.0, "MOT_7_DIRECTION": -1.0, "MOT_8_DIRECTION": -1.0}
    run = open_run(tlog(tmp_path / "a.tlog", parameters=turned))
    assert (run.values["pwm:T2"] == 1400).all() and (run.values["pwm:T3"] == 1400).all() and (run.values["pwm:T7"] == 1100).all()
    assert "pwm:T8" not in run.values, "an output that is 0 is missing, turned or not"
    (finding,) = (f for f in run.findings if f.code == "motor_direction")
    assert finding.where == "pwm:T2, pwm:T7, pwm:T8" and "turned about 1500 us" in finding.detail


def test_unknown_directions_are_said(tmp_path):
    run = open_run(tlog(tmp_path / "a.tlog", parameters={"FRAME_CONFIG": 2.0}))
    (finding,) = (f for f in run.findings if f.code == "motor_direction")
    assert "does not hold MOT_n_DIRECTION" in finding.detail and (run.values["pwm:T2"] == 1600).all()


def test_the_frame_says_which_vehicle_it_is(tmp_path):
    """The log of a six-thruster vehicle was read as one of eight, and refused when it was compared."""
    six = tlog(tmp_path / "six.tlog", parameters=HEAVY | {"FRAME_CONFIG": 1.0})
    assert open_run(six).profile == "ardusub_vectored_tlog" and open_run(six).vehicle == "bluerov2"
    with pytest.raises(BadInput, match=r"FRAME_CONFIG = 2 \(vectored_6dof\); the log's vehicle has 1 \(vectored\)"):
        read(six, "ardusub_tlog")
    with pytest.raises(BadInput, match="fits no built-in profile"):
        read(tlog(tmp_path / "other.tlog", parameters=HEAVY | {"FRAME_CONFIG": 4.0}))
    with pytest.raises(BadInput, match="fits several profiles: ardusub_tlog, ardusub_vectored_tlog"):
        read(tlog(tmp_path / "unknown.tlog", parameters={}))


@pytest.mark.slow
def test_the_upright_motors_of_a_published_log_push_together():
    """Outputs 5 to 8 of 200 us each: they cancelled to the last microsecond, so that heave had no input."""
    run = open_run(real("ardusub/small.tlog"))
    pulses = run.stack(tuple(f"pwm:T{i}" for i in (5, 6, 7, 8))) - 1500.0
    as_logged = pulses * np.array([-1, 1, 1, -1])
    assert np.nanmax(np.abs(as_logged.sum(axis=1))) == 0.0 and np.nanmax(np.abs(pulses.sum(axis=1))) == 800.0
    assert [f.where for f in run.findings if f.code == "motor_direction"] == ["pwm:T1, pwm:T2, pwm:T5, pwm:T8"]
