"""The command line before any work: help, completion, what loads, exit codes of wrong usage."""

import os
import subprocess
import sys
from collections.abc import Iterator
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from rovval.cli import complete
from rovval.cli.app import COMMANDS, app

CONTRACT = {"demo", "ingest", "simulate", "compare", "diagnose", "fit", "scenario", "run", "view", "list", "show", "blind", "import-vehicle"}
CONTRACT |= {"archive", "export", "inspect", "profile", "trend", "fly", "report"}
NAMES = [name for name, _, _ in COMMANDS]
HEAVY = ("numpy", "polars", "numba", "scipy", "rerun", "pydantic", "rosbags", "mcap", "rich")
RUNNER = CliRunner()


def rovval(*args: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the command as a shell does: its exit code, stdout and stderr are what scripts see."""
    return subprocess.run(
        [sys.executable, "-m", "rovval", *args], capture_output=True, text=True, env={**os.environ, **environment}, check=False
    )


def test_every_command_of_the_contract_is_listed():
    shown = RUNNER.invoke(app, ["--help"])
    assert shown.exit_code == 0
    assert set(NAMES) | {"blind", "profile"} == CONTRACT
    for name in CONTRACT:
        assert f"\n  {name} " in shown.output


@pytest.mark.parametrize("name", NAMES)
def test_help_of_each_command_has_an_example(name):
    shown = RUNNER.invoke(app, [name, "--help"])
    assert shown.exit_code == 0
    assert f"Example:\n    rovval {name}" in shown.output


def groups(group: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """The words of every command, those of groups and of what is in them."""
    yield path
    for name, command in getattr(group, "commands", {}).items():
        yield from groups(command, (*path, name))


@pytest.mark.parametrize("words", list(groups(typer.main.get_command(app))), ids=" ".join)
def test_no_line_of_help_is_wider_than_a_terminal(words):
    """Examples, too, which are not broken by whoever prints them."""
    shown = RUNNER.invoke(app, [*words, "--help"], env={"COLUMNS": "80"})
    assert shown.exit_code == 0
    assert [line for line in shown.output.splitlines() if len(line) > 80] == []


def test_help_loads_nothing_heavy():
    """Asserted on what is loaded, not on time: a machine under load must not fail this. (typer itself loads pydantic for the
    types of a command's options, so it is let through there and not in `rovval --help`.)"""
    code = (
        "import sys, rovval.cli, rovval.cli.app as cli\n"
        "def loaded():\n"
        f"    return [m for m in {HEAVY!r} if m in sys.modules]\n"
        "from typer.testing import CliRunner\n"
        "assert CliRunner().invoke(cli.app, ['--help']).exit_code == 0\n"
        "print(loaded())\n"
        "for name, _, _ in cli.COMMANDS:\n"
        "    assert CliRunner().invoke(cli.app, [name, '--help']).exit_code == 0\n"
        "print([m for m in loaded() if m != 'pydantic'])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n") == ["[]", "[]", ""]


def test_version():
    assert RUNNER.invoke(app, ["--version"]).output.startswith("rovval ")


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("rovval com", "compare"),
        ("rovval compare --vehicle mer", "merlin"),
        ("rovval compare --profile mer", "merlin"),
        ("rovval simulate --effect added", "added_mass"),
        ("rovval show metric ia", "iae"),
        ("rovval list veh", "vehicle"),
    ],
)
def test_completion_from_file_names(words, expected):
    done = rovval(_ROVVAL_COMPLETE="complete_bash", COMP_WORDS=words, COMP_CWORD=str(len(words.split()) - 1))
    assert expected in done.stdout.split()


def test_completion_of_paths(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "logs").mkdir()
    (tmp_path / "logs" / "dive.csv").touch()
    (tmp_path / "archive" / "run_1").mkdir(parents=True)
    assert complete.sources("lo") == ["logs/"]
    assert complete.sources("logs/d") == ["logs/dive.csv"]
    assert complete.sources("run") == ["run_1"]
    assert complete.sources("nowhere/x") == []


@pytest.mark.parametrize(
    "args",
    [
        ["nope"],
        ["compare"],
        ["compare", "x.csv", "--model", "gazebo"],
        ["compare", "x.csv", "--nope"],
        ["scenario", "6"],
        ["scenario", "1", "x.csv"],
        ["list", "nothing"],
        ["show", "vehicle", "nope"],
        ["show", "effect", "nope"],
        ["show", "profile", "nope"],
        ["show", "metric", "nope"],
        ["run", "nowhere.toml"],
        ["compare", "x.csv", "--fail-above", "surge"],
    ],
    ids=" ".join,
)
def test_wrong_usage_is_exit_2_and_one_message(args):
    done = rovval(*args)
    assert done.returncode == 2
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    assert done.stderr.strip()


def test_without_arguments_the_help_is_shown():
    done = rovval()
    assert done.returncode == 2
    assert "Usage: rovval" in done.stdout + done.stderr
