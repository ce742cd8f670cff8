"""The README's commands, run as they are written there."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from own_log import write_own_log
from typer.testing import CliRunner

import rovval
from conftest import ROOT
from rovval import demo, vehicle
from rovval.cli.app import COMMANDS, app
from rovval.ingest.profile import load_profile

README = (ROOT / "README.md").read_text(encoding="utf-8")


def after(marker: str) -> list[str]:
    """The code blocks that follow each <!-- marker -->."""
    return re.findall(rf"<!-- {re.escape(marker)} -->\n```\w*\n(.*?)```", README, re.DOTALL)


def commands(marker: str) -> list[str]:
    return [line for block in after(marker) for line in block.splitlines() if line]


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
    assert commands("tests")[0].endswith(".venv/bin/pytest -n 3 --dist loadfile")


def test_the_tour_on_ones_own_csv(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_own_log(Path("my_log.csv"))
    [profile] = after("file: my_log.toml")
    for line in commands("tour"):
        assert line.startswith("rovval ")
        invoke(line)
        if line.endswith("> my_log.toml"):
            assert load_profile("my_log.toml").draft
            Path("my_log.toml").write_text(profile, encoding="utf-8")
    assert Path("diagnosis.json").exists()
    assert "What is seen together" in Path("reports/calibrated/fit.html").read_text(encoding="utf-8")
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


def test_pulse_widths_and_sticks(tmp_path, monkeypatch):
    """Full stick to the right, then down, and the pulse widths that ArduSub makes of it: both logs turn right and sink."""
    monkeypatch.chdir(tmp_path)
    mixer = vehicle.load("bluerov2_heavy").mixer
    assert mixer is not None
    yaw, heave = (mixer.factors[stick] for stick in ("yaw", "heave"))
    header = ["t", "turn_rate", "speed_down"]
    pulses, sticks = [[*header, *(f"servo{i}_raw" for i in range(1, 9))]], [[*header, *(f"chan{i}" for i in range(1, 7))]]
    for k in range(200):
        right, down = (0.5, 0.0) if k < 100 else (0.0, 0.5)
        cells = [f"{k / 10}", f"{0.8 * (k < 100)}", f"{0.2 * (k >= 100)}"]
        pulses.append([*cells, *(f"{1500 + 400 * (right * a + down * b):g}" for a, b in zip(yaw, heave, strict=True))])
        sticks.append([*cells, "1500", "1500", f"{1500 - 400 * down:g}", f"{1500 + 400 * right:g}", "1500", "1500"])
    for name, rows in (("my_pulses", pulses), ("my_sticks", sticks)):
        Path(f"{name}.csv").write_text("".join(",".join(row) + "\n" for row in rows), encoding="utf-8")
        Path(f"{name}.toml").write_text(after(f"file: {name}.toml")[0], encoding="utf-8")
    for line in commands("pulses"):
        invoke(line)
    by = {name: rovval.simulate(rovval.load(f"{name}.csv", f"{name}.toml")) for name in ("my_pulses", "my_sticks")}
    assert [sim.input_source for sim in by.values()] == ["pulse width", "pilot's sticks"]
    for sim in by.values():
        assert sim.windowed.nu[50, 5] > 0.1 and sim.windowed.nu[150, 2] > 0.05
    assert np.allclose(by["my_pulses"].thrust, by["my_sticks"].thrust)


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
    schema = json.loads((ROOT / "docs" / "schemas" / "summary.json").read_text(encoding="utf-8"))
    Draft202012Validator(schema).validate(json.loads(Path("reports/nightly/summary.json").read_text(encoding="utf-8")))


def test_every_command_is_in_the_readme_and_every_one_there_exists():
    named = set(re.findall(r"^\| `rovval ([\w-]+)", README, re.MULTILINE)) | {"show"}
    assert named == {name for name, _, _ in COMMANDS} | {"blind", "profile"}


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
