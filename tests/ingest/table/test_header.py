"""Tables whose first lines are not names and then numbers: without names at all, or with a line of units below them."""

from __future__ import annotations

import merlin_case
import numpy as np
import pytest

from rovval.core.errors import BadInput, UsageProblem
from rovval.ingest import read
from rovval.ingest.formats.csv_log import contents
from rovval.ingest.profile import load_profile

OWN = """
name = "own"
description = "of the tests"
format = "{format}"
frame = "fsd"
world = "ned"
header = {header}
[time]
kind = "elapsed"
columns = ["t"]
[channels]
u = {{ column = "speed", unit = "{unit}" }}
z = {{ column = "depth", unit = "m" }}
"""
UNITS = {"Depth": "m", "Roll": "deg", "Heading": "[deg]", "LinVelX": "m/s", "LinVelY": "(m/s)", "AngVelX": "deg/s", "Latitude": "°"}


def own(folder, header="[]", unit="m/s", form="csv_log"):
    (folder / "own.toml").write_text(OWN.format(format=form, header=header, unit=unit))
    return str(folder / "own.toml")


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_a_table_without_a_line_of_names(tmp_path, separator):
    path = tmp_path / "dive.csv"
    lines = [separator.join((f"{0.1 * i:.1f}", f"{0.01 * i:.2f}", f"{3 + i}")) for i in range(50)]
    path.write_text("\n".join(lines) + "\n")
    log = read(path, own(tmp_path, '["t", "speed", "depth"]'))
    assert log.channels["u"].values == pytest.approx(0.01 * np.arange(50)) and log.channels["z"].values[0] == 3.0, "the first line is a row, too"
    assert log.findings == () and log.properties["rows"] == "50"


def test_a_header_that_is_not_the_file_s_is_refused(tmp_path):
    (tmp_path / "dive.csv").write_text("0.0,1,2\n0.1,1,2\n")
    with pytest.raises(BadInput, match="no line has the 4 cells"):
        read(tmp_path / "dive.csv", own(tmp_path, '["t", "speed", "depth", "more"]'))
    with pytest.raises(UsageProblem, match=r"(?s)'t' stand there twice.*"):
        load_profile(own(tmp_path, '["t", "t", "depth"]'))
    with pytest.raises(UsageProblem, match="header is for tables of text"):
        load_profile(own(tmp_path, '["t", "speed", "depth"]', form="parquet"))


def with_units(folder, units):
    lines = merlin_case.text(merlin_case.columns(60)).splitlines()
    names = lines[0].split(",")
    rows = [lines[0], ",".join(units.get(n, "rpm" if n[-3:] in ("_PV", "_SP") else "-") for n in names), *lines[1:]]
    path = folder / "dive.csv"
    path.write_text("\n".join([*rows, rows[0], rows[1]]) + "\n")
    return path


def test_a_line_of_units_is_no_row_and_is_told_as_what_it_is(tmp_path):
    """It was "1 cells are not numbers (m/s; line 2); dropped" for every column."""
    log = read(with_units(tmp_path, UNITS))
    assert log.profile == "merlin" and len(log.channels["u"].values) == 60
    assert [(f.code, f.where) for f in log.findings] == [("units_row", "line 2")], "nor are header and units where a second file was joined"
    block = next(contents(tmp_path / "dive.csv"))
    assert "Heading [deg]" in block.numbers and "Hour" in block.numbers


def test_its_units_are_held_against_the_profile(tmp_path):
    with pytest.raises(BadInput, match=r"column 'LinVelX \[knots\]' says 'knots', the profile says 'm/s'"):
        read(with_units(tmp_path, UNITS | {"LinVelX": "knots"}), "merlin")
