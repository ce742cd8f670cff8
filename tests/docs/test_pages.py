"""The documentation's commands, run as they are written there, and every command that stands in it is one that exists."""

from __future__ import annotations

import functools
import re
import shlex
import shutil
from pathlib import Path
from typing import Any

import pytest
import typer
from own_log import write_own_log
from typer.testing import CliRunner

from conftest import ROOT
from rovval import demo
from rovval.cli.app import app

DOCS = ROOT / "docs"
PAGES = [*sorted(DOCS.rglob("*.md")), ROOT / "README.md"]
BLOCK = re.compile(r"(?:^<!-- (.+?) -->\n)?^```(\w*)\n(.*?)^```", re.MULTILINE | re.DOTALL)


@functools.cache
def application() -> Any:
    return typer.main.get_command(app)


def words_of(line: str) -> tuple[list[str], str]:
    """The words behind `rovval` as a shell reads them, and the file that the output goes to."""
    words = shlex.split(line, comments=True)[1:]
    words = words[: words.index("&&")] if "&&" in words else words
    return (words[: words.index(">")], words[words.index(">") + 1]) if ">" in words else (words, "")


def commands(text: str) -> list[str]:
    """Every `rovval ...` line of the blocks of a page; what three spaces divide from it is no part of it."""
    fenced = [line for _, _, block in BLOCK.findall(text) for line in block.splitlines()]
    indented = re.findall(r"^    (rovval .*)$", BLOCK.sub("", text), re.MULTILINE)
    return [re.split(r"\s{3,}", line.strip())[0] for line in (*fenced, *indented) if line.strip().startswith("rovval ")]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_command_of_a_page_exists_with_its_options(page: Path):
    for line in commands(page.read_text(encoding="utf-8")):
        command, words, name = application(), words_of(line)[0], "rovval"
        while words and words[0] in getattr(command, "commands", {}):
            name, command = f"{name} {words[0]}", command.commands[words.pop(0)]
        assert not hasattr(command, "commands"), f"{line}: {name} has no command {words[:1]}"
        known = {option for parameter in command.params for option in (*parameter.opts, *parameter.secondary_opts)} | {"--help"}
        asked = {word.partition("=")[0] for word in words if re.match(r"--?[a-z]", word)}
        assert asked <= known, f"{line}: {asked - known}"


def blocks(page: str) -> list[tuple[str, str]]:
    """What is run and what is written of a page, in its order: the marker, the block."""
    found = BLOCK.findall((DOCS / page).read_text(encoding="utf-8"))
    return [(marker, block) for marker, _, block in found if marker.partition(":")[0] in ("run", "file")]


def follow(page: str) -> int:
    """Do what a page says; how many commands that were."""
    done = 0
    for marker, block in blocks(page):
        kind, _, what = (part.strip() for part in marker.partition(":"))
        if kind == "file":
            Path(what).parent.mkdir(parents=True, exist_ok=True)
            Path(what).write_text(block, encoding="utf-8")
            continue
        for line in block.splitlines():
            done += 1
            follow_line(line, int(what.removeprefix("exit ") or 0))
    return done


def follow_line(line: str, code: int) -> None:
    words, target = words_of(line)
    result = CliRunner().invoke(app, words)
    assert result.exit_code == code, f"{line}\n{result.output}\n{result.exception!r}"
    if target:
        Path(target).write_text(result.stdout, encoding="utf-8")


@pytest.fixture(autouse=True)
def _an_empty_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_my_csv():
    write_own_log(Path("my_log.csv"), seconds=30)
    assert follow("how-to/csv.md") == 4
    assert len(list(Path("reports").glob("*/report.html"))) == 1


@pytest.mark.slow
def test_my_vehicle():
    """Takes a minute: it fits a coefficient."""
    write_own_log(Path("my_log.csv"))
    Path("my_log.toml").write_text(dict(blocks("how-to/csv.md"))["file: my_log.toml"], encoding="utf-8")
    assert follow("how-to/vehicle.md") == 6
    assert Path("tuned.toml").is_file() and Path("reports/tuned/report.html").is_file()


@pytest.mark.slow
def test_my_batch():
    log = demo.unpack(Path("pipelines/logs"))
    assert follow("how-to/batch.md") == 5
    assert log.is_file() and Path("reports/night/index.html").is_file() and Path("reports/night/summary.json").is_file()


def test_the_gate():
    shutil.copy(demo.unpack(Path("unpacked")), "dive.csv")
    assert follow("how-to/gate.md") == 5
    assert Path("comparison.json").read_text(encoding="utf-8").startswith("{")


def test_the_python_page():
    shutil.copy(demo.unpack(Path("unpacked")), "dive.csv")
    [code] = [block for marker, _, block in BLOCK.findall((DOCS / "reference" / "python.md").read_text(encoding="utf-8")) if marker == "python"]
    exec(code, {})  # the page's own lines
    assert Path("comparison.html").read_text(encoding="utf-8").startswith("<!doctype html>")


@pytest.mark.slow
def test_the_tutorial():
    """Takes a minute: it diagnoses three minutes of log. What the page says of the result is held against it."""
    assert follow("tutorial.md") == 10
    page = (DOCS / "tutorial.md").read_text(encoding="utf-8")
    found = Path("reports/diagnosis/diagnosis.md").read_text(encoding="utf-8")
    assert "Axial inflow loss" in found and "Axial inflow loss" in page
    assert Path("mended.toml").is_file() and (Path("reports/diagnosis") / "run.rrd").is_file()
    assert Path("dive.bag").stat().st_size > 10**6
