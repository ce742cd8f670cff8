"""`rovval import-vehicle` as a script sees it: files, exit codes, and messages that name every problem at once."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rovval.cli.app import app
from rovval.core.errors import BadVehicle, RovvalError, UsageProblem
from rovval.vehicle import load

MODEL = """
pid:
  mass: 1862.87
  inertial: {ixx: 525.39, ixy: 1.44, ixz: 33.41, iyy: 794.2, iyz: 2.6, izz: 691.23}
  volume: 1.838
  length: 2.6
  width: 1.5
  height: 1.6
  cog: [0.0, 0.0, 0.0]
  cob: [0.0, 0.0, 0.3]
  Ma: [779.79, 1222.0, 3659.9, 534.9, 842.69, 224.32]
  linear_damping: [-74.82, -69.48, -728.4, -268.8, -309.77, -105]
  linear_damping_forward_speed: [0, 0, 0, 0, 0, 1.5]
  quad_damping: [-748.22, -992.53, -1821.01, -672, -774.44, -523.27]
"""
TAM = """tam:
- [0.7, 0.7, 0.7, 0.7, 0, 0, 0]
- [0.7, -0.7, -0.7, 0.7, 0, 0, 1]
- [0, 0, 0, 0, 1, 1, 0]
- [0, 0, 0, 0, 0.4, -0.4, 0]
- [0, 0, 0, 0, 0, 0, 0]
- [-0.5, 0.5, -0.5, 0.5, 0, 0, 0]
"""
MANAGER = "thruster_manager:\n  conversion_fcn: proportional\n  conversion_fcn_params: {gain: 0.00031}\n"
FILES = ("model.yaml", "TAM.yaml", "manager.yaml")


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in zip(FILES, (MODEL, TAM, MANAGER), strict=True):
        Path(name).write_text(text)
    return tmp_path


def run(*args: str):
    done = CliRunner().invoke(app, list(args))
    if isinstance(done.exception, RovvalError):
        raise done.exception
    assert done.exit_code == 0, done.output
    return done


def test_what_is_written_is_a_vehicle_that_simulates(here):
    done = run("import-vehicle", *FILES, "--out", "deep/rexrov.toml")
    assert "deep/rexrov.toml" in done.stdout and "linear_damping_forward_speed" in done.stderr
    v = load("deep/rexrov.toml")
    assert (v.name, v.body.size, v.body.linear_drag[0]) == ("rexrov", (2.6, 1.5, 1.6), 74.82)
    assert v.sources["density"].startswith("assumed"), "the files hold no density"
    assert json.loads(run("show", "vehicle", "deep/rexrov.toml", "--json").stdout)["hash"] == v.hash
    run("scenario", "2", "--vehicle", "deep/rexrov.toml")


def test_a_file_that_is_there_is_kept_unless_asked(here):
    Path("mine.toml").write_text("precious")
    with pytest.raises(UsageProblem, match="--overwrite"):
        run("import-vehicle", *FILES, "--out", "mine.toml")
    assert Path("mine.toml").read_text() == "precious"
    done = run("import-vehicle", *FILES, "--out", "mine.toml", "--name", "rexrov", "--overwrite", "--json", "-q")
    assert json.loads(done.stdout)["hash"] == load("mine.toml").hash
    assert load("mine.toml").name == "rexrov"
    assert not done.stderr


def test_every_problem_is_named_at_once_and_nothing_is_written(here):
    model = MODEL.replace("mass: 1862.87", "mass: $(arg mass)").replace("cob: [0.0, 0.0, 0.3]", "cob: [0, .nan, 0]")
    model = model.replace("ixx: 525.39, ", "").replace("iyy: 794.2", "iyy: many").replace("  volume: 1.838\n", "")
    Path("model.yaml").write_text(model.replace("Ma: [779.79,", "Ma: ["))
    Path("TAM.yaml").write_text("tam: [[1, 0], [0, 0], [0, 0], [0, 0], [0, 0], [0, 1]]")
    Path("manager.yaml").write_text("conversion_fcn_params: [{gain: 0.0}, {input: [0, 1], output: [0, 1]}]")
    before = sorted(Path().rglob("*"))
    with pytest.raises(BadVehicle) as refused:
        run("import-vehicle", *FILES, "--out", "new.toml")
    for words in (
        "volume is in none", "mass is '$(arg mass)', not a number", "cob is [0, nan, 0], not 3 numbers", "Ma is [", "inertial.ixx is missing",
        "inertial.iyy is 'many', not a number", "column 2: no force", "1 gains", "gain 0 of thruster 0", "next: ",
    ):  # fmt: skip
        assert words in str(refused.value)
    assert sorted(Path().rglob("*")) == before


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "x.yaml: No such file"),
        ("a: [1, ", "x.yaml is not YAML"),
        ("just words", "mass is in none of the files"),
        ("tam: 5", "tam is 5, not 6 rows"),
        ("inertial: heavy", "inertial is 'heavy'"),
        (MODEL.replace("volume: 1.838", "volume: 9.0") + TAM + MANAGER, "buoyancy"),
        (MODEL.replace("quad_damping: [-", "quad_damping: [") + TAM + MANAGER, "quadratic_drag"),
    ],
)
def test_files_that_are_no_vehicle_are_refused(here, content, words):
    if content is not None:
        Path("x.yaml").write_text(content)
    with pytest.raises(BadVehicle) as refused:
        run("import-vehicle", "x.yaml", "--out", "new.toml")
    assert words in str(refused.value)
    assert not Path("new.toml").exists()


def test_a_name_that_no_command_would_take_is_refused(here):
    with pytest.raises(UsageProblem, match=r"new\.toml"):
        run("import-vehicle", *FILES, "--out", "new.txt")
