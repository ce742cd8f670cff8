"""Exports as they really come: every spoiling either changes nothing or is a finding, or is one clear refusal."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from merlin_case import columns, text, write

from rovval.core.errors import BadInput
from rovval.ingest import read
from rovval.ingest.clocks.clock import increasing_stamps
from rovval.ingest.formats.csv_log import read as read_csv
from rovval.ingest.profile import load_profile, parse_profile
from rovval.storage.archive import open_run


def found(log, code):
    return [f for f in log.findings if f.code == code]


def same(a, b):
    assert sorted(a.channels) == sorted(b.channels)
    for name in a.channels:
        assert np.allclose(a.channels[name].t, b.channels[name].t, atol=1e-9) and np.allclose(
            a.channels[name].values, b.channels[name].values
        ), name


def decimal_comma(cells):
    return {k: [c.replace(".", ",") for c in v] for k, v in cells.items()}


def shuffled(cells):
    return {k: cells[k] for k in sorted(cells)}


def with_units(cells):
    unit = {"Depth": " [m]", "Roll": " (deg)", "LinVelX": " [m/s]", "HFP_PV": " [rpm]", "AngVelX": " (°/s)"}
    return {f" {k}{unit.get(k, '')} ": v for k, v in cells.items()}


DRESSES = {
    "banner": lambda c: b"Merlin UCV export\nvehicle: 7\n\n" + text(c).encode(),
    "byte order mark": lambda c: b"\xef\xbb\xbf" + text(c).encode(),
    "utf-16": lambda c: text(c).encode("utf-16"),
    "latin-1": lambda c: "Fartøy: Ærfugl\n".encode("latin-1") + text(c).encode("latin-1"),
    "semicolon": lambda c: text(c, ";").encode(),
    "tab": lambda c: text(c, "\t").encode(),
    "decimal comma": lambda c: text(decimal_comma(c), ";").encode(),
    "quoted decimal comma": lambda c: text({k: [f'"{x}"' for x in v] for k, v in decimal_comma(c).items()}).encode(),
    "windows lines": lambda c: text(c, ",", "\r\n").encode(),
    "old mac lines": lambda c: text(c, ",", "\r").encode(),
    "other order": lambda c: text(shuffled(c)).encode(),
    "quoted header": lambda c: text({f'"{k}"': v for k, v in c.items()}).encode(),
    "units and spaces in the header": lambda c: text(with_units(c)).encode(),
    "lower case": lambda c: text({k.lower() if not k.endswith(("_PV", "_SP")) else k: v for k, v in c.items()}).encode(),
    "more columns": lambda c: text({"Note": ["ok"] * 300, **c, "Camera tilt": ["3"] * 300}).encode(),
    "spaces round the cells": lambda c: text({k: [f"  {x} " for x in v] for k, v in c.items()}).encode(),
    "blank lines": lambda c: text(c, ",", "\n\n").encode(),
    "trailing separator": lambda c: text(c, ",", ",\n").encode(),
    "no final newline": lambda c: text(c).rstrip("\n").encode(),
    "header repeated": lambda c: (text(c) + ",".join(c) + "\n").encode(),
}


@pytest.mark.parametrize("dress", DRESSES)
def test_the_same_log_in_another_dress(dress, tmp_path):
    path = tmp_path / "log.csv"
    path.write_bytes(DRESSES[dress](columns()))
    raw = read(path)
    plain = read(write(tmp_path, name="plain.csv"))
    same(raw, plain)
    assert raw.findings == (), raw.findings


def edited(tmp_path, edit):
    return read(write(tmp_path, edit=edit))


@pytest.mark.parametrize("blank", ["", "NaN", "-", "null", "N/A", "nan"])
def test_blank_cells_are_missing_and_counted(tmp_path, blank):
    def spoil(cells):
        for i in (5, 6, 7):
            cells["LinVelX"][i] = blank

    raw = edited(tmp_path, spoil)
    assert len(raw.channels["u"].t) == 297 and len(raw.channels["v"].t) == 300
    (finding,) = found(raw, "blank_cell")
    assert finding.where == "LinVelX" and "3 blank cells" in finding.detail and "line 7" in finding.detail


def test_cells_that_are_no_numbers_are_named_with_their_lines(tmp_path):
    def spoil(cells):
        cells["Depth"][10] = "ERR#7"
        cells["Depth"][20] = "12.3.4"

    raw = edited(tmp_path, spoil)
    (finding,) = found(raw, "not_a_number")
    assert finding.where == "Depth" and "'ERR#7'" in finding.detail and "lines 12, 22" in finding.detail
    assert len(raw.channels["z"].t) == 298


def test_a_column_that_is_mostly_no_numbers_is_refused(tmp_path):
    def spoil(cells):
        cells["Depth"] = ["ten"] * 200 + cells["Depth"][200:]
        cells["Roll"] = ["x"] * 300

    with pytest.raises(BadInput, match=r"(?s)2 problems.*'Depth': 200 of 300.*'Roll': 300 of 300"):
        edited(tmp_path, spoil)


def test_an_empty_channel_is_said_and_left_out(tmp_path):
    def spoil(cells):
        cells["LinAccX"] = [""] * 300

    raw = edited(tmp_path, spoil)
    assert "udot" not in raw.channels and found(raw, "empty_channel")[0].where == "udot"


def rows(cells):
    head, *body = text(cells).splitlines()
    return head, body


def put(tmp_path, head, body, end="\n"):
    path = tmp_path / "rows.csv"
    path.write_text("\n".join([head, *body]) + end)
    return path


def test_repeated_rows_are_dropped_and_counted(tmp_path):
    head, body = rows(columns())
    raw = read(put(tmp_path, head, body[:50] + body[45:]))
    same(raw, read(write(tmp_path)))
    assert "5 rows repeated" in found(raw, "repeated_row")[0].detail and not found(raw, "clock_step")


def test_swapped_rows_are_sorted_and_counted(tmp_path):
    head, body = rows(columns())
    body[40], body[41] = body[41], body[40]
    body[100], body[103] = body[103], body[100]
    raw = read(put(tmp_path, head, body))
    same(raw, read(write(tmp_path)))
    assert found(raw, "swapped_row") and not found(raw, "clock_step") and not found(raw, "bad_stamp")


@pytest.mark.parametrize("by_s", [-3.0, -3.04, -45.0, -0.5])
def test_a_clock_stepped_back_is_found_and_the_rows_keep_their_spacing(tmp_path, by_s):
    one, two = columns(1000), columns(1000, start_s=36000.0 + by_s)
    cells = {k: one[k][:600] + (two if i < 4 else one)[k][600:] for i, k in enumerate(one)}
    path = tmp_path / "step.csv"
    path.write_text(text(cells))
    raw = read(path)
    (finding,) = found(raw, "clock_step")
    assert "line 602" in finding.where and f"back by {-by_s:.3f} s" in finding.detail
    assert np.allclose(np.diff(raw.channels["u"].t), 0.1, atol=1e-6) and len(raw.channels["u"].t) == 1000
    assert np.array_equal(raw.channels["u"].values, np.array(one["LinVelX"], dtype=float))


def test_a_step_forward_stays_a_gap(tmp_path):
    one, two = columns(1000), columns(1000, start_s=36007.0)
    cells = {k: one[k][:600] + (two if i < 4 else one)[k][600:] for i, k in enumerate(one)}
    path = tmp_path / "step.csv"
    path.write_text(text(cells))
    run = open_run(path)
    assert not [f for f in run.findings if f.code == "clock_step"]
    assert run.clock.largest_gap_s == pytest.approx(7.1) and (~run.ok("u")).sum() == 70


@pytest.mark.parametrize("hour", ["3", "23", "99"])
def test_one_wrong_stamp_costs_one_row(tmp_path, hour):
    def spoil(cells):
        cells["Hour"][150] = hour

    raw = edited(tmp_path, spoil)
    assert len(raw.channels["u"].t) == 299 and len(found(raw, "bad_stamp")) == 1
    assert raw.channels["u"].t[-1] == pytest.approx(29.9) and not found(raw, "clock_step")


def test_a_cut_last_line_is_dropped_and_said(tmp_path):
    head, body = rows(columns())
    raw = read(put(tmp_path, head, [*body[:-1], body[-1][:60]], end=""))
    assert len(raw.channels["u"].t) == 299 and found(raw, "cut_line")[0].where == "line 301"


def test_ragged_rows_are_dropped_and_said(tmp_path):
    head, body = rows(columns())
    body[9] += ",1,2"
    body[19] = body[19].rsplit(",", 4)[0]
    raw = read(put(tmp_path, head, body))
    assert len(raw.channels["u"].t) == 298 and found(raw, "ragged_row")[0].where == "lines 21, 11"


def test_stamps_without_milliseconds_are_refused_not_spread(tmp_path):
    def spoil(cells):
        cells["Millisecond"] = ["0"] * 300

    with pytest.raises(BadInput, match="too coarse"):
        edited(tmp_path, spoil)


def test_a_header_that_states_another_unit_is_refused(tmp_path):
    cells = columns()
    cells["Roll [rad]"], cells["LinVelX (knots)"] = cells.pop("Roll"), cells.pop("LinVelX")
    path = tmp_path / "units.csv"
    path.write_text(text(cells))
    with pytest.raises(BadInput, match="2 problems") as refused:
        read(path)
    for said in ("says 'rad', the profile says 'deg'", "says 'knots', the profile says 'm/s'"):
        assert said in str(refused.value)


def test_two_columns_of_one_name_are_refused(tmp_path):
    path = tmp_path / "twice.csv"
    path.write_text(text(columns() | {"DEPTH [m]": ["1"] * 300, " depth": ["2"] * 300}).replace("Depth,", "depth ,", 1))
    with pytest.raises(BadInput, match=r"'Depth' is there 3 times"):
        read(path)


def test_a_stuck_channel_is_said_and_not_masked(tmp_path):
    def spoil(cells):
        cells["LinVelX"][50:150] = [cells["LinVelX"][50]] * 100

    run = open_run(write(tmp_path, edit=spoil))
    (finding,) = [f for f in run.findings if f.code == "stuck"]
    assert finding.where == "u" and "9.9 s from t = 5.0 s" in finding.detail and run.ok("u").all()


def test_absurd_values_are_masked_with_their_reason(tmp_path):
    def spoil(cells):
        cells["Depth"][7] = "99999"
        cells["Heading"][9] = "4e5"

    run = open_run(write(tmp_path, edit=spoil))
    assert [f.where for f in run.findings if f.code == "out_of_range"] == ["z", "psi"]
    assert not run.ok("z")[7] and not run.ok("psi")[9] and run.ok("z").sum() == 299


BAD_FILES = {
    "empty.csv": (b"", "empty"),
    "newline.csv": (b"\n", "fits no built-in profile"),
    "binary.csv": (bytes(range(256)) * 40, "no known format"),
    "junk.bag": (bytes(range(256)) * 40, "no known format: its name ends in .bag, and it does not begin as such"),
    "noise.csv": (b"hello\nworld\n" * 9, "fits no built-in profile"),
    "header.csv": ((",".join(columns()) + "\n").encode(), "no complete row"),
    "one_row.csv": (text({k: v[:1] for k, v in columns().items()}).encode(), "at least 2"),
    "picture.png": (b"\x89PNG\r\n", "no known format"),
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_useless_files_are_refused_with_what_to_do(name, tmp_path):
    content, what = BAD_FILES[name]
    path = tmp_path / name
    path.write_bytes(content)
    with pytest.raises(BadInput, match=what) as refused:
        read(path)
    assert str(path) in refused.value.message and refused.value.hint
    with pytest.raises(BadInput):
        read(path, "merlin")


def test_paths_that_are_no_log(tmp_path):
    with pytest.raises(BadInput, match="no such file"):
        read(tmp_path / "nowhere.csv")
    with pytest.raises(BadInput, match="folder is empty"):
        read(tmp_path)
    (tmp_path / "notes.md").write_text("x")
    with pytest.raises(BadInput, match="no known format: a folder that holds no bag") as refused:
        read(tmp_path)
    assert "rovval ingest" in refused.value.hint
    with pytest.raises(BadInput, match=r"a folder; profile"):
        read(tmp_path, "merlin")


@settings(max_examples=25, deadline=None)
@given(st.data())
def test_any_order_and_any_loss_of_rows_keeps_stamps_and_values_together(tmp_path_factory, data):
    """Whatever rows are lost or moved a little, each kept sample still has its own stamp."""
    kept = sorted(data.draw(st.sets(st.integers(0, 299), min_size=80)))
    order = sorted(kept, key=lambda i: i + data.draw(st.sampled_from([0, 0, 0, 0, 0, 0, 1.5, -1.5])))
    head, body = rows(columns())
    raw = read(put(tmp_path_factory.mktemp("order"), head, [body[i] for i in order]))
    truth = np.array(columns()["LinVelX"], dtype=float)
    u = raw.channels["u"]
    at = np.rint(u.t / 0.1).astype(int) + int(np.flatnonzero(np.isin(truth, u.values))[0])
    assert len(u.t) >= 0.9 * len(kept)
    if not found(raw, "clock_step"):
        assert np.array_equal(truth[at], u.values)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-1e5, 1e5) | st.just(float("nan")), min_size=2, max_size=200))
def test_any_stamps_settle_or_are_refused(stamps):
    t = np.array(stamps)
    try:
        kept, out, _ = increasing_stamps(t, np.arange(2, len(t) + 2), "x")
    except BadInput:
        return
    assert (np.diff(out) > 0).all() and len(kept) == len(out) and np.isfinite(out).all()


@settings(max_examples=60, deadline=None)
@given(st.binary(min_size=1, max_size=400))
def test_any_bytes_are_read_or_refused(tmp_path_factory, content):
    folder = tmp_path_factory.mktemp("bytes")
    whole = text(columns(20)).encode()
    for i, junk in enumerate((content, whole[:600] + content + whole[600:], whole[: 5 * len(content)])):
        path = folder / f"{i}.csv"
        path.write_bytes(junk)
        try:
            open_run(path, "merlin")
        except BadInput as refused:
            assert refused.hint


def generic(**time):
    return parse_profile(
        {
            "name": "g", "description": "", "format": "csv_log", "frame": "fsd", "world": "ned", "time": time,
            "channels": {"z": {"column": "depth", "unit": "ft"}},
        }, "test",
    )  # fmt: skip


@pytest.mark.parametrize(
    ("time", "head", "stamps"),
    [
        ({"kind": "elapsed", "columns": ["t"], "unit": "ms"}, "t", ["0", "100", "250"]),
        ({"kind": "epoch", "columns": ["t"], "unit": "s"}, "t", ["1700000000.000", "1700000000.100", "1700000000.250"]),
        ({"kind": "epoch", "columns": ["t"], "unit": "ns"}, "t", ["1700000000000000000", "1700000000100000000", "1700000000250000000"]),
        (
            {"kind": "datetime", "columns": ["t"]}, "t",
            ["2023-11-14T22:13:20.000Z", "2023-11-14T22:13:20.100Z", "2023-11-14T22:13:20.250Z"],
        ),
        ({"kind": "datetime", "columns": ["d", "t"]}, "d,t", ["2023-11-14,22:13:20.000", "2023-11-14,22:13:20.100", "2023-11-14,22:13:20.250"]),
    ],
)  # fmt: skip
def test_every_kind_of_stamp(tmp_path, time, head, stamps):
    path = tmp_path / "g.csv"
    path.write_text(f"{head},depth\n" + "".join(f"{s},{i}\n" for i, s in enumerate(stamps)))
    raw = read_csv(path, generic(**time))
    assert np.allclose(raw.channels["z"].t, [0, 0.1, 0.25], atol=1e-6) and np.allclose(raw.channels["z"].values, 0.3048 * np.arange(3))
    assert raw.t0_ns == (None if time["kind"] == "elapsed" else 1_700_000_000_000_000_000)


def test_unreadable_datetimes_are_refused(tmp_path):
    path = tmp_path / "g.csv"
    path.write_text("t,depth\nyesterday,1\ntoday,2\n")
    with pytest.raises(BadInput, match="'yesterday'"):
        read_csv(path, generic(kind="datetime", columns=["t"]))


def test_a_merlin_log_that_has_the_tanks_columns_as_well_is_merlins(tmp_path):
    """Both profiles find all their columns in it: what a log of the tank never has decides."""
    tank = load_profile("bluerov2_tank")
    more = {str(c.column): ["0.5"] * 300 for c in tank.channels.values()} | {"timestamp_ns": [str(1_700_000_000_000_000_000 + i * 10**8) for i in range(300)]}
    path = tmp_path / "both.csv"
    path.write_text(text(more))
    assert read(path).profile == "bluerov2_tank"
    path.write_text(text(columns() | more))
    assert read(path).profile == "merlin"


def test_an_angle_averaged_across_the_wrap_is_dropped(tmp_path):
    """Half way between 359 and 1 degrees a careless average says 180: published logs hold such samples."""

    def spoil(cells):
        at = next(i for i in range(300) if float(cells["Heading"][i]) > 350.0 and float(cells["Heading"][i + 1]) < 10.0)
        cells["Heading"][at] = "180.0"

    raw = edited(tmp_path, spoil)
    assert len(raw.channels["psi"].t) == 299 and found(raw, "angle_spike")[0].where == "psi"


def test_two_columns_for_one_thruster_are_refused(tmp_path):
    path = tmp_path / "twice.csv"
    path.write_text(text(columns() | {"HFP PV": ["1"] * 300}))
    with pytest.raises(BadInput, match=r"two columns are 'n:HFP'"):
        read(path)


def test_a_large_export_is_recognised_by_its_beginning(tmp_path):
    """The profile is chosen from the first 256 KiB, cut at a line, also when that cuts a letter of two bytes."""
    cells = columns(3000) | {"Merknad": ["sjø" * 20] * 3000}
    path = tmp_path / "large.csv"
    path.write_text(text(cells), encoding="utf-8")
    assert len(read(path).channels["u"].t) == 3000


def test_rows_in_no_order_of_time_are_refused(tmp_path):
    """Taken for a clock set back again and again, half a minute of rows became hours, with a flawless score on what was left."""

    def shuffle(cells):
        order = np.random.default_rng(1).permutation(300)
        for name, column in cells.items():
            cells[name] = [column[k] for k in order]

    with pytest.raises(BadInput, match=r"the stamps go back \d+ times in 300 rows"):
        read(write(tmp_path, edit=shuffle), "merlin")


def test_a_channel_in_the_wrong_unit_is_masked_whole(tmp_path):
    """Millimetres a second read as metres: the few samples near rest that look sane are no measurement."""

    def in_millimetres(cells):
        cells["LinVelX"] = [f"{1000 * float(x):.1f}" for x in cells["LinVelX"]]

    run = open_run(write(tmp_path, edit=in_millimetres), "merlin")
    assert not run.measured("u")
    (finding,) = [f for f in run.findings if f.code == "out_of_range"]
    assert finding.where == "u"
    assert "is its unit right in the profile?" in finding.detail


def test_what_an_instrument_writes_without_a_fix_leaves_its_other_samples_alone(tmp_path):
    def no_bottom_lock(cells):
        cells["LinVelX"][:200] = ["-32.768"] * 200

    run = open_run(write(tmp_path, edit=no_bottom_lock), "merlin")
    assert run.ok("u").sum() == pytest.approx(100, abs=1)


@pytest.mark.parametrize("length", [12, 80])
def test_two_blocks_of_rows_that_changed_places_are_put_back(tmp_path, length):
    """Eight seconds of rows exported after the eight that follow them were taken for a clock that jumps by 16 s."""
    cells = columns(600)
    order = [*range(200), *range(200 + length, 200 + 2 * length), *range(200, 200 + length), *range(200 + 2 * length, 600)]
    path = tmp_path / "blocks.csv"
    path.write_text(text({k: [v[i] for i in order] for k, v in cells.items()}))
    raw, whole = read(path), read(write(tmp_path, 600))
    (finding,) = found(raw, "swapped_block")
    assert f"line {202 + length}" in finding.detail and not found(raw, "clock_step")
    assert np.array_equal(raw.channels["u"].values, whole.channels["u"].values)
    assert np.allclose(raw.channels["u"].t, whole.channels["u"].t)


def test_a_spike_of_telemetry_is_dropped_and_a_burst_of_thrust_stays(tmp_path):
    """9999 rpm in single rows drove the simulator out of sane limits, or hid in the average."""

    def edit(cells):
        for row in (50, 130, 131, 222):
            cells["HFP_PV"][row] = "9999"
        cells["HFS_PV"] = ["10"] * 300
        cells["HFS_PV"][100:110] = ["250"] * 10

    raw = read(write(tmp_path, edit=edit))
    (finding,) = found(raw, "speed_spike")
    assert finding.where == "n:HFP" and "4 values of up to 9999 rpm" in finding.detail
    assert len(raw.channels["n:HFP"].t) == 296 and np.abs(raw.channels["n:HFP"].values).max() < 5.0
    assert raw.channels["n:HFS"].values.max() == pytest.approx(250 / 60)


def test_what_is_true_of_every_thruster_is_said_once(tmp_path):
    """Seven lines of blank cells pushed out of the terminal that no feedback was there at all."""

    def edit(cells):
        for name in cells:
            if name.endswith("_PV"):
                cells[name] = ["NaN"] * 300

    raw = read(write(tmp_path, edit=edit))
    (blank,), (empty,) = found(raw, "blank_cell"), found(raw, "empty_channel")
    assert blank.where.count("_PV") == 7 and blank.detail.startswith("300 blank cells") and empty.where.count("n:") == 7


def test_an_endless_cell_is_quoted_by_its_beginning(tmp_path):
    """Half a million digits reached the terminal."""

    def edit(cells):
        cells["LinVelZ"][5] = "9" * 500_000

    (finding,) = found(read(write(tmp_path, edit=edit)), "not_a_number")
    assert "... of 500000 characters" in finding.detail and len(finding.detail) < 200
