"""What the commands say of the logs that they were given, before any number about them."""

import json
from dataclasses import replace
from datetime import UTC, datetime

import pytest
from merlin_case import columns, text, write
from typer.testing import CliRunner

from rovval.cli import logs
from rovval.cli.app import app
from rovval.core.errors import BadInput, Finding, UsageProblem
from rovval.ingest.profile import FOLDER
from rovval.storage.archive import open_run

RUNNER = CliRunner()


def spoilt(cells):
    cells["Depth"][100:200] = ["99999"] * 100


@pytest.mark.parametrize("command", ["compare", "simulate"])
def test_what_was_found_in_a_log_is_said_beside_its_result(tmp_path, monkeypatch, command):
    """A depth of 100 km is masked: the table alone would not tell."""
    monkeypatch.chdir(tmp_path)
    write(tmp_path, edit=spoilt)
    done = RUNNER.invoke(app, [command, "dive.csv", "--profile", "merlin", "--json"])
    assert done.exit_code == 0, done.output
    assert "out_of_range: z: 100 samples" in done.stderr
    assert json.loads(done.stdout)["run"] in done.stderr
    quiet = RUNNER.invoke(app, [command, "dive.csv", "--profile", "merlin", "--json", "--quiet"])
    assert "out_of_range" not in quiet.stderr


def test_many_findings_are_counted_not_poured_out(tmp_path, capsys):
    run = open_run(write(tmp_path), "merlin")
    logs.print_findings(replace(run, findings=tuple(Finding("gap", f"c{k}", "long") for k in range(50))))
    said = capsys.readouterr().err.splitlines()
    assert said[0] == f"{run.id}: 50 findings in this log"
    assert len(said) == logs.MOST_FINDINGS + 2
    assert "and 44 more" in said[-1]
    logs.print_findings(replace(run, findings=()))
    assert not capsys.readouterr().err


def test_ingest_says_whose_findings_they_are(tmp_path):
    path = write(tmp_path, edit=spoilt)
    done = RUNNER.invoke(app, ["ingest", str(path), "--profile", "merlin", "--archive", str(tmp_path / "a")])
    assert done.stderr.startswith(f"{done.stdout.strip()}: ")


def test_a_log_given_twice_is_no_second_log(tmp_path):
    """Taken as two, it would narrow every interval by the square root of two: once it was, under another name."""
    path = write(tmp_path)
    for name in ("again/dive.csv", "another_name.csv"):
        copy = tmp_path / name
        copy.parent.mkdir(exist_ok=True)
        copy.write_bytes(path.read_bytes())
        with pytest.raises(UsageProblem, match=rf"{copy.name} is given twice, as .*dive\.csv"):
            logs.opened_as_one([str(path), str(copy)], None, logs.Reading("merlin"))


def test_logs_of_two_vehicles_are_not_taken_for_one(tmp_path, monkeypatch):
    path, other = write(tmp_path), write(tmp_path, 200, "other.csv")
    opened = open_run

    def of_another(source, *rest):
        run = opened(source, *rest)
        return replace(run, vehicle="minerva") if "other" in str(source) else run

    monkeypatch.setattr("rovval.storage.archive.open_run", of_another)
    both = [str(path), str(other)]
    with pytest.raises(UsageProblem, match=r"(?s)dive.csv is of merlin.*other.csv is of minerva"):
        logs.opened_as_one(both, None, logs.Reading("merlin"))
    assert len(logs.opened_as_one(both, "merlin", logs.Reading("merlin"))) == 2


@pytest.mark.parametrize("command", [("fit", "--parameters", "inflow_loss", "--out"), ("diagnose", "--write-vehicle")])
def test_a_vehicle_is_not_written_over_the_one_it_is_made_from(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    (mine := tmp_path / "mine.toml").write_text("# my comments\n")
    write(tmp_path)
    done = RUNNER.invoke(app, [command[0], "dive.csv", "--profile", "merlin", "--vehicle", "mine.toml", *command[1:], str(mine)])
    assert isinstance(done.exception, UsageProblem)
    assert "mine.toml: is the vehicle that was asked for" in str(done.exception)
    assert mine.read_text() == "# my comments\n"


@pytest.mark.parametrize("command", ["compare", "simulate"])
def test_a_stretch_of_a_log_is_taken_and_said(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    write(tmp_path)
    done = RUNNER.invoke(app, [command, "dive.csv", "--profile", "merlin", "--json", "--from", "5", "--to", "25"])
    assert done.exit_code == 0, done.output
    assert json.loads(done.stdout)["run"].endswith("-from5to25s") and "stretch: log: from 5 to 25 s of" in done.stderr
    beyond = RUNNER.invoke(app, [command, "dive.csv", "--profile", "merlin", "--from", "5", "--to", "2500"])
    assert isinstance(beyond.exception, BadInput) and "beyond the log" in beyond.exception.message


def stamped(folder):
    """A dive whose stamps are date and time without a zone, and its profile."""
    cells = columns(300)
    stamps = [f"2024-06-01 {int(h):02d}:{int(m):02d}:{int(s):02d}.{int(ms):03d}" for h, m, s, ms in zip(*list(cells.values())[:4], strict=True)]
    (folder / "dive.csv").write_text(text({"Stamp": stamps, **dict(list(cells.items())[4:])}), encoding="utf-8")
    profile = (FOLDER / "merlin.toml").read_text(encoding="utf-8")
    time = 'kind = "time_of_day"\ncolumns = ["Hour", "Minute", "Second", "Millisecond"]'
    (folder / "mine.toml").write_text(profile.replace(time, 'kind = "datetime"\ncolumns = ["Stamp"]'), encoding="utf-8")
    return ["dive.csv", "--profile", "mine.toml", "--timezone", "Europe/Berlin"]


def test_the_zone_of_stamps_that_say_none_is_asked_for_by_every_command(tmp_path, monkeypatch):
    """Only `rovval ingest` had it: a comparison of the same file stood at another hour."""
    monkeypatch.chdir(tmp_path)
    asked = stamped(tmp_path)
    done = RUNNER.invoke(app, ["export", *asked, "--to", "parquet", "--out", "a.parquet", "--json"])
    assert done.exit_code == 0, done.output
    kept = RUNNER.invoke(app, ["ingest", *asked, "--json"])
    assert json.loads(done.stdout)["run"] == json.loads(kept.stdout)["logs"][0]["run"]
    assert open_run(json.loads(done.stdout)["run"]).t0_ns == datetime(2024, 6, 1, 8, tzinfo=UTC).timestamp() * 1e9


def test_another_simulations_stamps_are_in_the_zone_of_the_log(tmp_path, monkeypatch):
    """In UTC they stood two hours beside it: no moment in common."""
    monkeypatch.chdir(tmp_path)
    asked = [*stamped(tmp_path), "--with", "dive.csv", "--with-profile", "mine.toml"]
    done = RUNNER.invoke(app, ["compare", *asked, "--json", "-q"])
    assert done.exit_code == 0, done.output
    beside = json.loads(done.stdout)["other"]["axes"]["surge"]
    assert beside["n"] == 300 and beside["rmse"] == pytest.approx(0.0, abs=1e-9)


def test_every_command_that_takes_a_log_takes_the_same_of_it():
    """By their help: how it is read, in which zone, and which stretch."""
    for command in ("ingest", "simulate", "compare", "diagnose", "fit", "scenario", "export", "view"):
        said = RUNNER.invoke(app, [command, "--help"], env={"COLUMNS": "200"}).stdout
        assert all(option in said for option in ("--profile", "--timezone", "--from", "--until" if command == "export" else "--to")), command
