"""Merlin's CSV as documented, and as exports really come."""

from __future__ import annotations

import merlin_case
import numpy as np
import pytest

from rovval.core.errors import BadInput
from rovval.ingest import read
from rovval.storage.archive import open_run


def codes(log) -> dict[str, str]:
    return {f.code: f.detail for f in log.findings}


def test_units_frames_and_order(tmp_path):
    raw = read(merlin_case.write(tmp_path))
    cells = merlin_case.columns()
    assert raw.profile == "merlin" and raw.vehicle == "merlin" and raw.t0_ns is None and raw.findings == ()
    assert list(raw.channels)[:6] == ["x", "y", "z", "phi", "theta", "psi"]
    assert np.array_equal(raw.channels["u"].values, np.array(cells["LinVelX"], dtype=float))
    assert np.allclose(raw.channels["r"].values, np.radians(np.array(cells["AngVelZ"], dtype=float)))
    assert np.allclose(raw.channels["n:HFP"].values, np.array(cells["HFP_PV"], dtype=float) / 60)
    assert np.allclose(raw.channels["n_cmd:HFP"].values, np.array(cells["HFP_SP"], dtype=float) / 60)
    psi = raw.channels["psi"].values
    assert psi.min() > -np.pi and psi.max() <= np.pi and np.abs(np.diff(np.unwrap(psi))).max() < 0.01
    assert np.allclose(raw.channels["u"].t, np.arange(300) * 0.1)
    assert raw.properties["time_of_day_s_at_start"] == "36000.000"


def test_latitude_and_longitude_become_metres(tmp_path):
    """Against the metre per degree at 60.3 degrees north: 111 420 m and 55 340 m within a few metres (WGS-84)."""
    raw = read(merlin_case.write(tmp_path))
    seconds = 29.9
    assert raw.channels["x"].values[-1] == pytest.approx(1e-6 * seconds * 111_421, rel=1e-3)
    assert raw.channels["y"].values[-1] == pytest.approx(2e-6 * seconds * 55_340, rel=1e-3)
    assert raw.properties["origin_latitude_deg"] == "60.3"


def test_midnight_is_no_step(tmp_path):
    path = tmp_path / "night.csv"
    path.write_text(merlin_case.text(merlin_case.columns(300, start_s=86390.0)))
    raw = read(path)
    assert np.allclose(np.diff(raw.channels["u"].t), 0.1) and raw.findings == ()


def test_a_run_is_what_was_logged(tmp_path):
    run = open_run(merlin_case.write(tmp_path))
    assert len(run) == 300 and run.clock.matched == run.clock.samples
    assert np.array_equal(run.values["u"], np.array(merlin_case.columns()["LinVelX"], dtype=float))
    assert all(r.method == "unchanged" for r in run.resampled.values())


def test_any_thrusters_are_read(tmp_path):
    def rename(cells):
        for i, name in enumerate(merlin_case.THRUSTERS, 1):
            cells[f"T{i}_PV"], cells[f"T{i}_SP"] = cells.pop(f"{name}_PV"), cells.pop(f"{name}_SP")

    raw = read(merlin_case.write(tmp_path, edit=rename))
    assert [n for n in raw.channels if n.startswith("n:")] == [f"n:T{i}" for i in range(1, 8)]


def test_optional_columns_are_read_where_they_are(tmp_path):
    def add(cells):
        cells["Altitude"] = ["12.5"] * 300
        cells["Voltage"] = ["400"] * 300
        cells["Operator"] = ["Kari"] * 300

    raw = read(merlin_case.write(tmp_path, edit=add))
    assert raw.channels["altitude"].values[0] == 12.5 and raw.channels["voltage"].values[0] == 400
    assert raw.properties["columns_unused"] == "Operator"


def test_accelerations_may_be_missing(tmp_path):
    def drop(cells):
        for name in ("LinAccX", "LinAccY", "LinAccZ"):
            del cells[name]

    whole, bare = (open_run(merlin_case.write(tmp_path, name=f"{name}.csv", edit=edit)) for name, edit in (("whole", None), ("bare", drop)))
    assert set(whole.values) - set(bare.values) == {"udot", "vdot", "wdot"} and not bare.measured("udot")
    assert bare.profile == "merlin" and all(np.array_equal(bare.values[name], whole.values[name]) for name in bare.values)


def test_every_missing_column_is_named_at_once_with_near_ones(tmp_path):
    def spoil(cells):
        cells["LinVelocityX"] = cells.pop("LinVelX")
        del cells["Depth"], cells["AngVelZ"]

    path = merlin_case.write(tmp_path, edit=spoil)
    with pytest.raises(BadInput) as refused:
        read(path, "merlin")
    text = str(refused.value)
    assert all(name in text for name in ("'LinVelX'", "'LinVelocityX'", "'Depth'", "'AngVelZ'", "3 problems"))
    with pytest.raises(BadInput, match="merlin misses 3"):
        read(path)


def test_lines_of_separators_alone_lose_nothing(tmp_path):
    """A spreadsheet writes them below the last row: "dropped" was told of rows that hold nothing."""
    path = merlin_case.write(tmp_path)
    blank = "," * path.read_text().splitlines()[0].count(",")
    lines = path.read_text().splitlines()
    path.write_text("\n".join([*lines[:100], blank, *lines[100:], blank, blank, ""]))
    log = read(path)
    assert log.findings == () and len(log.channels["u"].values) == 300


def test_zeros_that_a_crash_left_in_the_middle_cost_their_rows_alone(tmp_path):
    """A whole log was refused as binary."""
    path = merlin_case.write(tmp_path)
    content = path.read_bytes()
    path.write_bytes(content[:40_000] + bytes(1000) + content[41_000:])
    log = read(path)
    assert 290 < len(log.channels["u"].values) < 300 and "ragged_row" in codes(log)
