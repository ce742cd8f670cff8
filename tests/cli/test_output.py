"""Progress: a bar that knows its end on a terminal, nothing elsewhere, and out of the way of what is printed."""

from __future__ import annotations

import gzip
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


@pytest.mark.parametrize("name", ["csv", "csv.gz", "bag", "db3", "mcap ros2", "json lines", "nmea", "xlsx", "mat v5", "mat v7.3", "hdf5", "parquet", "ulg"])
def test_a_reader_tells_how_much_of_the_file_it_has_read(tmp_path, name):
    write, profile_of = CASES[name]
    path, heard = write(tmp_path), list[float]()
    read(path, profile_of(tmp_path), progress=lambda step, share: heard.append(share))
    assert heard and heard == sorted(heard) and heard[0] >= 0.0 and heard[-1] <= 1.0
    assert heard[-1] >= 0.5 or len(heard) == 1, "a short file of lines is told of once"


def test_unpacking_is_told_before_reading(tmp_path):
    """A compressed bag stood still for as long as it was unpacked."""
    write, profile_of = CASES["bag"]
    packed, heard = tmp_path / "a.bag.gz", list[tuple[str, float]]()
    packed.write_bytes(gzip.compress(write(tmp_path).read_bytes()))
    read(packed, profile_of(tmp_path), progress=lambda step, share: heard.append((step, share)))
    assert heard[0][0] == "unpacking" and heard[-1][0] == "reading messages"
    assert max(share for step, share in heard if step == "unpacking") == 1.0


def test_the_time_that_is_left_is_told_once_it_can_be(monkeypatch):
    clock = iter([100.0, 101.0, 110.0])
    monkeypatch.setattr("rovval.cli.output.time.monotonic", lambda: next(clock))
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    show = output.progress()
    show("fit", 0.1)
    assert "left" not in terminal.getvalue(), "a second tells nothing"
    show("fit", 0.25)
    assert terminal.getvalue().endswith("25 %, 30 s left")


def test_a_batch_writes_lines_where_there_is_no_terminal(monkeypatch, capsys):
    clock = iter([0.0, 1.0, 2.0, 13.0, 14.0])
    monkeypatch.setattr("rovval.cli.output.time.monotonic", lambda: next(clock))
    show = output.progress_of_many()
    for number in range(5):
        show(f"{number + 1} of 5 logs", (number + 1) / 5)
    told = [line.split("  ")[1] for line in capsys.readouterr().err.splitlines()]
    assert told == ["1 of 5 logs", "4 of 5 logs", "5 of 5 logs"], "the first, one after ten seconds, the last"
    output.progress_of_many(quiet=True)("x", 0.5)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(("environment", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False)])
def test_colour_stands_on_a_terminal_alone_and_never_with_no_color(monkeypatch, environment, coloured):
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert output.styled("x", fg="red") == "x", "no terminal"
    monkeypatch.setattr(sys, "stdout", Terminal())
    assert ("\x1b[" in output.styled("x", fg="red")) is coloured


def test_headings_are_bold_on_a_terminal_and_nothing_else_changes(monkeypatch, capsys):
    text = "The answer.\n  where  surge\n\nplain\n"
    output.result_in_sections(text)
    assert capsys.readouterr().out == text + "\n"
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stdout", terminal := Terminal())
    output.result_in_sections(text)
    assert terminal.getvalue() == "\x1b[1mThe answer.\x1b[0m\n  where  surge\n\nplain\n\n"
