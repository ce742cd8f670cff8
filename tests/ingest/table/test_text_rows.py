"""A table read in blocks is the table read at once, wherever a block ends."""

from __future__ import annotations

import numpy as np
import pytest
from merlin_case import columns, text

from rovval.core.errors import BadInput
from rovval.ingest.table.header import Header
from rovval.ingest.table.number_columns import NumberColumns
from rovval.ingest.table.text_rows import TextRows

HEADER = ("t", "a", "b")
LINES = ["0,1,2", "1,,2.5", "2, 3 ,nan", '3,"4",5', "4,x,6", "5,6", "# a note", "", "6,7,8,9", "6,7,8", "6,7,8", "t,a,b", "7,1e3,-", "8,5,6,", "9,1,1"]
WRITINGS = {
    "utf-8": lambda text: text.encode(),
    "windows": lambda text: text.replace("\n", "\r\n").encode(), "old mac": lambda text: text.replace("\n", "\r").encode(),
    "utf-16": lambda text: text.encode("utf-16"),
    "mark": lambda text: b"\xef\xbb\xbf" + text.encode(), "latin-1": lambda text: ("\xe6" + text).encode("latin-1"),
}  # fmt: skip


def read(path, size, separator=",", texts=None):
    table = TextRows(path, Header(HEADER, 1, separator), size)
    columns = NumberColumns({"time.t": 0, "a": 1, "b": 2}, texts or {}, separator, 3)
    for rows in table.blocks():
        columns.take(rows)
    values, text, lines, again = columns.arrays()
    return values, text, lines.tolist(), [str(f) for f in (*table.findings(), *again, *columns.findings("x"))]


@pytest.mark.parametrize("writing", WRITINGS)
@pytest.mark.parametrize("size", [16, 23, 40, 64, 100, 1 << 24])
def test_blocks_of_any_size_hold_the_same_rows(writing, size, tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(WRITINGS[writing]("banner\n" + "\n".join([",".join(HEADER), *LINES]) + "\n"))
    values, _, lines, findings = read(path, size)
    assert lines == [3, 4, 5, 6, 7, 12, 15, 16, 17]
    assert np.array_equal(values["a"], [1, np.nan, 3, 4, np.nan, 7, 1000, 5, 1], equal_nan=True)
    assert np.array_equal(values["b"], [2, 2.5, np.nan, 5, 6, 8, np.nan, 6, 1], equal_nan=True)
    assert findings == [
        "ragged_row: lines 8, 11: 2 rows without the header's 3 cells; dropped",
        "repeated_row: line 13: 1 row repeated, stamp included; dropped",
        "blank_cell: a: 1 blank cell, from line 4; taken as missing",
        "not_a_number: a: 1 cell without a number ('x'; line 7); dropped",
        "blank_cell: b: 2 blank cells, from line 5; taken as missing",
    ]


@pytest.mark.parametrize("size", [30, 1 << 24])
def test_a_decimal_comma_is_one_in_every_block(size, tmp_path):
    path = tmp_path / "a.csv"
    rows = "".join(f"{i};{i},5;{i}\n" for i in range(50))
    path.write_text("\nt;a;b\n" + rows)
    values, _, _, findings = read(path, size, ";")
    assert np.array_equal(values["a"], np.arange(50) + 0.5) and findings == []
    path.write_text("\nt;a;b\n" + rows + "50;1.5;2\n")
    with pytest.raises(BadInput, match=r"decimal commas, and further on decimal points|50 of 51 cells are not numbers, such as '0,5'"):
        read(path, size, ";")


def test_stamps_are_kept_as_text_beside_their_numbers(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("\nt,a,b\n" + "".join(f"17000000000000000{i:02d},1,2\n" for i in range(40)))
    _, text, _, _ = read(path, 50, texts={"time.t": 0})
    assert text["time.t"].to_list() == [f"17000000000000000{i:02d}" for i in range(40)]


def test_a_file_without_line_ends_is_no_table_and_needs_no_memory(tmp_path):
    path = tmp_path / "a.csv"
    path.write_bytes(b"\nt,a,b\n" + b"1,2,3" * 1000)
    _, _, lines, findings = read(path, 64)
    assert lines == [] and findings and "1 row without the header's 3 cells" in findings[0]


def test_a_log_of_many_blocks_is_read_as_one(tmp_path):
    path = tmp_path / "merlin.csv"
    path.write_text("\n" + text(cells := columns()))
    header = tuple(cells)
    places = {name: at for at, name in enumerate(header)}
    table, read_ = TextRows(path, Header(tuple(header), 1, ","), 1000), NumberColumns(places, {}, ",", len(header))
    for rows in table.blocks():
        read_.take(rows)
    values, _, lines, again = read_.arrays()
    assert lines.tolist() == list(range(3, 303)) and not again and not table.findings()
    assert all(np.array_equal(values[name], np.array(cells[name], dtype=float)) for name in header)


def test_mostly_no_numbers_is_refused_however_it_is_cut_into_blocks(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("\nt,a,b\n" + "".join(f"{i},{'x' if i % 3 else 1},2\n" for i in range(60)))
    with pytest.raises(BadInput, match="column 'a': 40 of 60 cells are not numbers, such as 'x', 'x', 'x'"):
        read(path, 50)
