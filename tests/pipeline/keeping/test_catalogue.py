"""What a batch enters into the catalogue, and how the command line asks it."""

import json

import batch_case
import polars as pl
import pytest
from typer.testing import CliRunner

from rovval.cli.app import app
from rovval.pipeline import batch
from rovval.storage import catalogue

COMPARED = '["ingest", "simulate", "compare"]'


def listed(*args):
    done = CliRunner().invoke(app, ["list", "run", *args])
    return done.exit_code, done.stdout, done.stderr


def test_a_batch_enters_its_runs_and_brings_back_what_was_lost(tmp_path):
    for number, name in enumerate("ab"):
        batch_case.write_log(tmp_path / "logs" / f"{name}.csv", seconds=11, seed=number)
    path, archive = batch_case.write_pipeline(tmp_path, steps=COMPARED), tmp_path / "archive"
    batch.run(path, workers=1)
    table = catalogue.load(archive)
    for row in table.rows(named=True):
        record = json.loads(next((tmp_path / "reports").glob(f"{row['run'][0]}-*/record.json")).read_text())
        axes = record["steps"]["compare"]["comparison"]["window"]["axes"]
        assert [row[axis] for axis in axes] == [axes[axis]["rms"] for axis in axes]
        assert (row["sha256"], row["vehicle"], row["dated_by"], row["year"]) == (record["sha256"], "merlin", "file", row["date"].year)
        assert (archive / row["report"]).read_text(encoding="utf-8").startswith("<!doctype html>")
    assert table["method"].n_unique() == 1 and table["current"].all()
    [file] = archive.glob("catalogue/*/*/*.parquet")
    file.write_bytes(b"PAR1")
    again = batch.run(path, workers=1)
    assert again["counts"]["unchanged"] == 2 and "damaged" in again["damaged"][0]
    assert catalogue.load(archive).drop("evaluated").equals(table.drop("evaluated"))
    code, said, _ = listed("--archive", str(archive), "--where", "surge > 0 and vehicle = 'merlin'", "--json")
    assert code == 0 and [r["run"] for r in json.loads(said)] == table["run"].to_list()
    code, said, _ = listed("--archive", str(archive), "--where", "surge > 0")
    assert [line.split()[0] for line in said.splitlines() if not line.startswith(" ")] == ["run", *table["run"]] and "deg/s" in said
    assert max(map(len, said.splitlines())) <= 80
    code, said, told = listed("--archive", str(archive), "--since", "2999-01-01")
    assert (code, said) == (0, "") and "no such run" in told


def test_the_catalogue_is_no_run_of_the_archive_and_only_runs_can_be_asked_for(tmp_path):
    batch_case.write_log(tmp_path / "logs" / "a.csv")
    batch.run(batch_case.write_pipeline(tmp_path), workers=1)
    code, said, _ = listed("--archive", str(tmp_path / "archive"))
    assert code == 0 and said.split() == catalogue.load(tmp_path / "archive")["run"].to_list()
    assert CliRunner().invoke(app, ["list", "effect", "--where", "surge > 0"]).exit_code == 1  # main() gives the refusal its own code


def test_two_pipelines_share_an_archive(tmp_path):
    for name in ("one", "two"):
        batch_case.write_log(tmp_path / name / "logs" / "a.csv")
        text = batch_case.write_pipeline(tmp_path / name).read_text()
        (tmp_path / name / "nightly.toml").write_text(text.replace('"nightly"', f'"{name}"').replace('"archive"', '"../archive"'))
        batch.run(tmp_path / name / "nightly.toml", workers=1)
    rows = pl.read_parquet(tmp_path / "archive/catalogue/**/*.parquet", hive_partitioning=True)
    assert sorted(rows["pipeline"]) == ["one", "two"] and rows["sha256"].n_unique() == 1


@pytest.mark.slow
def test_a_dive_that_is_unusual_for_its_vehicle_exceeds_a_tolerance_of_the_pipeline(tmp_path):
    """Two dives of one kind, and one whose log says another speed than it drove at; half a sigma, since two dives tell little."""
    for number in range(2):
        batch_case.write_log(tmp_path / "logs" / f"{number}.csv", seconds=11, seed=number)
    path = batch_case.write_pipeline(tmp_path, 'tolerances = ["trend.surge=0.5"]', steps=COMPARED)
    assert batch.run(path, workers=1)["exit_code"] == 0
    batch_case.write_log(tmp_path / "logs" / "z.csv", seconds=11, seed=99, rpm=200.0)
    done = batch.run(path, workers=1)
    assert done["exit_code"] == 1 and {e["limit"].split(":")[0] for e in done["tolerances_exceeded"]} >= {"trend.surge"}
    assert "0.5 sigma above the 2 dives before it" in done["tolerances_exceeded"][0]["limit"]
    assert "trend.surge" in (tmp_path / "reports" / "index.html").read_text(encoding="utf-8")
    assert batch.run(path, workers=1)["exit_code"] == 0  # told the night that it came
