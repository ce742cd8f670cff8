"""Stamps as they are written: what Python's own calendar says of the same moment, and a refusal where a date may be read two ways."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta, timezone
from zoneinfo import ZoneInfo

import numpy as np
import polars as pl
import pytest

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read, reader
from rovval.ingest.clocks.wall_clock import date_orders, nanoseconds, seconds_of_day
from rovval.ingest.profile import parse_profile

MOMENT = datetime(2024, 5, 3, 14, 3, 22, 125000)
BERLIN = ZoneInfo("Europe/Berlin")
WRITTEN = [
    ("%Y-%m-%d %H:%M:%S.125", None, "UTC", UTC),
    ("%Y-%m-%dT%H:%M:%S.125+02:00", None, "UTC", BERLIN),
    ("%Y-%m-%dT%H:%M:%S,125-0530", None, "Europe/Berlin", timezone(-timedelta(hours=5, minutes=30))),
    ("%Y%m%dT%H%M%S.125Z", None, "Europe/Berlin", UTC),
    ("%d.%m.%Y %H:%M:%S,125", None, "Europe/Berlin", BERLIN),
    ("%d/%m/%Y %I:%M:%S.125 %p", "dmy", "+02:00", BERLIN),
    ("%m/%d/%y %I:%M:%S.125 %p", "mdy", "UTC", UTC),
    ("%d-%b-%Y %H:%M:%S.125", None, "UTC", UTC),
    ("%b %d, %Y %I:%M:%S.125 %p", None, "UTC", UTC),
    ("%Y/%m/%d, %H:%M:%S.125", None, "America/New_York", ZoneInfo("America/New_York")),
]


@pytest.mark.parametrize(("shape", "order", "zone", "meant"), WRITTEN)
def test_a_stamp_is_the_moment_that_python_reads(shape, order, zone, meant):
    """Over a day and a half, so that noon and midnight of AM and PM, and a change of the month, are among them."""
    moments = [(MOMENT + timedelta(hours=k)).replace(tzinfo=meant) for k in range(36)]
    got = nanoseconds(pl.Series([m.strftime(shape) for m in moments]), order, zone)
    assert got.to_list() == [round(m.timestamp() * 1000) * 10**6 for m in moments]


def test_a_date_that_may_be_read_two_ways_is_refused():
    stamps = pl.Series(["03/04/2024 10:00:00", "04/04/2024 10:00:00"])
    with pytest.raises(BadInput, match=r"day or its month first(?s:.)*date_order"):
        nanoseconds(stamps, None, "UTC")
    assert date_orders(stamps) == ("dmy", "mdy")
    assert date_orders(pl.Series(["03/04/2024 10:00:00", "13/04/2024 10:00:00"])) == ("dmy",)
    assert date_orders(pl.Series(["04/13/2024 10:00:00"])) == ("mdy",)


def test_what_is_no_stamp_is_missing_and_too_much_of_it_is_refused():
    some = nanoseconds(pl.Series(["2024-05-03 14:03:22", "pause", "2024-13-03 14:03:22", "2024-05-03 14:03:23", "2024-05-03 14:03:24"]), None, "UTC")
    assert some.is_null().to_list() == [False, True, True, False, False]
    with pytest.raises(BadInput, match="'pause'"):
        nanoseconds(pl.Series(["pause", "pause", "2024-05-03 14:03:22"]), None, "UTC")


def test_the_hour_that_comes_twice_in_autumn():
    """The clock goes back by an hour in Berlin on 27 October 2024 at 1:00 UTC; the first of the two is taken, offsets say it all."""
    twice = nanoseconds(pl.Series(["2024-10-27 02:30:00", "2024-10-27T02:30:00+02:00", "2024-10-27T02:30:00+01:00"]), None, "Europe/Berlin")
    assert (twice[0], twice[2] - twice[1]) == (twice[1], 3600 * 10**9)


def test_a_time_of_day_as_text():
    got = seconds_of_day(pl.Series(["14:03:22.5", "02:03:22 PM", "12:00:01 AM", "24:00:00", ""]))
    assert np.array_equal(got, [50602.5, 50602.0, 1.0, np.nan, np.nan], equal_nan=True)


def profile(**time):
    table = {"name": "p", "description": "", "format": "csv_log", "frame": "fsd", "world": "ned", "channels": {"u": {"column": "u", "unit": "m/s"}}}
    return parse_profile({**table, "time": time}, "p")


def log(tmp_path, header, stamps):
    path = tmp_path / "log.csv"
    path.write_text(f"{header};u\n" + "".join(f"{s};{i}\n" for i, s in enumerate(stamps)))
    return path


@pytest.mark.parametrize(
    ("time", "stamps"),
    [
        ({"kind": "epoch", "columns": ["t"], "unit": "day", "since": "excel"}, ["45415.5", "45415.50001"]),  # 2024-05-03 in Excel
        ({"kind": "epoch", "columns": ["t"], "unit": "day", "since": "matlab"}, ["739375.5", "739375.50001"]),  # datenum(2024, 5, 3)
        ({"kind": "epoch", "columns": ["t"], "since": "labview"}, ["3797582400.0", "3797582400.864"]),
        ({"kind": "epoch", "columns": ["t"], "unit": "ms"}, ["1714737600000", "1714737600864"]),
        ({"kind": "datetime", "columns": ["t"], "timezone": "+02:00"}, ["2024-05-03 14:00:00.000", "2024-05-03 14:00:00.864"]),
    ],
)
def test_every_epoch_is_the_same_noon(time, stamps, tmp_path):
    raw = reader("csv_log").read(log(tmp_path, "t", stamps), profile(**time))
    noon = datetime(2024, 5, 3, 12, tzinfo=UTC).timestamp()
    assert raw.t0_ns is not None and abs(raw.t0_ns * 1e-9 - noon) < 1e-4
    assert np.allclose(raw.channels["u"].t, [0.0, 0.864], atol=1e-4)


def test_six_columns_and_one_of_the_time_of_day(tmp_path):
    six = reader("csv_log").read(
        log(tmp_path, "y;m;d;h;min;s", ["2024;5;3;12;0;0.5", "2024;5;3;12;0;1.5"]), profile(kind="datetime", columns=["y", "m", "d", "h", "min", "s"])
    )
    assert six.t0_ns == round(datetime(2024, 5, 3, 12, 0, 0, 500000, tzinfo=UTC).timestamp() * 1000) * 10**6
    day = reader("csv_log").read(log(tmp_path, "t", ["11:59:59.5 PM", "12:00:00.0 AM"]), profile(kind="time_of_day", columns=["t"]))
    assert day.t0_ns is None and np.allclose(day.channels["u"].t, [0.0, 0.5])


@pytest.mark.parametrize(
    ("time", "word"),
    [
        ({"kind": "datetime", "columns": ["t"], "timezone": "Europe/Bielefeld"}, "unknown; use a name such as"),
        ({"kind": "elapsed", "columns": ["t"], "timezone": "Europe/Berlin"}, "wall clock"),
        ({"kind": "elapsed", "columns": ["t"], "date_order": "dmy"}, "date_order is for datetime"),
        ({"kind": "elapsed", "columns": ["t"], "since": "excel"}, "since is for epoch"),
        ({"kind": "elapsed", "columns": ["t"], "unit": "m"}, "no unit of time"),
    ],
)
def test_a_clock_that_cannot_be_is_refused(time, word):
    with pytest.raises(UsageProblem, match=word):
        profile(**time)


def test_the_command_lines_zone_goes_before_the_profiles(tmp_path):
    path = log(tmp_path, "t", ["2024-05-03 14:00:00.000", "2024-05-03 14:00:01.000"])
    text = 'name = "p"\ndescription = ""\nformat = "csv_log"\nframe = "fsd"\nworld = "ned"\n[time]\nkind = "datetime"\ncolumns = ["t"]\ntimezone = "UTC"\n'
    (tmp_path / "p.toml").write_text(text + '[channels]\nu = { column = "u", unit = "m/s" }\n')
    by = {zone: read(path, str(tmp_path / "p.toml"), zone).t0_ns for zone in (None, "Europe/Berlin", "-01:30")}
    first = by[None]
    assert first is not None and by == {None: first, "Europe/Berlin": first - 7200 * 10**9, "-01:30": first + 5400 * 10**9}
    with pytest.raises(UsageProblem, match="unknown"):
        read(path, str(tmp_path / "p.toml"), "Berlin")
