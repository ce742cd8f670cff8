"""Several files of one dive become one run, each on its own clock; what cannot be brought together is refused with what is lacking."""

from __future__ import annotations

import json
from datetime import UTC, datetime, timedelta
from pathlib import Path

import merlin_case
import numpy as np
import pytest

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.ingest.files import sha256
from rovval.pipeline.planning.discover import logs_in
from rovval.storage.archive import open_run

PROFILE = """
name = "{name}"
description = "of the tests"
format = "csv_log"
frame = "fsd"
world = "ned"
{more}
[time]
{clock}
[channels]
{channels}
"""
ELAPSED = 'kind = "elapsed"\ncolumns = ["t"]'
ISO = 'kind = "datetime"\ncolumns = ["t"]'
SPEED = '"n:T1" = { column = "rpm", unit = "rpm" }'
VELOCITY = 'u = { column = "u", unit = "m/s" }'
START = datetime(2026, 11, 23, 10, tzinfo=UTC)


def profile(folder: Path, name: str, clock: str, channels: str, more: str = "") -> str:
    (folder / f"{name}.toml").write_text(PROFILE.format(name=name, clock=clock, channels=channels, more=more))
    return f"{name}.toml"


def table(path: Path, header: str, t: np.ndarray, values: np.ndarray, moment: bool = False) -> None:
    stamps = [(START + timedelta(seconds=float(s))).isoformat() if moment else f"{s:.3f}" for s in t]
    path.write_text("\n".join([f"t,{header}", *(f"{s},{v!r}" for s, v in zip(stamps, values.tolist(), strict=True))]))


@pytest.fixture
def folder(tmp_path):
    """Thruster speeds at 10 Hz and velocities at 5 Hz that begin 2 s later, of the wave u = sin(t); each counts from when it was switched on."""
    t = np.arange(0, 60, 0.1)
    table(tmp_path / "thrusters.csv", "rpm", 100.0 + t, 600 * np.sin(t))
    late = np.arange(2, 55, 0.2)
    table(tmp_path / "nav.csv", "u", 7.0 + late, np.sin(late))
    profile(tmp_path, "thr", ELAPSED, SPEED)
    profile(tmp_path, "nav", ELAPSED, VELOCITY)
    return tmp_path


def dive(folder: Path, *logs: str, head: str = "") -> Path:
    (folder / "dive.toml").write_text(head + "".join(f"[[log]]\n{log}\n" for log in logs))
    return folder / "dive.toml"


THRUSTERS = 'file = "thrusters.csv"\nprofile = "thr.toml"'
NAV = 'file = "nav.csv"\nprofile = "nav.toml"'


def test_each_clock_is_brought_onto_the_first(folder):
    path = dive(folder, THRUSTERS, f"{NAV}\noffset_s = 93.0")
    run = open_run(path)
    assert set(run.values) == {"n:T1", "u"} and run.profile == "dive" and run.id.startswith("dive-")
    there = ~np.isnan(run.values["u"])
    t = 0.1 * np.arange(len(run))
    assert t[there][0] == pytest.approx(2.0) and run.values["u"][there] == pytest.approx(np.sin(t[there]), abs=6e-3)  # linear between 5 Hz
    assert run.values["n:T1"] == pytest.approx(10 * np.sin(t))


def test_moments_need_no_offset_and_begins_gives_one(folder):
    late = np.arange(2, 55, 0.2)
    table(folder / "nav.csv", "u", late, np.sin(late), moment=True)
    profile(folder, "nav", ISO, VELOCITY)
    with pytest.raises(BadInput, match="unlike clocks") as refusal:
        read(dive(folder, THRUSTERS, NAV))
    assert "begins =" in refusal.value.hint
    log = read(dive(folder, f"{THRUSTERS}\nbegins = 2026-11-23T11:00:00+01:00", NAV))
    assert log.t0_ns == START.timestamp() * 1e9 and log.channels["u"].t[0] == pytest.approx(2.0, abs=1e-6)
    assert log.channels["n:T1"].t[:2] == pytest.approx([0.0, 0.1], abs=1e-6)


def test_clocks_that_nothing_joins_are_refused(folder):
    with pytest.raises(BadInput, match=r"clocks that nothing joins: nav.csv") as refusal:
        read(dive(folder, THRUSTERS, NAV))
    assert "offset_s" in refusal.value.hint
    with pytest.raises(BadInput, match="no moment in common"):
        read(dive(folder, THRUSTERS, f"{NAV}\noffset_s = 0.0"))


def test_a_split_recording_is_put_together(folder):
    lines = (folder / "thrusters.csv").read_text().splitlines()
    for part, rows in enumerate((lines[1:201], lines[201:], )):
        (folder / f"thr_{part}.csv").write_text("\n".join([lines[0], *rows]))
    whole = read(dive(folder, THRUSTERS, f"{NAV}\noffset_s = 93.0"))
    split = read(dive(folder, 'file = "thr_*.csv"\nprofile = "thr.toml"\noffset_s = 0.0', f"{NAV}\noffset_s = 93.0"))
    assert np.array_equal(split.channels["n:T1"].values, whole.channels["n:T1"].values)
    assert split.channels["n:T1"].t == pytest.approx(whole.channels["n:T1"].t)


def test_a_stretch_of_the_dive(folder):
    whole = read(dive(folder, THRUSTERS, f"{NAV}\noffset_s = 93.0"))
    part = read(dive(folder, THRUSTERS, f"{NAV}\noffset_s = 93.0", head="from_s = 10.0\nto_s = 30.0\n"))
    kept = (whole.channels["u"].t > 9.99) & (whole.channels["u"].t < 30.01)
    assert np.array_equal(part.channels["u"].values, whole.channels["u"].values[kept])
    assert part.channels["u"].t == pytest.approx(whole.channels["u"].t[kept] - 10.0) and part.channels["n:T1"].t[[0, -1]] == pytest.approx([0.0, 20.0])
    for head, refusal in (("from_s = 30.0\nto_s = 10.0\n", UsageProblem), ("from_s = 80.0\n", BadInput), ("to_s = 80.0\n", BadInput)):
        with pytest.raises(refusal, match="to_s"):
            read(dive(folder, THRUSTERS, f"{NAV}\noffset_s = 93.0", head=head))


def test_a_channel_in_two_logs_is_taken_from_the_one_that_is_said(folder):
    table(folder / "other.csv", "u", 100.0 + np.arange(0, 60, 0.1), np.zeros(600))
    logs = (THRUSTERS, f"{NAV}\noffset_s = 93.0", 'file = "other.csv"\nprofile = "nav.toml"\noffset_s = 0.0')
    with pytest.raises(BadInput, match=r"two logs at one time: other.csv and nav.csv both have u") as refusal:
        read(dive(folder, *logs))
    assert "channels" in refusal.value.hint
    with pytest.raises(UsageProblem, match="none of the channels v"):
        read(dive(folder, *logs[:2], f'{logs[2]}\nchannels = ["v"]'))


def test_profiles_that_fit_need_no_name_and_vehicles_agree(folder):
    merlin_case.write(folder, name="merlin.csv")
    profile(folder, "nav", 'kind = "time_of_day"\ncolumns = ["t"]', 'altitude = { column = "u", unit = "m" }', 'vehicle = "minerva"')
    (folder / "nav.csv").write_text("t,u\n" + "\n".join(f"10:00:{0.5 * i:04.1f},4.5" for i in range(40)))
    with pytest.raises(BadInput, match=r"merlin.csv is of merlin, nav.csv is of minerva"):
        read(dive(folder, 'file = "merlin.csv"', NAV))
    log = read(dive(folder, 'file = "merlin.csv"', NAV, head='vehicle = "merlin"\n'))
    assert log.vehicle == "merlin" and set(log.channels["altitude"].values) == {4.5} and log.channels["altitude"].t[1] == pytest.approx(0.5)


def test_every_problem_of_the_file_is_named(folder):
    with pytest.raises(UsageProblem, match=r"(?s)log\.0\.file.*log\.0\.fil: ") as refusal:
        read(dive(folder, 'fil = "nav.csv"'))
    assert "docs/formats.md" in refusal.value.hint
    with pytest.raises(BadInput, match=r"(?s)a.csv is not there.*b\*.csv is not there"):
        read(dive(folder, 'file = "a.csv"', 'file = "b*.csv"'))
    with pytest.raises(UsageProblem, match="states no offset from UTC"):
        read(dive(folder, f"{NAV}\nbegins = 2026-11-23T10:00:00"))


def test_a_folder_s_dive_stands_for_its_files_and_its_digest_counts_them(folder):
    path = dive(folder, THRUSTERS, f"{NAV}\noffset_s = 93.0")
    (folder / "alone.csv").write_text("t,u\n0,1\n")
    assert logs_in([str(folder)]) == [path, folder / "alone.csv"]
    before = sha256(path)
    for name in ("nav.csv", "nav.toml"):
        (folder / name).write_text((folder / name).read_text() + "\n")
        assert sha256(path) != before
        before = sha256(path)


def test_a_bag_or_lines_beside_a_table(folder):
    """Any format beside any other: thruster speeds of a table, velocities of a Doppler log's JSON."""
    rest = {"type": "velocity", "vy": 0, "vz": 0, "altitude": 2, "velocity_valid": True}
    lines = [rest | {"vx": float(np.sin(s)), "time_of_validity": round((START.timestamp() + s) * 1e6)} for s in np.arange(0, 60, 0.2)]
    (folder / "dvl.jsonl").write_text("\n".join(map(json.dumps, lines)))
    run = open_run(dive(folder, f"{THRUSTERS}\nbegins = 2026-11-23T10:00:00Z", 'file = "dvl.jsonl"'))
    assert {"u", "v", "w", "altitude", "n:T1"} == set(run.values) and run.t0_ns == pytest.approx(START.timestamp() * 1e9)
    assert run.values["u"][10] == pytest.approx(np.sin(1.0), abs=6e-3)
