"""A proposed profile: it reads the log that it was made from, right where names and units say it all, and marked where they do not."""

from __future__ import annotations

import json
import tomllib

import numpy as np
import pytest
from bag_case import write
from german_dive import german
from log_files import CASES, ulog
from merlin_case import columns as merlin_columns
from merlin_case import text as csv_text
from real_data import real
from typer.testing import CliRunner

from rovval import ingest
from rovval.cli.app import app
from rovval.core.errors import BadInput
from rovval.ingest.inspection.inspect import inspect
from rovval.ingest.inspection.names import channel_guess, unit_said, words
from rovval.ingest.inspection.proposal import proposed
from rovval.ingest.profile import parse_profile
from rovval.report.inspection import document, page


def table(path):
    text = proposed(inspect(path), "mine")
    return text, parse_profile(tomllib.loads(text), "mine")


@pytest.mark.parametrize(
    ("name", "channel", "unit"),
    [
        ("LinVelX", "u", None), ("AngVelZ [deg/s]", "r", "deg/s"), ("Roll (deg)", "phi", "deg"), ("yaw_rate", "r", None), ("Tiefe [m]", "z", "m"),
        ("Kurs [°]", "psi", "deg"), ("v_north_mps", "u", "m/s"), ("vel_port", "v", None), ("dvl.altitude", "altitude", None), ("rpm_HFP", "n", "rpm"),
        ("HFP_rpm_cmd", "n_cmd", "rpm"), ("servo3_raw", "pwm", None), ("joystick_surge", "stick:surge", None), ("Latitude", "x", None),
        ("batt_volt", "voltage", "V"),
        ("gyro_x", "p", None), ("Drehzahl BB [1/min]", "n", "rpm"), ("speed_ahead", "u", None), ("w_mps", "w", "m/s"), ("pos_x_m", "x", "m"),
        ("AngVelX", "p", None), ("HFP_PV", "n", None), ("HFP_SP", "n_cmd", None),
        ("theta_dot", "q", None),
    ],
)  # fmt: skip
def test_names_that_people_use(name, channel, unit):
    assert unit_said(name, "") == unit
    guess = channel_guess(words(name), unit)
    assert guess is not None and guess.channel == channel
    assert guess.world == ("north" in name) and guess.against == ("port" in name)


@pytest.mark.parametrize("name", ["Modus", "heading_setpoint", "linear_acceleration.x", "pose.covariance[0]", "temperature", "error_flags"])
def test_names_that_say_no_channel(name):
    assert channel_guess(words(name), None) is None


def test_a_german_table(tmp_path):
    path = german(tmp_path / "dive.csv")
    text, profile = table(path)
    raw = ingest.reader("csv_log").read(path, profile)
    assert {n: s.unit for n, s in profile.channels.items()} == {"z": "m", "psi": "deg", "u": "knot", "n:*": "rpm"}
    assert np.isclose(raw.channels["u"].values[0], 0.5 * 1852 / 3600) and np.isclose(raw.channels["n:BB"].values[0], -1250.5 / 60)
    assert profile.draft and next(f.code for f in raw.findings) == "draft_profile"
    assert "Modus: text" in text.split("Left over")[1]


def test_angles_that_do_not_say_their_unit_are_as_their_neighbours(tmp_path):
    """Roll within 3 is degrees where the heading beside it goes to 350, and may be radians where it is alone; either way it is for review."""
    rows = [(i / 10, 350 - i, 2.6 - i / 10, i % 3) for i in range(50)]
    for columns, unit in ((("t", "Heading", "Roll", "RollRate"), "deg"), (("t", "Modus", "Roll", "RollRate"), "rad")):
        (tmp_path / "a.csv").write_text("\n".join([",".join(columns), *(",".join(map(repr, row)) for row in rows)]) + "\n")
        text, profile = table(tmp_path / "a.csv")
        assert (profile.channels["phi"].unit, profile.channels["p"].unit) == (unit, f"{unit}/s")
        assert all("REVIEW channel and unit" in line for line in text.splitlines() if line.startswith(("phi =", "p =")))


def test_every_line_that_the_log_does_not_say_itself_is_marked(tmp_path):
    (tmp_path / "a.csv").write_text("t,heading,depth_m,left_vel,odd,still\n" + "".join(f"{i / 10},{350 - i},{i / 9},{i / 50},{i % 3},7\n" for i in range(50)))
    text, profile = table(tmp_path / "a.csv")
    lines = {line.split(" ")[0]: line for line in text.splitlines()}
    for key in ("frame", "world", "vehicle", "psi", "z", "v"):
        assert "REVIEW" in lines[key], key
    assert profile.channels["v"].sign == -1 and "its sign" in lines["v"] and "350" in lines["psi"]
    left = text.split("Left over")[1]
    assert "odd: 0 to 2" in left and "of one value always: still" in left


def test_a_bag_of_standard_messages(tmp_path):
    """The built-in profile for it put aside: what the types define, and the thrusters by their topics."""
    path = write("bag", tmp_path / "a.bag")
    found = inspect(path)
    alone = type(found)(found.path, found.format, found.contents, {}, (), {})
    text = proposed(alone, "mine")
    profile = parse_profile(tomllib.loads(text), "mine")
    raw, known = (ingest.reader("ros_bag").read(path, p) for p in (profile, ingest.load_profile("ros_odometry")))
    assert raw.channels.keys() == known.channels.keys() and "n:T1" in raw.channels
    for name in known.channels:
        assert np.array_equal(raw.channels[name].values, known.channels[name].values), name


def test_a_log_that_a_built_in_profile_reads_is_said_to_be():
    text = proposed(inspect(real("bluerov2_tank/run_a.csv")), "mine")
    assert "bluerov2_tank reads this log as it is" in text and not tomllib.loads(text).get("draft")


def test_check_shows_rows_in_si_and_what_is_left(tmp_path):
    path = german(tmp_path / "dive.csv")
    run = CliRunner()
    done = run.invoke(app, ["profile", "propose", str(path)])
    assert done.exit_code == 0 and "marked REVIEW" in done.stderr
    (tmp_path / "mine.toml").write_text(done.stdout, encoding="utf-8")
    page = run.invoke(app, ["profile", "check", str(tmp_path / "mine.toml"), str(path)])
    assert page.exit_code == 0 and "2024-05-03 14:03:00 UTC" in page.stdout and "draft_profile" in page.stdout and "Modus" in page.stdout
    done = run.invoke(app, ["profile", "check", str(tmp_path / "mine.toml"), str(path), "--json", "--timezone", "Europe/Berlin"])
    document = json.loads(done.stdout)
    assert document["left_over"] == [["", "Modus"]] and document["channels"]["z"]["first"] == [2.5, 2.51, 2.52, 2.53]
    assert document["t0_ns"] == 1714737780 * 10**9  # 12:03 UTC


@pytest.mark.parametrize("form", ["csv.gz", "xlsx", "parquet", "mat v5", "hdf5"])
def test_check_of_a_profile_for_csv_takes_every_table(form, tmp_path):
    """A workbook was refused as binary, though `rovval compare` reads it by the same profile."""
    write_log, _ = CASES[form]
    done = CliRunner().invoke(app, ["profile", "check", "merlin", str(write_log(tmp_path)), "--json"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["channels"]["u"]["samples"] == (60 if form == "xlsx" else 300)


@pytest.mark.parametrize("command", [("inspect",), ("profile", "propose"), ("profile", "check", "merlin")])
def test_a_dive_file_is_said_to_be_several_logs(command, tmp_path):
    write_log, _ = CASES["csv"]
    path = write_log(tmp_path)
    (tmp_path / "dive.toml").write_text('[[log]]\nfile = "a.csv"\nprofile = "merlin"\n', encoding="utf-8")
    done = CliRunner().invoke(app, [*command, str(tmp_path / "dive.toml")])
    assert isinstance(done.exception, BadInput) and str(path) in done.exception.hint


def test_check_refuses_a_log_that_the_profile_does_not_read(tmp_path):
    done = CliRunner().invoke(app, ["profile", "check", "merlin", str(german(tmp_path / "dive.csv"))])
    assert done.exit_code != 0 and "AngVelX" in str(done.exception)


def test_a_damaged_header_makes_no_damaged_profile(tmp_path):
    """Control characters would end the TOML's comment; dates that are none are no stamps."""
    head, *rows = german(tmp_path / "dive.csv").read_text(encoding="utf-8").splitlines()[1:]
    spoilt = [head.replace("Tiefe", "Tie\x0ffe\x7f"), *(row.replace("03.05.2024", "43.05.2024") for row in rows)]
    (tmp_path / "spoilt.csv").write_text("\n".join(spoilt) + "\n", encoding="utf-8")
    text, profile = table(tmp_path / "spoilt.csv")
    assert "u" in profile.channels and "no column rises" in text


@pytest.mark.slow
def test_a_mutated_table_is_inspected_or_refused(tmp_path):
    """Bytes changed, lost, doubled and cut, 300 times: a page and a profile that TOML reads, or a refusal."""
    rng = np.random.default_rng(7)
    whole = german(tmp_path / "dive.csv").read_bytes()
    read = 0
    for _ in range(300):
        spoilt = bytearray(whole)
        for _ in range(rng.integers(1, 20)):
            at = int(rng.integers(len(spoilt)))
            kind = rng.integers(4)
            other = [bytes(rng.integers(0, 256, 3, dtype=np.uint8)), b";;\n\n", b"", spoilt[at:] * 2][kind]
            spoilt[at : at + (0 if kind == 1 else int(rng.integers(1, 30)))] = other
            spoilt = spoilt[:20_000]
        (tmp_path / "spoilt.csv").write_bytes(spoilt)
        try:
            found = inspect(tmp_path / "spoilt.csv")
        except BadInput:
            continue
        json.dumps(document(found), allow_nan=False)
        assert page(found) and tomllib.loads(proposed(found, "mine"))
        read += 1
    assert read > 30


def test_a_log_of_px4_is_proposed_by_what_its_messages_are_defined_to_be(tmp_path):
    """Attitude as a quaternion, velocities along the world: nothing of it is a guess but the thrusters."""
    path = ulog(tmp_path / "dive.ulg")
    text, profile = table(path)
    raw = ingest.reader("ulog").read(path, profile)
    assert raw.channels["psi"].values == pytest.approx(np.pi / 2, abs=1e-6), "heads east"
    assert raw.channels["v"].values == pytest.approx(-0.5, abs=1e-6), "and moves north: to port"
    assert [line.partition(" ")[0] for line in text.splitlines() if "REVIEW" in line][2:] == ['"n:T1"', '"n:T2"']


def test_a_log_that_a_built_in_profile_reads_is_proposed_under_the_name_asked_for():
    text, profile = table(real("ardusub/small.BIN"))
    assert profile.name == "mine" and profile.ardusub_frame == "vectored" and "ardusub_vectored reads this log" in text


def test_a_column_of_notes_is_proposed_as_markers(tmp_path):
    cells = merlin_columns(60) | {"Note": ["", "lap"] * 30}
    (tmp_path / "dive.csv").write_text(csv_text({n.replace("Depth", "Tiefe"): c for n, c in cells.items()}))
    profile = table(tmp_path / "dive.csv")[1]
    assert profile.markers is not None and profile.markers.column == "Note"
