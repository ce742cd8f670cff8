"""What is damaged is found by its digest, whatever it is, and a repair makes it anew or leaves it to the next batch."""

import json
import shutil

import batch_case
import pytest
from typer.testing import CliRunner

from rovval.cli.app import app
from rovval.pipeline import batch
from rovval.storage.archive import load_run, run_ids


def archive(site, action, *args):
    done = CliRunner().invoke(app, ["archive", action, "--archive", str(site / "archive"), "--reports", str(site / "reports"), *args])
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done.exit_code, done.stdout


def flip(file):
    """One other byte in the middle, the size as it was."""
    content = bytearray(file.read_bytes())
    content[len(content) // 2] ^= 1
    file.write_bytes(content)


@pytest.fixture
def kept(site):
    path = batch_case.write_pipeline(site, steps='["ingest", "simulate"]')
    batch.run(path, workers=1)
    assert archive(site, "check") == (0, "everything is whole\n")
    return site


def test_one_other_byte_in_each_kind_of_file_is_found_and_healed(kept):
    a, b, c = run_ids(kept / "archive")
    before = {run: load_run(run, kept / "archive") for run in (a, b, c)}
    folders = {folder.name[0]: folder for folder in (kept / "reports").glob("?-*")}
    catalogue = next(kept.glob("archive/catalogue/*/*/*.parquet"))
    flip(kept / "archive" / a / "run.parquet")
    (kept / "archive" / b / "manifest.json").write_text("{")
    flip(folders["c"] / "simulation.parquet")
    flip(folders["b"] / "record.json")
    catalogue.write_bytes(catalogue.read_bytes()[:500])
    (kept / "logs" / "bad.csv").write_text("no log\n")
    code, said = archive(kept, "check", "--json")
    places = {fault["place"] for fault in json.loads(said)["faults"]}
    names = {str(kept / "archive" / a), str(kept / "archive" / b), str(folders["c"] / "simulation.parquet"), str(folders["b"] / "record.json"), str(catalogue)}
    assert code == 3 and names <= places
    code, said = archive(kept, "repair")
    assert code == 3 and "made anew from" in said and load_run(a, kept / "archive").sha256 == before[a].sha256
    again = batch.run(kept / "nightly.toml", workers=1)
    assert again["counts"]["quarantined"] == 1 and again["damaged"] == []
    assert archive(kept, "check") == (0, "everything is whole\n")
    for run, was in before.items():
        assert load_run(run, kept / "archive").values.keys() == was.values.keys()


def test_a_run_whose_log_is_gone_or_another_is_moved_aside_not_lost(kept):
    run = run_ids(kept / "archive")[0]
    flip(kept / "archive" / run / "run.parquet")
    batch_case.write_log(kept / "logs" / "a.csv", seed=9)
    code, said = archive(kept, "repair")
    assert code == 3 and "moved to" in said and (kept / "archive" / ".damaged" / run / "run.parquet").exists()
    assert run not in run_ids(kept / "archive")


def test_a_folder_that_is_not_there_is_no_whole_archive(site):
    shutil.rmtree(site / "logs")
    assert CliRunner().invoke(app, ["archive", "check", "--archive", str(site / "nothing")]).exit_code == 1  # main() gives the refusal its code
