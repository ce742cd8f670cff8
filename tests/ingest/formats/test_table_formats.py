"""Workbooks, Parquet, Matlab and HDF5, written by each format's own library: the same table is the same log as its CSV, bit for bit."""

from __future__ import annotations

import datetime as dt
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import merlin_case
import numpy as np
import openpyxl
import polars as pl
import pytest
from scipy.io import savemat

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read, reader
from rovval.ingest.profile import parse_profile
from rovval.pipeline.planning.discover import logs_in
from rovval.storage.archive import open_run

Columns = dict[str, np.ndarray[Any, Any]]


def workbook(path: Path, columns: Columns) -> None:
    """As an export has it: a banner, an empty row, and a second sheet that is no table."""
    book = openpyxl.Workbook()
    sheet: Any = book.active
    for row in ([], ["Merlin, dive 7"], [], list(columns), *zip(*(c.tolist() for c in columns.values()), strict=True)):
        sheet.append(row)
    book.create_sheet("remarks").append(["the tether was caught"])
    book.save(path)


def hdf5(path: Path, columns: Columns) -> None:
    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file[name] = values
        file["remark"] = "the tether was caught"


def matlab_73(path: Path, columns: Columns) -> None:
    """What Matlab's `save -v7.3` writes of a structure: HDF5 behind 512 bytes of its own, arrays transposed, their class an attribute."""
    with h5py.File(path, "w", userblock_size=512) as file:
        group = file.create_group("log")
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for name, values in columns.items():
            group.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


WRITERS: dict[str, Callable[[Path, Columns], None]] = {
    "dive.xlsx": workbook,
    "dive.parquet": lambda path, columns: pl.DataFrame(columns).write_parquet(path),
    "vectors.mat": savemat,
    "columns.mat": lambda path, columns: savemat(path, {n: c[:, None] for n, c in columns.items()}, do_compression=True),
    "structure.mat": lambda path, columns: savemat(path, {"log": columns, "mass": 11.5}),
    "new.mat": matlab_73,
    "dive.h5": hdf5,
}


@pytest.fixture(scope="module")
def columns() -> Columns:
    return {name: np.array(cells, dtype=float) for name, cells in merlin_case.columns().items()}


@pytest.mark.parametrize("name", WRITERS)
def test_a_table_is_the_same_log_in_every_format(tmp_path, columns, name):
    """The profile is found as for CSV, and a folder is searched for the file."""
    (tmp_path / "logs").mkdir()
    WRITERS[name](tmp_path / "logs" / name, columns)
    expected = read(merlin_case.write(tmp_path))
    log = read(logs_in([str(tmp_path / "logs")])[0])
    assert log.profile == "merlin" and set(log.channels) == set(expected.channels)
    assert all(np.array_equal(log.channels[n].values, s.values) and np.array_equal(log.channels[n].t, s.t) for n, s in expected.channels.items())
    assert log.properties["time_of_day_s_at_start"] == "36000.000"


def own(time: dict[str, Any], channels: dict[str, Any], kind: str = "csv_log") -> Any:
    table = {"name": "own", "description": "", "format": kind, "frame": "fsd", "world": "ned", "time": time, "channels": channels}
    return parse_profile(table, "here")


def test_dates_and_times_of_a_workbook(tmp_path):
    """Moments in one column, or day and time in two, as cells of dates; decimal commas as text; an empty row."""
    start = dt.datetime(2026, 11, 23, 23, 59, 59)
    book = openpyxl.Workbook()
    sheet: Any = book.active
    sheet.append(["when", "day", "clock", "u [m/s]"])
    for i in range(20):
        at = start + dt.timedelta(seconds=0.1 * i)
        sheet.append([at, at.date(), at.time(), f"0,{i:02d}"])
        sheet.append([])
    book.save(tmp_path / "dates.xlsx")
    u = {"u": {"column": "u", "unit": "m/s"}}
    for names in (["when"], ["day", "clock"]):
        log = reader("excel").read(tmp_path / "dates.xlsx", own({"kind": "datetime", "columns": names}, u))
        assert log.channels["u"].values == pytest.approx(np.arange(20) / 100) and log.channels["u"].t == pytest.approx(np.arange(20) / 10, abs=1e-6)
        assert log.t0_ns == pytest.approx(start.replace(tzinfo=dt.UTC).timestamp() * 1e9)


@pytest.mark.parametrize("kind", ["excel", "hdf5", "matlab"])
def test_several_tables_at_their_own_rates(tmp_path, kind):
    """Sheets, groups and structures are topics; each has its own stamps, on one clock."""
    nav = {"t": 5.0 + 0.1 * np.arange(50), "u": np.linspace(0, 1, 50), "nu": np.tile([0.1, 0.2], (50, 1))}
    thrusters = {"t": 4.5 + 0.02 * np.arange(300), "rpm": np.arange(300.0)}
    path = tmp_path / f"dive{reader(kind).SUFFIXES[0]}"
    if kind == "excel":
        book = openpyxl.Workbook()
        for name, part in (("nav", nav), ("thr", thrusters)):
            flat = {n: v for n, v in part.items() if v.ndim == 1} | ({"nu[1]": part["nu"][:, 1]} if "nu" in part else {})
            sheet = book.create_sheet(name)
            for row in (list(flat), *zip(*(v.tolist() for v in flat.values()), strict=True)):
                sheet.append(row)
        book.save(path)
    elif kind == "hdf5":
        with h5py.File(path, "w") as file:
            for name, part in (("nav", nav), ("thr", thrusters)):
                for n, v in part.items():
                    file[f"{name}/{n}"] = v
    else:
        savemat(path, {"nav": nav, "thr": thrusters})
    channels = {
        "u": {"topic": "nav", "field": "u", "unit": "m/s"},
        "v": {"topic": "nav", "field": "nu[1]", "unit": "m/s"},
        "n:T1": {"topic": "thr", "field": "rpm", "unit": "rpm"},
    }
    log = reader(kind).read(path, own({"kind": "elapsed", "columns": ["t"]}, channels, kind))
    assert log.channels["n:T1"].t[0] == 0.0 and log.channels["u"].t[0] == pytest.approx(0.5)
    assert log.channels["u"].values == pytest.approx(nav["u"], rel=1e-15)  # openpyxl writes 16 digits
    assert set(log.channels["v"].values) == {0.2}
    assert log.channels["n:T1"].values == pytest.approx(np.arange(300) / 60) and log.t0_ns is None


def test_arrays_of_two_lengths_in_one_workspace(tmp_path):
    """Two rates side by side, without structures: the table that has all of a profile's columns is taken."""
    savemat(tmp_path / "two.mat", {"t": np.arange(50) * 0.1, "u": np.arange(50.0), "w": np.arange(50.0), "t_thr": np.arange(80) * 0.1, "rpm": np.ones((80, 2))})
    profile = own({"kind": "elapsed", "columns": ["t_thr"]}, {"n:T2": {"column": "rpm[1]", "unit": "rpm"}})
    assert len(reader("matlab").read(tmp_path / "two.mat", profile).channels["n:T2"].t) == 80


def test_simulink_s_structure_with_time(tmp_path):
    signals = [{"values": np.arange(30.0)[:, None], "label": "surge"}, {"values": np.ones((30, 2)), "label": ""}]
    savemat(tmp_path / "sim.mat", {"out": {"time": np.arange(30) * 0.1, "signals": signals}})
    channels = {"u": {"topic": "out", "field": "surge", "unit": "m/s"}, "v": {"topic": "out", "field": "signals[1][0]", "unit": "m/s"}}
    log = reader("matlab").read(tmp_path / "sim.mat", own({"kind": "elapsed", "columns": ["time"]}, channels, "matlab"))
    assert np.array_equal(log.channels["u"].values, np.arange(30.0)) and len(log.channels["v"].values) == 30


def test_parquet_with_moments_and_structures(tmp_path):
    at = pl.datetime_range(dt.datetime(2026, 11, 23, 12), dt.datetime(2026, 11, 23, 12, 0, 2), "100ms", time_zone="Europe/Oslo", eager=True)
    frame = pl.DataFrame({"at": at, "velocity": [{"x": 0.1 * i, "y": 0.0} for i in range(len(at))], "rpm": [[60.0 * i, 0.0] for i in range(len(at))]})
    frame.write_parquet(tmp_path / "nested.parquet")
    channels = {"u": {"column": "velocity.x", "unit": "m/s"}, "n:T1": {"column": "rpm[0]", "unit": "rpm"}}
    log = reader("parquet").read(tmp_path / "nested.parquet", own({"kind": "datetime", "columns": ["at"]}, channels))
    assert log.channels["n:T1"].values == pytest.approx(np.arange(21.0)) and log.channels["u"].values == pytest.approx(0.1 * np.arange(21))
    assert log.t0_ns == dt.datetime(2026, 11, 23, 11, tzinfo=dt.UTC).timestamp() * 1e9


def test_what_is_missing_is_named_with_what_is_near(tmp_path, columns):
    path = tmp_path / "dive.h5"
    hdf5(path, {("LinVelocityX" if n == "LinVelX" else n): c for n, c in columns.items()})
    with pytest.raises(BadInput, match=r"'LinVelX' \(near: .*'LinVelocityX'"):
        read(path, "merlin")
    with pytest.raises(BadInput, match="merlin misses 1: LinVelX"):
        read(path)


def test_two_tables_that_fit_are_not_chosen_between(tmp_path, columns):
    savemat(tmp_path / "twice.mat", {"first": columns, "second": columns})
    with pytest.raises(BadInput, match="2 tables have the columns"):
        read(tmp_path / "twice.mat", "merlin")


def test_values_that_are_missing_stay_missing(tmp_path, columns):
    pl.DataFrame(columns | {"LinVelX": [None if 100 <= i < 130 else x for i, x in enumerate(columns["LinVelX"])]}).write_parquet(tmp_path / "d.parquet")
    run = open_run(tmp_path / "d.parquet")
    assert np.isnan(run.values["u"][110]) and not np.isnan(run.values["v"][110])
    assert any(f.code == "blank_cell" and "30 blank cells" in f.detail for f in run.findings)


@pytest.mark.parametrize("name", WRITERS)
def test_a_cut_file_is_refused_or_read(tmp_path, columns, name):
    WRITERS[name](tmp_path / name, columns)
    whole = (tmp_path / name).read_bytes()
    for share in (0.02, 0.5, 0.97):
        (tmp_path / name).write_bytes(whole[: int(share * len(whole))])
        try:
            read(tmp_path / name, "merlin")
        except BadInput as refusal:
            assert name in str(refusal)


def test_panics_of_a_decoder_are_not_printed(tmp_path, columns, capfd):
    """Of some damage polars' decoder panics in a thread of its own, and prints forty lines before it raises."""
    path = tmp_path / "dive.parquet"
    WRITERS[path.name](path, columns)
    whole, refused = path.read_bytes(), 0
    for at in range(1000, len(whole) - 64, 700):
        path.write_bytes(whole[:at] + b"\xff" * 64 + whole[at + 64 :])
        try:
            read(path, "merlin")
        except BadInput:
            refused += 1
    printed = capfd.readouterr()
    assert refused and printed.err == printed.out == ""


@pytest.mark.parametrize(("name", "library", "extra"), [("dive.xlsx", "fastexcel", "spreadsheet"), ("dive.h5", "h5py", "hdf5"), ("new.mat", "h5py", "hdf5")])
def test_a_missing_extra_is_named(tmp_path, columns, monkeypatch, name, library, extra):
    WRITERS[name](tmp_path / name, columns)
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(UsageProblem, match=library) as refusal:
        read(tmp_path / name, "merlin")
    assert f"rovval[{extra}]" in refusal.value.hint
