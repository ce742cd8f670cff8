"""Profiles: every built-in one loads, every fault of one is named at once, nothing is guessed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import rovval.ingest as ingest
from rovval import vehicle
from rovval.core.channels import channel
from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest.inspection.inspect import inspect
from rovval.ingest.profile import ATTITUDE, load_profile, parse_profile, profiles


def table(**more):
    base = {
        "name": "mine", "description": "", "format": "csv_log", "frame": "fsd", "world": "ned",
        "time": {"kind": "elapsed", "columns": ["t"], "unit": "s"}, "channels": {"u": {"column": "vx", "unit": "m/s"}},
    }  # fmt: skip
    return base | more


@pytest.mark.parametrize("name", profiles())
def test_every_built_in_profile_loads(name):
    profile = load_profile(name)
    assert profile.name == name and profile.description
    assert profile.format in ingest.readers()
    assert not profile.vehicle or vehicle.load(profile.vehicle).name == profile.vehicle
    for mapped in profile.channels:
        if mapped != ATTITUDE:
            channel(mapped)


@pytest.mark.parametrize("name", ingest.readers())
def test_every_reader_keeps_its_contract(name):
    module = ingest.reader(name)
    assert module.SUFFIXES and all(s == "" or s.startswith(".") for s in module.SUFFIXES)
    assert all(callable(getattr(module, f)) for f in ("sniff", "missing", "read", "contents"))
    assert module.__doc__


def test_nothing_heavy_is_imported_before_a_log_is_read():
    import subprocess
    import sys

    code = "import sys, rovval.ingest as i; [i.reader(n) for n in i.readers()]; print([m for m in ('polars','rosbags','pymavlink','mcap') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"


def test_a_channel_without_unit_is_refused_by_name():
    with pytest.raises(UsageProblem, match="channel 'u': states no unit; nothing is guessed"):
        parse_profile(table(channels={"u": {"column": "vx"}}), "x")


def test_every_problem_is_named_at_once():
    wrong = {
        "u": {"column": "vx", "unit": "furlong"},
        "speed": {"column": "v", "unit": "m/s"},
        "w": {"column": "vz", "topic": "/a", "unit": "m/s"},
        "n:*": {"column": "rpm", "unit": "rpm"},
        "z": {"column": "d", "unit": "m", "span": 0.0},
        "x": {"column": "lat", "unit": "degree_latitude"},
        "psi": {"column": "hdg", "unit": "deg"},
    }
    with pytest.raises(UsageProblem) as refused:
        parse_profile(table(channels=wrong, frame="flu", time={"kind": "time_of_day", "columns": ["h", "m"]}), "x")
    text = str(refused.value)
    for word in ("furlong", "'speed'", "exactly one of", "needs one *", "span", "go together", "flu", "time_of_day needs"):
        assert word in text, word


def test_unknown_keys_are_refused():
    with pytest.raises(UsageProblem, match="colour"):
        parse_profile(table(colour="blue"), "x")


def test_unknown_profile_and_broken_file(tmp_path):
    with pytest.raises(UsageProblem, match=r"(?s)unknown profile 'marlin'.*merlin"):
        load_profile("marlin")
    path = tmp_path / "p.toml"
    path.write_text("name = ")
    with pytest.raises(UsageProblem, match="not readable as TOML"):
        load_profile(path)


def test_the_digest_follows_what_a_profile_does_not_its_words():
    one = parse_profile(table(), "x")
    assert one.sha256 == parse_profile(table(notes="more"), "x").sha256
    assert one.sha256 != parse_profile(table(channels={"u": {"column": "vx", "unit": "cm/s"}}), "x").sha256


def test_sign_zero_span_missing_and_rules(tmp_path):
    profile = table(
        channels={
            "u": {"column": "vx", "unit": "cm/s", "sign": -1, "longest_gap_s": 2.0, "resampling": "hold", "stuck_s": 5.0},
            "stick:surge": {"column": "ch5", "unit": "1", "zero": 1500, "span": 400, "missing": [65535]},
        }
    )
    path = tmp_path / "p.csv"
    path.write_text("t,vx,ch5\n0,100,1900\n0.1,200,65535\n0.2,300,1100\n")
    raw = ingest.reader("csv_log").read(path, parse_profile(profile, "x"))
    assert np.allclose(raw.channels["u"].values, [-1, -2, -3])
    assert np.allclose(raw.channels["stick:surge"].values, [1, -1]) and np.allclose(raw.channels["stick:surge"].t, [0, 0.2])
    assert raw.rules["u"].longest_gap_s == 2.0 and raw.rules["u"].resampling == "hold" and raw.rules["u"].stuck_s == 5.0


def test_velocity_along_world_axes_is_turned_into_the_body(tmp_path):
    """Heading east, moving east: all of it is surge."""
    profile = table(
        frame="flu", world="enu",
        channels={
            "attitude": {"columns": ["qw", "qx", "qy", "qz"], "unit": "quaternion"},
            **{n: {"column": f"v{n}", "unit": "m/s", "frame": "world"} for n in "uvw"},
        },
    )  # fmt: skip
    path = tmp_path / "p.csv"
    path.write_text("t,qw,qx,qy,qz,vu,vv,vw\n" + "".join(f"{i},1,0,0,0,2.0,0.5,0.25\n" for i in range(3)))
    c = ingest.reader("csv_log").read(path, parse_profile(profile, "x")).channels
    assert np.allclose(c["psi"].values, np.pi / 2)
    assert np.allclose([c[n].values[0] for n in "uvw"], [2.0, -0.5, -0.25])


def test_a_log_that_fits_several_profiles_is_refused_with_their_names(tmp_path, monkeypatch):
    path = tmp_path / "p.csv"
    path.write_text("t,vx\n0,1\n1,2\n")
    monkeypatch.setattr(ingest, "profiles", lambda: ("one", "two"))
    monkeypatch.setattr(ingest, "load_profile", lambda n: parse_profile(table(name=n), n))
    with pytest.raises(BadInput, match="fits several profiles: one, two"):
        ingest.read(path)


@pytest.mark.parametrize(("pitch", "fits"), [([-34.1, -20.0, -7.4, 12.0, 8.0, -9.0], "degrees"), ([-0.3, 0.1, 0.2, 0.4, -0.1, 0.0], None)])
def test_of_profiles_in_other_units_the_one_that_suits_the_values_is_taken(pitch, fits, tmp_path, monkeypatch):
    """Tens of radians of pitch are none; tenths of a degree may be."""
    path = tmp_path / "p.csv"
    path.write_text("t,pitch\n" + "".join(f"{0.1 * i},{value}\n" for i, value in enumerate(pitch)))
    units = {"radians": "rad", "degrees": "deg"}
    monkeypatch.setattr(ingest, "profiles", lambda: tuple(units))
    monkeypatch.setattr(ingest, "load_profile", lambda n: parse_profile(table(name=n, channels={"theta": {"column": "pitch", "unit": units[n]}}), n))
    found = inspect(path)
    if fits:
        assert ingest.read(path).profile == fits and found.fits == (fits,)
        assert found.lacking["radians"] == ("theta within -7 to 7 rad (holds -34.1 to 12)",)
    else:
        assert set(found.fits) == set(units)
        with pytest.raises(BadInput, match="fits several profiles"):
            ingest.read(path)


def test_several_names_of_a_topic_are_for_bags():
    several = {"u": {"topic": ["XKF1", "NKF1"], "field": "VN", "unit": "m/s"}}
    with pytest.raises(UsageProblem, match="a list of topics is for bags; autopilot takes one name"):
        parse_profile(table(format="autopilot", time={"kind": "elapsed", "columns": ["t"], "unit": "s"}, channels=several), "test")


UNSIGNED: dict[str, Any] = {
    "name": "esc",
    "description": "ESC telemetry",
    "format": "csv_log",
    "frame": "fsd",
    "world": "ned",
    "time": {"kind": "elapsed", "columns": ["t"]},
    "channels": {
        "u": {"column": "u", "unit": "m/s"},
        "n:*": {"column": "rpm_*", "unit": "rpm", "sign_from": "pwm"},
        "pwm:*": {"column": "pwm_*", "unit": "pwm_us"},
    },
}


def test_a_speed_without_sign_takes_that_of_its_command(tmp_path):
    """About the neutral of 1500 us; at neutral the shaft coasts on with the sign that it had."""
    profile = parse_profile(UNSIGNED, "test")
    pwm = [1500, 1600, 1600, 1500, 1400, 1400, 1500, 1600]
    rows = [f"{0.1 * i:.1f},0,{100 + i},{p}" for i, p in enumerate(pwm)]
    path = tmp_path / "esc.csv"
    path.write_text("\n".join(["t,u,rpm_A,pwm_A", *rows]) + "\n")
    raw = ingest.reader("csv_log").read(path, profile)
    assert np.array_equal(np.sign(raw.channels["n:A"].values), [1, 1, 1, 1, -1, -1, -1, 1])
    assert np.allclose(np.abs(raw.channels["n:A"].values) * 60, 100 + np.arange(8))
    assert [f.where for f in raw.findings if f.code == "sign_from_command"] == ["n:A"]


def test_a_speed_without_sign_needs_its_command(tmp_path):
    path = tmp_path / "esc.csv"
    path.write_text("t,u,rpm_A,rpm_B,pwm_A\n0.0,0,1,1,1500\n0.1,0,1,1,1500\n")
    with pytest.raises(BadInput, match="n:B takes its sign from pwm:B"):
        ingest.reader("csv_log").read(path, parse_profile(UNSIGNED, "test"))
    channels = {k: v for k, v in UNSIGNED["channels"].items() if k != "pwm:*"}
    with pytest.raises(UsageProblem, match="no channel pwm:THRUSTER is mapped"):
        parse_profile(UNSIGNED | {"channels": channels}, "test")
    with pytest.raises(UsageProblem, match="sign_from is for measured thruster speeds"):
        parse_profile(UNSIGNED | {"channels": UNSIGNED["channels"] | {"u": {"column": "u", "unit": "m/s", "sign_from": "pwm"}}}, "test")
