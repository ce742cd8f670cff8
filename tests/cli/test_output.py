"""Progress: a bar that knows its end on a terminal, nothing elsewhere, and out of the way of what is printed."""

from __future__ import annotations

import io
import sys

import pytest
from log_files import CASES

from rovval.cli import output
from rovval.ingest import read


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_a_bar_is_drawn_on_a_terminal_alone(monkeypatch, capsys):
    show = output.progress()
    show("reading rows", 0.5)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    show = output.progress()
    show("reading rows", 0.5)
    assert terminal.getvalue() == f"\rreading rows: [{'#' * 12}{'.' * 12}] 50 %"
    show("", 1.0)
    assert terminal.getvalue().endswith("\r" + " " * len("reading rows: [########################] 50 %") + "\r"), "the line is free again"
    before = terminal.getvalue()
    output.progress(quiet=True)("reading rows", 0.5)
    assert terminal.getvalue() == before


@pytest.mark.parametrize("name", ["csv", "csv.gz", "bag", "db3", "mcap ros2", "json lines", "nmea"])
def test_a_reader_tells_how_much_of_the_file_it_has_read(tmp_path, name):
    write, profile_of = CASES[name]
    path, heard = write(tmp_path), list[float]()
    read(path, profile_of(tmp_path), progress=lambda step, share: heard.append(share))
    assert heard and heard == sorted(heard) and heard[0] >= 0.0 and heard[-1] <= 1.0
    assert heard[-1] > 0.5 or len(heard) == 1, "a short file of lines is told of once"
