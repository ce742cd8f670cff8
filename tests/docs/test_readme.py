"""The README's commands, run as they are written there."""

import csv
import gzip
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from conftest import ROOT
from rovval import demo
from rovval.cli.app import COMMANDS, app
from rovval.ingest.profile import load_profile

README = (ROOT / "README.md").read_text(encoding="utf-8")
KNOT = 1852.0 / 3600.0
RENAMED = {
    "LinVelX": "speed_ahead",
    "LinVelY": "speed_right",
    "LinVelZ": "speed_down",
    "AngVelZ": "turn_rate",
    "Depth": "depth",
    "Heading": "heading",
}


def after(marker: str) -> list[str]:
    """The code blocks that follow each <!-- marker -->."""
    return re.findall(rf"<!-- {re.escape(marker)} -->\n```\w*\n(.*?)```", README, re.DOTALL)


def commands(marker: str) -> list[str]:
    return [line for block in after(marker) for line in block.splitlines() if line]


def write_own_log(path: Path, seconds: int = 60) -> None:
    """The sample dive under the names and units of the README's own CSV."""
    with gzip.open(demo.SAMPLE, "rt", encoding="utf-8") as sample:
        rows = list(csv.DictReader(sample))[: seconds * 10]
    thrusters = [name.removesuffix("_PV") for name in rows[0] if name.endswith("_PV")]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["t", *RENAMED.values(), *(f"rpm_{t}" for t in thrusters)])
        for i, row in enumerate(rows):
            values = [float(row[c]) / (KNOT if c.startswith("LinVel") else 1.0) for c in RENAMED]
            writer.writerow([i / 10, *values, *(row[f"{t}_PV"] for t in thrusters)])


def invoke(line: str) -> None:
    """One `rovval ...` line in this process, with `> FILE`."""
    words, _, target = line.partition(" > ")
    done = CliRunner().invoke(app, shlex.split(words)[1:])
    assert done.exit_code == 0, f"{line}\n{done.output}\n{done.exception!r}"
    if target:
        Path(target.strip()).write_text(done.stdout, encoding="utf-8")


def test_there_are_two_commands_that_make_their_own_environment():
    for marker in ("demo", "tests"):
        [command] = commands(marker)
        assert command.startswith("python3 -m venv .venv && .venv/bin/pip install")
    assert commands("demo")[0].endswith(".venv/bin/rovval demo")
    assert commands("tests")[0].endswith(".venv/bin/pytest -n 2 --dist loadfile")


def test_the_tour_on_ones_own_csv(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_own_log(Path("my_log.csv"))
    [profile] = after("file: my_log.toml")
    for line in commands("tour"):
        assert line.startswith("rovval ")
        invoke(line)
        if line.endswith("> my_log.toml"):
            assert load_profile("my_log.toml").name == "merlin"
            Path("my_log.toml").write_text(profile, encoding="utf-8")
    assert Path("diagnosis.json").exists()
    assert len(list(Path("reports").glob("*/report.html"))) == 3


def test_the_notebook_block(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    write_own_log(Path("my_log.csv"))
    Path("my_log.toml").write_text(after("file: my_log.toml")[0], encoding="utf-8")
    invoke("rovval show vehicle merlin > my_vehicle.toml")
    [block] = after("notebook")
    names: dict[str, Any] = {}
    exec(block, names)  # the README's own lines
    assert "surge" in names["comparison"].windowed
    assert names["tuned"].document["parameters"] or names["tuned"].document["undetermined"]
    assert Path("diagnosis.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    assert "verdict" in names["found"].document()
    assert "surge" in capsys.readouterr().out


def test_the_bag_profile_loads(tmp_path):
    [text] = re.findall(r"```toml\n(name = \"my_bag\".*?)```", README, re.DOTALL)
    (tmp_path / "my_bag.toml").write_text(text)
    assert load_profile(tmp_path / "my_bag.toml").format == "ros_bag"


def test_the_batch(tmp_path, monkeypatch):
    """The pipeline as it is shipped, on a log in the folder that it names."""
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "pipelines", "pipelines")
    demo.unpack(Path("pipelines/logs"))
    for log in Path("pipelines/logs").iterdir():
        os.utime(log, (0, 0))
    [line] = commands("batch")
    invoke(line)
    assert len(list(Path("reports/nightly").glob("*/comparison/report.html"))) == 1


def test_every_command_is_in_the_readme_and_every_one_there_exists():
    named = set(re.findall(r"^\| `rovval ([\w-]+)", README, re.MULTILINE)) | {"show"}
    assert named == {name for name, _, _ in COMMANDS} | {"blind"}


def test_no_local_paths_or_names_of_this_machine():
    for name in ("README.md", ".ci/run", "pipelines/nightly.toml", "pyproject.toml"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert "/work/" not in text
        assert "/root/" not in text
        assert str(ROOT) not in text


@pytest.mark.slow
@pytest.mark.parametrize("marker", ["demo", "tests"])
def test_the_two_commands_from_a_fresh_clone(marker, tmp_path):
    """Takes minutes and a network: it makes the environments."""
    if os.environ.get("ROVVAL_README"):
        pytest.skip("already inside the README's test command")
    clone = tmp_path / "rovval"
    subprocess.run(["git", "clone", "--quiet", str(ROOT), str(clone)], check=True)
    [command] = commands(marker)
    path = f"{Path(sys.executable).resolve().parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "ROVVAL_README": "1", "PATH": path}
    environment.pop("VIRTUAL_ENV", None)
    done = subprocess.run(command, shell=True, cwd=clone, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    if marker == "demo":
        assert "SYNTHETIC" in done.stdout
        assert {"report.html", "diagnosis.html", "run.rrd"} <= {p.name for p in (clone / "reports" / "demo").iterdir()}
