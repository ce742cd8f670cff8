"""What is in a log, before any profile: against logs whose contents were written here, and published ones."""

from __future__ import annotations

import json

import numpy as np
import pytest
from bag_case import START_NS, N, write
from german_dive import german
from real_data import real
from typer.testing import CliRunner

from rovval import ingest
from rovval.cli.app import app
from rovval.core.errors import BadInput
from rovval.ingest.inspection.inspect import inspect
from rovval.report import inspection


def test_a_table_with_a_banner_decimal_commas_and_text(tmp_path):
    found = inspect(german(tmp_path / "dive.csv"))
    table = found.contents.topics[""]
    assert found.format == "csv_log" and found.contents.facts == {"separator": "';'"} and table.rows == 60
    depth = table.fields["Tiefe [m]"]
    assert (depth.low, depth.high, depth.present, depth.missing) == (2.5, 3.09, 60, 0)
    assert table.fields["Modus"].examples == ("HOLD", "DEPTH") and table.fields["Kurs [°]"].largest_step == 359.0
    best = found.stamps[""][0]
    assert (best.kind, best.columns, best.sure) == ("datetime", ("Datum", "Uhrzeit"), True)
    assert np.isclose(best.rhythm.period_s, 0.1) and np.isclose(best.rhythm.largest_gap_s, 5.1) and np.isclose(best.rhythm.gap_after_s, 2.9)
    assert found.fits == () and "rovval profile propose" in inspection.page(found)


@pytest.mark.parametrize(
    ("header", "stamps", "kind", "unit", "since"),
    [
        ("t", [0.0, 0.1, 0.2, 0.3], "elapsed", "s", "unix"),
        ("time_ms", [0, 100, 200, 300], "elapsed", "ms", "unix"),
        ("stamp", [1714737600000, 1714737600100, 1714737600200, 1714737600300], "epoch", "ms", "unix"),
        ("Zeit", [45415.5, 45415.500001, 45415.500002, 45415.500003], "epoch", "day", "excel"),
    ],
)
def test_which_column_may_be_time(header, stamps, kind, unit, since, tmp_path):
    (tmp_path / "a.csv").write_text(f"depth,{header},n\n" + "".join(f"{1.0 - i * 0.1},{t!r},{i}\n" for i, t in enumerate(stamps)))
    best = inspect(tmp_path / "a.csv").stamps[""][0]
    assert (best.kind, best.columns, best.unit, best.since) == (kind, (header,), unit, since)


def test_dates_that_may_be_read_two_ways_are_told_as_two(tmp_path):
    (tmp_path / "a.csv").write_text("when,depth\n" + "".join(f"03/04/2024 02:0{i}:00 PM,{i}\n" for i in range(4)))
    readings = inspect(tmp_path / "a.csv").stamps[""]
    assert [s.date_order for s in readings] == ["dmy", "mdy"] and not any(s.sure for s in readings)


def test_a_bag_with_both_clocks_and_the_profile_that_reads_it(tmp_path):
    found = inspect(write("bag", tmp_path / "a.bag"))
    odom = found.contents.topics["/odom"]
    assert odom.kind == "nav_msgs/msg/Odometry" and odom.rows == N
    assert np.isclose(odom.clocks["header"].first_s, START_NS * 1e-9) and np.isclose(odom.clocks["header"].rate_hz, 10.0)
    assert odom.record_minus_header_s is not None and np.isclose(odom.record_minus_header_s, 0.03, atol=1e-6)
    assert odom.fields["pose.pose.position.z"].high == pytest.approx(-5.0 + 0.05 * 0.1 * (N - 1))
    assert odom.left_out["pose.covariance"] == "36 elements"
    assert found.fits == ("ros_odometry",)
    [match] = [m for m in found.matches if m.profile == "ros_odometry"]
    assert match.found["n:T2"] == (("/thrusters/T2/rpm", "data"),) and len(match.found["attitude"]) == 4 and match.optional_gone == ("altitude",)


def test_what_no_reader_reads_is_refused(tmp_path):
    (tmp_path / "a.csv").write_text("1,2,3\n4,5,6\n")
    with pytest.raises(BadInput, match="no line of names"):
        inspect(tmp_path / "a.csv")
    (tmp_path / "a.xyz").write_bytes(b"abc")
    with pytest.raises(BadInput, match="of no known format"):
        inspect(tmp_path / "a.xyz")


@pytest.mark.parametrize("place", ["bluerov2_tank/run_a.csv", "bluerov_2016/yaw_1.bag", "ardusub/small.BIN"])
def test_the_profile_that_reads_a_published_log_is_found(place):
    path = real(place)
    found = inspect(path)
    assert found.fits == (ingest.read(path).profile,)


def test_the_command_prints_a_page_or_a_document(tmp_path):
    path = german(tmp_path / "dive.csv")
    done = CliRunner().invoke(app, ["inspect", str(path), "--json"])
    document = json.loads(done.stdout)
    assert done.exit_code == 0 and document["schema"] == "rovval.inspection/1" and document["topics"][0]["rows"] == 60
    page = CliRunner().invoke(app, ["inspect", str(path)]).stdout
    assert "Tiefe [m]" in page and "largest gap 5.1 s" in page and "merlin: does not read it" in page
