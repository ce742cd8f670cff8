"""Moments that a log names itself, and stretches between them: tables, bags, telemetry, and through the archive."""

from __future__ import annotations

import struct

import merlin_case
import numpy as np
import polars as pl
import pytest
from bag_case import START_NS, write
from log_files import own
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

from rovval.alignment.stretch import stretch_of
from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.ingest.profile import FOLDER, load_profile
from rovval.storage.archive import load_run, open_run, save_run

NOTES = {50: "turn left", 51: "turn left", 52: "turn left", 120: "straight", 200: "turn left"}  # row -> the operator's note


@pytest.fixture
def noted(tmp_path):
    (tmp_path / "noted.toml").write_text(built_in("merlin") + '\n[markers]\ncolumn = "Note"\n')
    merlin_case.write(tmp_path, edit=lambda cells: cells.update(Note=[NOTES.get(k, "") for k in range(300)]))
    return tmp_path


def built_in(name):
    return (FOLDER / f"{name}.toml").read_text().replace(f'name = "{name}"', 'name = "noted"', 1)


@pytest.mark.parametrize("form", ["csv", "parquet"])
def test_a_column_names_moments_and_stretches(noted, form):
    """Where it begins to say something; the same again further on is another moment."""
    path = noted / "dive.csv"
    if form == "parquet":
        pl.read_csv(path).write_parquet(path := noted / "dive.parquet")
    run = open_run(path, str(noted / "noted.toml"))
    assert [(m.name, round(m.t_s, 3)) for m in run.markers] == [("turn left", 5.0), ("straight", 12.0), ("turn left", 20.0)]
    cut = stretch_of(run, "turn left", "Straight")
    assert cut.duration_s == pytest.approx(7.0) and np.array_equal(cut.values["u"], run.values["u"][50:121]) and cut.id.endswith("-from5to12s")
    assert [m.name for m in cut.markers] == ["turn left", "straight"] and cut.markers[0].t_s == pytest.approx(0.0)
    assert stretch_of(run, "straight", "turn left").duration_s == pytest.approx(8.0), "the first one after the start"
    assert stretch_of(run, "2.5", "12.0").duration_s == pytest.approx(9.5)
    with pytest.raises(BadInput, match="no marker 'turn right'") as refusal:
        stretch_of(run, "turn right")
    assert "'turn left', 'straight'" in refusal.value.hint
    with pytest.raises(BadInput, match="'straight' is not there after 12 s"):
        stretch_of(run, "straight", "straight")


def test_they_are_kept_in_the_archive(noted, tmp_path):
    run = open_run(noted / "dive.csv", str(noted / "noted.toml"))
    save_run(run, tmp_path / "archive")
    assert load_run(run.id, tmp_path / "archive").markers == run.markers


def test_a_log_without_them_is_said(noted):
    log = read(merlin_case.write(noted, name="plain.csv"), str(noted / "noted.toml"))
    assert log.markers == () and [(f.code, f.where) for f in log.findings] == [("no_markers", "Note")]


def test_messages_of_a_bag(tmp_path):
    store = get_typestore(Stores.ROS1_NOETIC)
    kind = "std_msgs/msg/String"

    class Noting(Writer):
        def open(self):
            super().open()
            connection = self.add_connection("/notes", kind, typestore=store)
            for seconds in (4, 9, 9.5):
                raw = store.serialize_ros1(store.types[kind](data=f"lap {seconds:g}"), kind)
                self.write(connection, START_NS + int(seconds * 1e9), raw)

    def notes(writer: Writer):
        writer.__class__ = Noting

    path = write("bag", tmp_path / "a.bag", prepare=notes)
    channels = 'u = { topic = "/odom", field = "twist.twist.linear.x", unit = "m/s" }\n[markers]\ntopic = "/notes"\nfield = "data"'
    log = read(path, own(tmp_path, "ros_bag", "record", channels))
    assert [(m.name, round(m.t_s, 2)) for m in log.markers] == [("lap 4", 3.97), ("lap 9", 8.97), ("lap 9.5", 9.47)], "on the clock of the channels"


def test_messages_of_an_autopilot(tmp_path):
    from pymavlink.dialects.v20 import ardupilotmega as m

    link, start = m.MAVLink(None, srcSystem=1, srcComponent=1), 1_700_000_000
    with (tmp_path / "a.tlog").open("wb") as file:
        for i in range(100):
            sent = [m.MAVLink_attitude_message(5000 + 100 * i, 0.01 * i, 0, 0, 0, 0, 0)]
            sent += [m.MAVLink_statustext_message(6, b"Arming motors")] if i == 30 else []
            for message in sent:
                file.write(struct.pack(">Q", int((start + 0.1 * i) * 1e6)) + message.pack(link))
    channels = 'phi = { topic = "ATTITUDE", field = "roll", unit = "rad" }\n[markers]\ntopic = "STATUSTEXT"\nfield = "text"'
    log = read(tmp_path / "a.tlog", own(tmp_path, "autopilot", "header", channels))
    assert [(k.name, round(k.t_s, 2)) for k in log.markers] == [("Arming motors", 3.0)]


def test_a_profile_says_one_place_for_them(tmp_path):
    with pytest.raises(UsageProblem, match="markers: needs either column, or topic and field"):
        load_profile(own(tmp_path, "csv_log", "elapsed", 'u = { column = "u", unit = "m/s" }\n[markers]\ntopic = "/notes"'))
